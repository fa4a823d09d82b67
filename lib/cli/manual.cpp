// The commands of `langer` and the completion of bash. Both are generated from the tables of usage
// and of stages, so they cannot contradict the programs. Man pages are made from --help by the
// build (cmake/man_pages.cmake).
#include <fmt/format.h>

#include <algorithm>

#include "cli/starter.hpp"
#include "cli/usage.hpp"
#include "core/base/split.hpp"
#include "core/base/text.hpp"
#include "core/config/member.hpp"
#include "pipeline/plan/effective.hpp"

namespace langer {

namespace {

// The last of several names of an option is the long one: "-o,--output".
std::string longest_flag(const UsageOption& o) { return o.flags.substr(o.flags.rfind(',') + 1); }

}  // namespace

Usage usage_of(const StageSpec& stage) {
  return usage_of(stage, find_config_kind(stage.name)->top_keys());
}

namespace {

// A command of `langer`.
Usage command(const char* program, const char* sentence, std::vector<UsageOption> options,
              const char* example) {
  for (UsageOption& o : common_options())
    if (o.flags == "-h,--help") options.push_back(std::move(o));
  return {program, sentence, std::move(options), {}, example, ""};
}

// The commands of `langer`. Kinds of configs come from the table of stages, so a new stage appears
// here without a change.
std::vector<Usage> table_of_commands() {
  // A pipeline has a schema, but its keys depend on the stages, so it has no listing to describe.
  std::vector<std::string> kinds = config_kind_names();
  std::vector<std::string> described = kinds;
  kinds.push_back("pipeline");
  described.push_back("columns");
  return {
      command("langer show", "Prints the content of a file that Langer made.",
              {{"FILE",
                "",
                "mesh, material, solution, curves, sweep, sensitivity or snapshot; may be repeated",
                "h5 hdf",
                {},
                true},
               {"--config", "", "print the config that it was made with instead", "", {}},
               {"--json", "", "print the summary as one JSON object a file", "", {}}},
              "langer show runs/indentation/solve/solution.h5"),
      command("langer new", "Writes a starter project that runs, with comments.",
              {{"SCENE", "", fmt::format("one of {}", list_words(starter_names())), "",
                starter_names(), true},
               {"FOLDER", "", "a new folder; the scene's name by default", "/", {}}},
              "langer new indentation skin && make -C skin"),
      command("langer check", "Checks configs and pipelines without running anything.",
              {{"FILE",
                "",
                "YAML; may be repeated. Its kind is found from its keys, or given",
                "yaml yml",
                {},
                true},
               {"--as", "KIND", fmt::format("one of {}", list_words(kinds)), "", kinds}},
              "langer check pipelines/indentation.yaml configs/*/*.yaml"),
      command("langer serve",
              "Serves a page on this machine on which a scene is set up, checked, drawn, run and "
              "read, without writing YAML.",
              {{"FOLDER",
                "",
                "a project, or a folder of projects; the current one by default",
                "/",
                {}},
               {"--port", "N", "listen there; by default on a free port", "", {}},
               {"--scene", "", "print instead what the page draws of the project (JSON)", "", {}}},
              "langer serve skin"),
      command("langer describe",
              "Prints every key of a config: type, range, unit, default, meaning; or every column: "
              "unit, sign, meaning.",
              {{"KIND", "", fmt::format("columns, or one of {}", list_words(config_kind_names())),
                "", described, true}},
              "langer describe solve"),
      command("langer schema", "Prints the JSON Schema of a config, for editors.",
              {{"KIND", "", fmt::format("one of {}", list_words(kinds)), "", kinds, true},
               {"--list", "", "print the kinds instead", "", {}},
               {"--into", "FOLDER", "write the schemas of all kinds there instead", "/", {}}},
              "langer schema solve > solve.schema.json"),
      command("langer explain", "Explains why make would run a step of a run again.",
              {{"RUN", "", "folder of a run", "/", {}, true}}, "langer explain runs/indentation"),
      command("langer times", "Prints time and memory of each step of a run, and which failed.",
              {{"RUN", "", "folder of a run", "/", {}, true},
               {"--failed", "", "only those that failed, with their logs", "", {}}},
              "langer times runs/indentation"),
      command(
          "langer crate",
          "Describes a finished run for others as an RO-Crate: how each file was made, checksums, "
          "a script that makes it again.",
          {{"RUN", "", "folder of a run", "/", {}, true},
           {"--title", "TEXT", "its title; the pipeline's name by default", "", {}},
           {"--author", "NAME", "who made it", "", {}},
           {"--license", "TEXT", "under which others may use it, best as a URL", "", {}},
           {"--root",
            "DIR",
            "folder of the project: data are copied from below it only; by default the current "
            "folder",
            "/",
            {}},
           {"--same-as",
            "RUN",
            "compare instead: whether another folder of the same run has the same results",
            "/",
            {}}},
          "langer crate runs/indentation --license https://creativecommons.org/licenses/by/4.0/"),
      command(
          "langer dossier",
          "Writes the evidence for a run after ASME V&V 40: verification, validation, "
          "uncertainty, and what is missing.",
          {{"RUN", "", "folder of a run", "/", {}, true},
           {"-o,--output", "FILE", "a .md or .html; Markdown on stdout by default", "md html", {}},
           {"--use", "TEXT", "context of use", "", {}},
           {"--question", "TEXT", "question of interest", "", {}},
           {"--risk", "TEXT", "influence of the model and consequence of a wrong decision", "", {}},
           {"--tests", "FILE", "log of ctest: build/Testing/Temporary/LastTest.log", "log", {}}},
          "langer dossier runs/indentation -o dossier.html --use \"rank two indenters\""),
      command("langer doctor",
              "Lists the programs and libraries that Langer can use, and what does not work "
              "without the missing ones.",
              {}, "langer doctor"),
      command("langer completion", "Prints the completion of all programs for bash.", {},
              "source <(langer completion)"),
  };
}

}  // namespace

const std::vector<Usage>& langer_commands() {
  static const std::vector<Usage> commands = table_of_commands();
  return commands;
}

// The page of `langer` lists its commands instead of options, and names the stages.
Usage langer_usage() {
  Usage u{
      "langer",
      "Shows files, starts projects and checks configs. The stages, such as langer-solve, compute.",
      {},
      {},
      "",
      ""};
  for (const Usage& c : langer_commands()) {
    const std::string name = c.program.substr(7);
    u.options.push_back({name, "", c.sentence, "", {}});
  }
  u.options.push_back(
      {"-h,--help", "", "this page; langer COMMAND --help explains a command", "", {}});
  u.options.push_back({"--version", "", "version of this build", "", {}});
  for (const Usage& c : langer_commands())
    if (c.program == "langer new" || c.program == "langer show" || c.program == "langer check" ||
        c.program == "langer explain")
      append(u.examples, "\n", c.examples);
  u.more = "The stages: ";
  for (const StageSpec& s : stages()) u.more += std::string("langer-") + s.name + ", ";
  u.more += "and langer-plan, which chains them.";
  return u;
}

// The programs: the stages, langer-plan, and langer with all its commands.
std::vector<Usage> all_usages() {
  std::vector<Usage> all;
  for (const StageSpec& s : stages()) all.push_back(usage_of(s));
  all.push_back(plan_usage());
  all.push_back(langer_usage());
  return all;
}

namespace {

// The values of an option that takes words or files, as bash completes them.
std::string completed_value(const UsageOption& o) {
  if (!o.words.empty())
    return fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$cur\"));", fmt::join(o.words, " "));
  if (!o.files.empty()) return fmt::format("_langer_files {};", o.files);
  return "";
}

// The positional arguments of a program, which may be words and files.
std::string completed_places(const Usage& u) {
  std::string s;
  for (const UsageOption& o : u.options) {
    if (!is_place(o)) continue;
    if (!o.words.empty())
      s += fmt::format("  COMPREPLY+=($(compgen -W '{}' -- \"$cur\"))\n", fmt::join(o.words, " "));
    if (!o.files.empty()) s += fmt::format("  _langer_files {}\n", o.files);
  }
  return s;
}

// A function of bash that completes the arguments of one program: after an option its value,
// otherwise names of options, or positional arguments.
std::string completion_function(const Usage& u, const std::string& function) {
  std::string flags;
  std::string s = function + "() {\n  case $prev in\n";
  for (const UsageOption& o : u.options) {
    if (is_place(o)) continue;
    append(flags, " ", longest_flag(o));
    if (o.value.empty()) continue;
    std::string patterns = o.flags;
    std::replace(patterns.begin(), patterns.end(), ',', '|');
    s += fmt::format("    {}) {} return ;;\n", patterns, completed_value(o));
  }
  s += "  esac\n";
  s += fmt::format(
      "  [[ $cur == -* ]] && {{ COMPREPLY=($(compgen -W '{}' -- \"$cur\")); return; }}\n{}", flags,
      completed_places(u));
  return s + "}\n";
}

}  // namespace

// One function for each program, which sets the words of its own arguments, and one for `langer`,
// which chooses by its command.
std::string completion_text() {
  std::string s =
      "# bash completion of Langer: generated by `langer completion`\n"
      "_langer_files() {  # endings...\n"
      "  local end IFS=$'\\n'\n"
      "  COMPREPLY+=($(compgen -d -- \"$cur\"))\n"
      "  for end in \"$@\"; do [ \"$end\" = / ] || "
      "COMPREPLY+=($(compgen -f -X \"!*.$end\" -- \"$cur\")); done\n"
      "  compopt -o filenames\n"
      "}\n";
  // Every function begins with the current and the previous word of the command line.
  const auto words =
      "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]}\n  COMPREPLY=()\n";
  std::vector<std::string> programs;
  for (const Usage& u : all_usages()) {
    if (u.program == "langer") continue;
    std::string function = "_" + u.program;
    std::replace(function.begin(), function.end(), '-', '_');
    s += completion_function(u, function + "_options");
    s += fmt::format("{}() {{\n{}  {}_options\n}}\ncomplete -F {} {}\n", function, words, function,
                     function, u.program);
  }
  std::string names;
  std::string branches;
  for (const Usage& c : langer_commands()) {
    const std::string name = c.program.substr(7);
    s += completion_function(c, "_langer_command_" + name);
    names += " " + name;
    branches += fmt::format("    {}) _langer_command_{} ;;\n", name, name);
  }
  s += fmt::format(
      "_langer() {{\n{}  if [ $COMP_CWORD = 1 ]; then "
      "COMPREPLY=($(compgen -W '{} --help --version' -- \"$cur\")); return; fi\n"
      "  case ${{COMP_WORDS[1]}} in\n{}  esac\n}}\ncomplete -F _langer langer\n",
      words, names.substr(1), branches);
  return s;
}

}  // namespace langer

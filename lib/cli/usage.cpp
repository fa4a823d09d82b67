// The pages of --help: wrapping, synopsis, and the options of stages and of langer-plan.
#include "cli/usage.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/split.hpp"
#include "core/base/text.hpp"

namespace langer {

const char* const exit_codes =
    "0 done, 1 a bug, 2 config or arguments, 3 a file, its disk or memory, 4 no convergence, "
    "5 less accurate than asked for, 128 + n stopped by signal n";

namespace {

constexpr std::size_t width = 108;

// A text in lines of at most this number of columns.
std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines(1);
  for (const std::string& word : split(text, ' ')) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > columns)
      lines.emplace_back();
    append(lines.back(), " ", word);
  }
  return lines;
}

}  // namespace

// An option as it is shown in help: "-o, --output FILE".
std::string option_text(const UsageOption& o) {
  std::string s = o.flags;
  const std::size_t comma = s.find(',');
  if (comma != std::string::npos) s.insert(comma + 1, " ");
  if (o.value.empty()) return s;
  return s + " " + o.value;
}

bool is_place(const UsageOption& o) { return o.flags[0] != '-'; }

// The program with its positional arguments and required options.
std::string synopsis(const Usage& u) {
  std::string s = u.program;
  bool optional = false;
  for (const UsageOption& o : u.options) {
    if (is_place(o) && o.required)
      s += " " + o.flags;
    else if (is_place(o))
      s += " [" + o.flags + "]";
    else if (o.required)
      s += " " + o.flags.substr(0, o.flags.find(',')) + " " + o.value;
    else
      optional = true;
  }
  if (optional) s += " [options]";
  return s;
}

// Options that all programs have.
std::vector<UsageOption> common_options() {
  return {{"--quiet", "", "print warnings and errors only", "", {}},
          {"-v,--verbose", "", "print more: inputs, every iteration, time and memory", "", {}},
          {"-h,--help", "", "this page", "", {}},
          {"--version", "", "version of this build", "", {}}};
}

namespace {

// The type of a key with its default.
std::string kind_text(const DescribedKey& k) {
  if (k.otherwise.empty()) return k.kind;
  return k.kind + "; " + k.otherwise;
}

// The beginning of a text, cut after a word.
std::string cut(const std::string& text, std::size_t columns) {
  if (text.size() <= columns) return text;
  if (columns < 8) return "";
  const std::size_t space = text.rfind(' ', columns - 4);
  std::string s = text.substr(0, std::min(space, columns - 4));
  while (!s.empty() && (s.back() == ' ' || s.back() == ',' || s.back() == ';' || s.back() == ':'))
    s.pop_back();
  return s + " ...";
}

// The inputs of an example: the required ones and those that may be keys of the config. A stage
// without a required input shows its first two.
std::vector<const Port*> example_inputs(const StageSpec& stage) {
  const bool any_required = std::ranges::any_of(stage.inputs, &Port::required);
  std::vector<const Port*> shown;
  for (const Port& p : stage.inputs) {
    if (any_required && (p.required || p.or_key)) shown.push_back(&p);
    if (!any_required && shown.size() < 2) shown.push_back(&p);
  }
  return shown;
}

// A command line with the inputs of a stage under their default names.
std::string stage_example(const StageSpec& stage) {
  const std::string name = stage.name;
  std::string s = "langer-" + name + " " + name + ".yaml";
  for (const Port* p : example_inputs(stage)) {
    if (p->members)
      s += fmt::format(" --{0} a/{0}.h5 --{0} b/{0}.h5", p->name);
    else
      s += fmt::format(" --{0} {0}.h5", p->name);
  }
  return s + " -o " + stage.output;
}

// The option of an input file.
UsageOption port_option(const Port& p) {
  std::string text = p.says;
  std::string files = "h5";
  if (p.takes_yaml) {
    text += " (HDF5 or YAML)";
    files = "h5 yaml yml";
  } else {
    text += " (HDF5)";
  }
  if (p.several) text += "; may be repeated";
  return {std::string("--") + p.name, "FILE", text, files, {}, p.required};
}

}  // namespace

// An option by one of its names, such as "-o"; nullptr if there is none.
const UsageOption* Usage::find(const std::string& flag) const {
  for (const UsageOption& o : options)
    for (const std::string& f : split(o.flags, ','))
      if (f == flag) return &o;
  return nullptr;
}

// Ports become options; --dry-run and --export depend on the stage.
Usage usage_of(const StageSpec& stage, std::vector<DescribedKey> keys) {
  Usage u{std::string("langer-") + stage.name, stage.sentence, {}, {}, "", ""};
  u.options.push_back({"CONFIG", "", "YAML file with the keys below", "yaml yml", {}, true});
  for (const Port& p : stage.inputs) u.options.push_back(port_option(p));
  u.options.push_back(
      {"-o,--output",
       "FILE",
       fmt::format("main output, for example {}; side files are written next to it", stage.output),
       std::string(stage.output).substr(std::string(stage.output).rfind('.') + 1),
       {},
       true});
  u.options.push_back(
      {"--set", "KEY=VALUE", "replace a value of the config; may be repeated", "", {}});
  std::string dry_run = "check config and inputs, print what would be made; write nothing";
  if (stage.forecasts) dry_run = "check everything and forecast memory and time; write nothing";
  u.options.push_back({"--dry-run", "", dry_run, "", {}});
  if (*stage.exports) u.options.push_back({"--export", "FILE", stage.exports, "inp feb", {}});
  u.options.push_back({"--json", "", "print the results as one JSON object on stdout", "", {}});
  u.options.push_back(
      {"--log", "FILE", "also write all messages to this file; its folder is made", "log", {}});
  u.options.push_back(
      {"--describe", "", "every key of the config: type, range, unit, default, meaning", "", {}});
  for (UsageOption& o : common_options()) u.options.push_back(std::move(o));
  u.keys = std::move(keys);
  u.examples = stage_example(stage);
  if (*stage.exports)
    u.examples +=
        fmt::format("\n{} --solution solution.h5 --export scene.inp --export scene.feb", u.program);
  return u;
}

// langer-plan is not a stage: it has a pipeline instead of a config.
Usage plan_usage() {
  Usage u{"langer-plan", "Turns a pipeline into a Makefile.", {}, {}, "", ""};
  u.options = {
      {"PIPELINE", "", "YAML file with nodes", "yaml yml", {}, true},
      {"-o,--output",
       "FOLDER",
       "folder of the run; runs/<name of the pipeline> by default",
       "/",
       {}},
      {"--set", "NODE.KEY=VALUE", "replace a value of a node's config; may be repeated", "", {}},
      {"--sweep",
       "NODE.KEY=[VALUES]",
       "vary a key of a node's config as a sweep does; AXIS:NODE.KEY=[VALUES] names the axis; may "
       "be repeated",
       "",
       {}},
      {"--slurm",
       "",
       "also write slurm/submit, which sends the run to Slurm as arrays of jobs",
       "",
       {}},
      {"--snakemake",
       "",
       "also write a Snakefile, with which Snakemake makes the same files",
       "",
       {}},
      {"--dry-run", "", "check everything that the pipeline names; write nothing", "", {}}};
  for (UsageOption& o : common_options()) u.options.push_back(std::move(o));
  u.examples =
      "langer-plan pipelines/indentation.yaml -o runs/indentation && make -C runs/indentation -j2";
  return u;
}

std::string usage_line(const Usage& u) {
  if (u.program == "langer") return "langer COMMAND [options]";
  return synopsis(u);
}

// The page of --help: options, top keys of the config, an example.
std::string help_text(const Usage& u) {
  std::string s = u.sentence + "\n\nUsage: " + usage_line(u) + "\n\n";
  std::size_t left = 0;
  for (const UsageOption& o : u.options) left = std::max(left, option_text(o).size());
  for (const UsageOption& o : u.options) {
    std::string head = option_text(o);
    for (const std::string& line : wrapped(o.says, width - left - 4)) {
      s += fmt::format("  {:<{}}  {}\n", head, left, line);
      head.clear();
    }
  }
  // The keys of the config as a table of three columns; the text of a key is cut to one line.
  if (!u.keys.empty()) {
    std::size_t key = 0;
    std::size_t kind = 0;
    for (const DescribedKey& k : u.keys) {
      key = std::max(key, k.key.size());
      kind = std::max(kind, std::min<std::size_t>(44, kind_text(k).size()));
    }
    s += "\nKeys of the config, in mm, N, MPa, s and degrees (those below them: --describe):\n";
    for (const DescribedKey& k : u.keys) {
      std::string line = fmt::format("  {:<{}}  {:<{}}  ", k.key, key, kind_text(k), kind);
      line += cut(k.doc, width - std::min(width, line.size()));
      line.erase(line.find_last_not_of(' ') + 1);
      s += line + "\n";
    }
  }
  s += std::string("\nExample:\n");
  for (const std::string& line : split(u.examples, '\n')) s += "  " + line + "\n";
  if (!u.more.empty()) {
    s += "\n";
    for (const std::string& line : wrapped(u.more, width)) s += line + "\n";
  }
  return s + "\nExit codes: " + exit_codes + "\n";
}

}  // namespace langer

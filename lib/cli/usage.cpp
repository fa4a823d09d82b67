#include "cli/usage.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/split.hpp"

namespace langer {

const char* const exit_codes =
    "0 done, 1 a bug, 2 config or arguments, 3 a file, its disk or memory, 4 no convergence, 5 less accurate than asked for, 128 + n stopped by signal n";

namespace {

constexpr std::size_t width = 108;

std::vector<std::string> wrapped(const std::string& text, std::size_t columns) {
  std::vector<std::string> lines(1);
  for (const std::string& word : split(text, ' ')) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > columns)
      lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

}  // namespace

std::string option_text(const UsageOption& o) {
  std::string s = o.flags;
  if (const std::size_t comma = s.find(','); comma != std::string::npos) s.insert(comma + 1, " ");
  if (o.value.empty()) return s;
  return s + " " + o.value;
}

bool is_place(const UsageOption& o) { return o.flags[0] != '-'; }

std::string synopsis(const Usage& u) {
  std::string s = u.program;
  bool optional = false;
  for (const UsageOption& o : u.options) {
    if (is_place(o))
      s += " " + (o.required ? o.flags : "[" + o.flags + "]");
    else if (o.required)
      s += " " + o.flags.substr(0, o.flags.find(',')) + " " + o.value;
    else
      optional = true;
  }
  return s + (optional ? " [options]" : "");
}

std::vector<UsageOption> common_options() {
  return {{"--quiet", "", "say warnings and errors only", "", {}},
          {"-v,--verbose", "", "say more: what goes in, every iteration, time and memory", "", {}},
          {"-h,--help", "", "this page", "", {}},
          {"--version", "", "version of this build", "", {}}};
}

namespace {

std::string dots(const DescribedKey& k) {
  if (k.otherwise.empty()) return k.kind;
  return k.kind + "; " + k.otherwise;
}

// one line, cut at a word
std::string cut(const std::string& text, std::size_t columns) {
  if (text.size() <= columns) return text;
  if (columns < 8) return "";
  const std::size_t space = text.rfind(' ', columns - 4);
  std::string s = text.substr(0, space == std::string::npos ? columns - 4 : space);
  while (!s.empty() && (s.back() == ' ' || s.back() == ',' || s.back() == ';' || s.back() == ':'))
    s.pop_back();
  return s + " ...";
}

std::string stage_example(const StageSpec& stage) {
  const std::string name = stage.name;
  std::string s = "langer-" + name + " " + name + ".yaml";
  const bool asks = std::any_of(stage.inputs.begin(), stage.inputs.end(),
                                [](const Port& p) { return p.required; });
  std::size_t shown = 0;
  for (const Port& p : stage.inputs) {
    if (asks ? !p.required && !p.or_key : ++shown > 2) continue;
    s += fmt::format(" --{0} {1}{0}.h5", p.name, p.members ? "a/" : "");
    if (p.members) s += fmt::format(" --{0} b/{0}.h5", p.name);
  }
  return s + " -o " + stage.output;
}

}  // namespace

const UsageOption* Usage::find(const std::string& flag) const {
  for (const UsageOption& o : options)
    for (const std::string& f : split(o.flags, ','))
      if (f == flag) return &o;
  return nullptr;
}

Usage usage_of(const StageSpec& stage, std::vector<DescribedKey> keys, std::string reference) {
  Usage u{std::string("langer-") + stage.name, stage.sentence, {}, {}, "", "", ""};
  u.options.push_back({"CONFIG", "", "YAML file with the keys below", "yaml yml", {}, true});
  for (const Port& p : stage.inputs)
    u.options.push_back({std::string("--") + p.name,
                         "FILE",
                         fmt::format("{}{}{}", p.says, p.takes_yaml ? " (HDF5 or YAML)" : " (HDF5)",
                                     p.several ? "; may be repeated" : ""),
                         p.takes_yaml ? "h5 yaml yml" : "h5",
                         {},
                         p.required});
  u.options.push_back(
      {"-o,--output",
       "FILE",
       fmt::format("main output, for example {}; side files stand beside it", stage.output),
       std::string(stage.output).substr(std::string(stage.output).rfind('.') + 1),
       {},
       true});
  u.options.push_back(
      {"--set", "KEY=VALUE", "replace a value of the config; may be repeated", "", {}});
  u.options.push_back({"--dry-run",
                       "",
                       stage.forecasts
                           ? "check everything and forecast memory and time; write nothing"
                           : "check config and inputs, say what would be made; write nothing",
                       "",
                       {}});
  if (*stage.exports) u.options.push_back({"--export", "FILE", stage.exports, "inp feb", {}});
  u.options.push_back({"--json", "", "print the results as one JSON object on stdout", "", {}});
  u.options.push_back(
      {"--log", "FILE", "write what is said to this file, too; its folder is made", "log", {}});
  u.options.push_back(
      {"--describe", "", "every key of the config: type, range, unit, default, meaning", "", {}});
  for (UsageOption& o : common_options()) u.options.push_back(std::move(o));
  u.keys = std::move(keys);
  u.reference = std::move(reference);
  u.examples = stage_example(stage);
  if (*stage.exports)
    u.examples +=
        fmt::format("\n{} --solution solution.h5 --export scene.inp --export scene.feb", u.program);
  return u;
}

Usage plan_usage() {
  Usage u{"langer-plan", "Turns a pipeline into a Makefile.", {}, {}, "", "", ""};
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
       "vary a key of a node's config as a sweep does; AXIS:NODE.KEY=[VALUES] names the axis; may be repeated",
       "",
       {}},
      {"--slurm",
       "",
       "also write slurm/submit, which sends the run to Slurm as arrays of jobs",
       "",
       {}},
      {"--snakemake",
       "",
       "also write a Snakefile, by which Snakemake makes the same files",
       "",
       {}},
      {"--dry-run", "", "check everything that the pipeline names; write nothing", "", {}}};
  for (UsageOption& o : common_options()) u.options.push_back(std::move(o));
  u.examples =
      "langer-plan pipelines/indentation.yaml -o runs/indentation && make -C runs/indentation -j2";
  return u;
}

std::string help_text(const Usage& u) {
  std::string s = u.sentence + "\n\nUsage: " +
                  (u.program == "langer" ? "langer COMMAND [options]" : synopsis(u)) + "\n\n";
  std::size_t left = 0;
  for (const UsageOption& o : u.options) left = std::max(left, option_text(o).size());
  for (const UsageOption& o : u.options) {
    bool first = true;
    for (const std::string& line : wrapped(o.says, width - left - 4)) {
      s += fmt::format("  {:<{}}  {}\n", first ? option_text(o) : "", left, line);
      first = false;
    }
  }
  if (!u.keys.empty()) {
    std::size_t key = 0, kind = 0;
    for (const DescribedKey& k : u.keys) {
      key = std::max(key, k.key.size());
      kind = std::max(kind, std::min<std::size_t>(44, dots(k).size()));
    }
    s += "\nKeys of the config, in mm, N, MPa, s and degrees (those below them: --describe):\n";
    for (const DescribedKey& k : u.keys) {
      std::string line = fmt::format("  {:<{}}  {:<{}}  ", k.key, key, dots(k), kind);
      line += cut(k.doc, width > line.size() ? width - line.size() : 0);
      line.erase(line.find_last_not_of(' ') + 1);
      s += line + "\n";
    }
  }
  s += std::string("\nExample:\n");
  for (const std::string& line : split(u.examples, '\n')) s += "  " + line + "\n";
  if (!u.more.empty())
    for (const std::string& line : wrapped(u.more, width))
      s += (line == wrapped(u.more, width).front() ? "\n" : "") + line + "\n";
  return s + "\nExit codes: " + exit_codes + "\n";
}

}  // namespace langer

// `langer times` and `langer explain`: the state of a run from its Makefile, logs and files.
#include "cli/run_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/pipeline.hpp"
#include "pipeline/plan/ports.hpp"
#include "results/store/provenance.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

std::string without_ending(const std::string& target) {
  return target.substr(0, target.rfind('.'));
}

// The leaves of a config by the path of their key.
void flatten(const Tree& tree, const std::string& path,
             std::map<std::string, std::string>& leaves) {
  for (const auto& [key, value] : tree.map) {
    std::string inner = key;
    if (!path.empty()) inner = path + "." + key;
    flatten(value, inner, leaves);
  }
  for (std::size_t i = 0; i < tree.list.size(); ++i)
    flatten(tree.list[i], fmt::format("{}[{}]", path, i), leaves);
  if (tree.kind == Tree::Kind::scalar)
    leaves[path] = tree.scalar;
  else if (tree.map.empty() && tree.list.empty())
    leaves[path] = "none";
}

// Differences between the config that a file was made from and its config of today.
std::vector<std::string> changed_keys(const MadeBy& rule) {
  std::vector<std::string> changes;
  const ConfigKind* kind = find_config_kind(rule.stage);
  if (!kind || fs::path(rule.target).extension() != ".h5") return changes;
  try {
    // Both configs are effective ones, so only real differences remain. A path may be written in
    // two ways; then it is compared after normalisation.
    std::map<std::string, std::string> before;
    std::map<std::string, std::string> now;
    flatten(parse_yaml(read_origin(rule.target).identity.config, "before"), "", before);
    flatten(parse_yaml(kind->check(load_yaml(rule.prerequisites.at(0)), ".").text, "now"), "", now);
    for (const auto& [key, value] : now) {
      const auto old = before.find(key);
      if (old == before.end())
        changes.push_back(fmt::format("{}: {} is new", key, value));
      else if (old->second != value &&
               fs::path(old->second).lexically_normal() != fs::path(value).lexically_normal())
        changes.push_back(fmt::format("{}: {} -> {}", key, old->second, value));
    }
    for (const auto& [key, value] : before)
      if (!now.count(key)) changes.push_back(fmt::format("{}: {} is gone", key, value));
  } catch (const Failure& failure) {
    changes.push_back(failure.what());
  }
  return changes;
}

// Changes the working directory for its lifetime.
struct InFolder {
  fs::path before = fs::current_path();
  explicit InFolder(const std::string& folder) { fs::current_path(folder); }
  ~InFolder() {
    std::error_code ec;
    fs::current_path(before, ec);
  }
};

// Whether a path leaves the folder that it is relative to.
bool leads_out(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

// Throws unless the rule is one that langer-plan writes. A run's folder may come from another
// person, and the files that its Makefile names are read and copied. So a rule must not name files
// outside of what a plan would.
void check_rule(const MadeBy& rule, const Place& place) {
  std::string found;
  if (rule.prerequisites.empty() || !find_stage(rule.stage)) {
    found = "this is no rule of langer-plan";
  } else if (!pipeline::is_safe_path(rule.target) || leads_out(rule.target)) {
    found = "makes " + rule.target + ", outside of the run's folder";
  } else if (leads_out(rule.prerequisites[0]) ||
             fs::path(rule.prerequisites[0]).extension() != ".yaml") {
    found = "its config is " + rule.prerequisites[0];
  } else {
    for (const std::string& path : rule.prerequisites) {
      if (!pipeline::is_safe_path(path)) found = "names " + path;
    }
  }
  if (found.empty()) return;
  throw Failure(Exit::input, Error{place, "", found, "a rule as langer-plan writes it",
                                   "langer-plan makes the Makefile again"});
}

// Reads a log into the times of a step. A log may have several runs, each begun by "# langer-..."
// and ended by "# end: ..."; the last one counts.
void read_log(std::ifstream& log, StepTimes& step) {
  for (std::string line; std::getline(log, line);) {
    if (line.starts_with("# langer-")) step.exit = -1;
    if (std::sscanf(line.c_str(), "# end: exit %d, %lf s, %lf s of CPU, %lf MB", &step.exit,
                    &step.wall, &step.cpu, &step.MB) == 4)
      continue;
    if (!line.starts_with("#") && !line.starts_with("  hint:")) step.last = line;
  }
}

// The state of a step in one or two words.
std::string state_words(const StepTimes& t) {
  if (t.log.empty()) return "not run";
  if (t.exit == 0) return "done";
  if (t.exit < 0) return "not ended";
  return fmt::format("failed, {}", t.exit);
}

// A failed step with its log and its last message.
std::string failure_text(const StepTimes& t) {
  std::string end = "no end: running still, or killed";
  if (t.exit >= 0) end = fmt::format("exit {}", t.exit);
  std::string text = fmt::format("{}: {}; log: {}\n", t.step, end, t.log);
  if (!t.last.empty()) text += "  " + t.last + "\n";
  return text;
}

}  // namespace

// A rule of langer-plan is one line, "target: prerequisites $(if $(STRICT)...". All other lines are
// skipped. The file is read as data and never given to make.
std::vector<MadeBy> rules_of(const std::string& folder) {
  const fs::path path = fs::path(folder) / "Makefile";
  std::ifstream file;
  if (unreadable_reason(path.string()).empty()) file.open(path);
  std::string line;
  if (!file.is_open() || !std::getline(file, line) ||
      line.find("generated by langer-plan") == std::string::npos)
    throw Failure(Exit::input, Error{{path.string()},
                                     "",
                                     "there is no Makefile of langer-plan",
                                     "the folder of a run, such as runs/indentation",
                                     ""});
  std::vector<MadeBy> rules;
  for (int number = 2; std::getline(file, line); ++number) {
    const std::size_t colon = line.find(": ");
    const std::size_t strict = line.find(" $(if $(STRICT)");
    const std::size_t program = line.rfind("$(BIN)/langer-");
    if (line.empty() || line[0] == '\t' || colon == std::string::npos ||
        strict == std::string::npos || program == std::string::npos)
      continue;
    MadeBy rule{line.substr(0, colon), {}, line.substr(program + 14)};
    std::istringstream words(line.substr(colon + 2, strict - colon - 2));
    for (std::string word; words >> word;) rule.prerequisites.push_back(word);
    check_rule(rule, {path.string(), number, 1});
    rules.push_back(std::move(rule));
  }
  return rules;
}

// A step without a log was not run.
std::vector<StepTimes> times_of(const std::string& folder) {
  std::vector<StepTimes> times;
  for (const MadeBy& rule : rules_of(folder)) {
    StepTimes step;
    step.step = without_ending(rule.target);
    step.log = (fs::path(folder) / (step.step + ".log")).lexically_normal().string();
    std::ifstream log;
    if (unreadable_reason(step.log).empty()) log.open(step.log);
    if (log.is_open())
      read_log(log, step);
    else
      step.log.clear();
    times.push_back(std::move(step));
  }
  std::ranges::sort(times, {}, &StepTimes::step);
  return times;
}

// A table of all steps, a line of totals, and the logs of failed steps.
std::string times_text(const std::vector<StepTimes>& times, bool failed_only) {
  std::size_t width = 4;
  for (const StepTimes& t : times) width = std::max(width, t.step.size());
  std::string table = fmt::format("{:<{}}  {:<14}  {:>9}  {:>9}  {:>7}\n", "step", width, "state",
                                  "s", "CPU s", "MB");
  std::string failed;
  double cpu = 0;
  std::size_t done = 0;
  std::size_t bad = 0;
  std::size_t never = 0;
  for (const StepTimes& t : times) {
    const std::string state = state_words(t);
    if (t.exit >= 0) {
      table += fmt::format("{:<{}}  {:<14}  {:>9.2f}  {:>9.2f}  {:>7.0f}\n", t.step, width, state,
                           t.wall, t.cpu, t.MB);
    } else {
      table += fmt::format("{:<{}}  {}\n", t.step, width, state);
    }
    cpu += t.cpu;
    done += t.exit == 0;
    never += t.log.empty();
    if (t.log.empty() || t.exit == 0) continue;
    ++bad;
    failed += failure_text(t);
  }
  const std::string total =
      fmt::format("{} steps: {} done, {} failed or not ended, {} not run; {:.1f} s of CPU\n",
                  times.size(), done, bad, never, cpu);
  if (failed_only) return failed;
  return table + total + failed;
}

namespace {

// Finds why make would run the steps of a run again, from the times of files as make does. The
// working directory is the run's folder. Rules are in the order of the pipeline, which need not be
// the order of the work, so the prerequisites of a rule are examined before the rule.
class Explanation {
 public:
  explicit Explanation(const std::vector<MadeBy>& rules) {
    for (const MadeBy& rule : rules) rules_[rule.target] = &rule;
  }

  // The reasons of a step; empty if it is up to date.
  const StepReasons& of(const MadeBy& rule) {
    const auto [found, is_new] = steps_.try_emplace(rule.target);
    StepReasons& step = found->second;
    if (!is_new) return step;
    step.target = rule.target;
    for (const std::string& p : rule.prerequisites)
      if (const auto maker = rules_.find(p); maker != rules_.end()) of(*maker->second);
    std::error_code ec;
    const auto made = fs::last_write_time(rule.target, ec);
    if (!ec) {
      for (const std::string& p : rule.prerequisites) add_reasons(rule, p, made, step);
    } else if (fs::exists(rule.target + ".part")) {
      step.reasons.push_back("not finished; it continues from " + rule.target + ".part");
    } else {
      step.reasons.push_back("not made yet");
    }
    if (!step.reasons.empty()) again_.insert(rule.target);
    return step;
  }

 private:
  std::map<std::string, const MadeBy*> rules_;  // by target
  std::map<std::string, StepReasons> steps_;
  std::set<std::string> again_;  // targets that would be made again

  // Why one prerequisite makes a step run again. Of a changed config the changed keys are named.
  void add_reasons(const MadeBy& rule, const std::string& p, fs::file_time_type made,
                   StepReasons& step) const {
    if (again_.count(p)) return step.reasons.push_back(p + " is made again");
    std::error_code ec;
    const auto changed = fs::last_write_time(p, ec);
    if (ec) return step.reasons.push_back(p + " is missing");
    if (changed <= made) return;
    if (p != rule.prerequisites[0]) return step.reasons.push_back(p + " is newer");
    const std::vector<std::string> keys = changed_keys(rule);
    if (keys.empty()) step.reasons.push_back(p + " is newer: other inputs");
    constexpr std::size_t most = 5;
    for (std::size_t i = 0; i < std::min(most, keys.size()); ++i) step.reasons.push_back(keys[i]);
    if (keys.size() > most)
      step.reasons.push_back(fmt::format("{} more keys of {}", keys.size() - most, p));
  }
};

}  // namespace

std::vector<StepReasons> explain(const std::string& folder) {
  const std::vector<MadeBy> rules = rules_of(folder);
  const InFolder here(folder);
  Explanation explanation(rules);
  std::vector<StepReasons> steps;
  for (const MadeBy& rule : rules) steps.push_back(explanation.of(rule));
  return steps;
}

// Only the steps that would run, with their reasons indented.
std::string explain_text(const std::vector<StepReasons>& steps) {
  std::string text;
  std::size_t run = 0;
  for (const StepReasons& s : steps) {
    if (s.reasons.empty()) continue;
    ++run;
    text += s.target + "\n";
    for (const std::string& reason : s.reasons) text += "  " + reason + "\n";
  }
  return text + fmt::format("{} of {} steps would run\n", run, steps.size());
}

}  // namespace langer

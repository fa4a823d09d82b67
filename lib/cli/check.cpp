// `langer check`: reads a file as its program would, without running anything. So the messages are
// the same as those of the run.
#include "cli/check.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "cli/schemas.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/plan.hpp"
#include "pipeline/plan/run_files.hpp"

namespace langer {

namespace {

// The kind named by "# yaml-language-server: $schema=../schema/solve.schema.json" in the first
// lines.
std::optional<std::string> kind_by_schema_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  for (int i = 0; i < 5 && std::getline(file, line); ++i) {
    const std::size_t at = line.find("$schema=");
    if (line.rfind("#", 0) != 0 || at == std::string::npos) continue;
    const std::string name = std::filesystem::path(line.substr(at + 8)).filename();
    for (const std::string& kind : schema_kinds())
      if (name == schema_file(kind)) return kind;
  }
  return std::nullopt;
}

// The kind whose keys fit best: with the fewest unknown keys, then the fewest missing ones, then
// the largest share of known ones. Empty if two kinds fit equally well.
std::optional<std::string> kind_by_keys(const Tree& tree) {
  if (tree.kind != Tree::Kind::map) return std::nullopt;
  if (tree.find("nodes")) return "pipeline";
  using Score = std::tuple<std::size_t, std::size_t, std::size_t>;
  std::optional<std::string> best;
  Score least{};
  bool tie = false;
  for (const std::string& kind : config_kind_names()) {
    const std::vector<DescribedKey> keys = find_config_kind(kind)->top_keys();
    std::size_t known = 0, missing = 0;
    for (const DescribedKey& k : keys) {
      known += tree.find(k.key) != nullptr;
      missing += k.otherwise == "required" && !tree.find(k.key);
    }
    if (known == 0) continue;
    const Score score{tree.map.size() - known, missing, keys.size() - known};
    if (!best || score < least) {
      best = kind;
      least = score;
      tie = false;
    } else if (score == least) {
      tie = true;
    }
  }
  if (tie) return std::nullopt;
  return best;
}

// Doubts as indented lines below the verdict on a file. They do not change the exit code: the data
// may be unusual and right.
std::string warnings(const std::vector<std::string>& doubts) {
  std::string lines;
  for (const std::string& doubt : doubts) lines += "\n  warning: " + doubt;
  return lines;
}

}  // namespace

// The schema line is preferred, because it is the author's own statement; keys may fit several
// kinds.
std::string kind_of(const std::string& path) {
  if (const auto kind = kind_by_schema_line(path)) return *kind;
  const Tree tree = load_yaml(path);
  if (const auto kind = kind_by_keys(tree)) return *kind;
  throw Failure(Exit::config, Error{{path, 0, 0},
                                    "",
                                    "the kind of this file does not follow from its keys",
                                    "",
                                    "use --as with one of " + list_words(schema_kinds())});
}

// A pipeline is planned without writing, so all configs that it names are checked, too. Of a single
// config the measured data are read as well, which a plan does not do.
std::string check_file(const std::string& path, std::string kind) {
  if (kind.empty()) {
    require_file(path);
    kind = kind_of(path);
  }
  if (!has_schema(kind)) schema_text(kind);  // throws an error that lists the known kinds
  if (kind == "pipeline") {
    const PlanReport report = check_pipeline(path);
    return fmt::format("{}: a pipeline of {} nodes and {} steps, right{}", path, report.nodes,
                       report.steps, warnings(report.doubts));
  }
  const Effective effective = find_config_kind(kind)->check(load_yaml(path), ".");
  for (const Effective::File& file : effective.files) require_file(file.path, file.place, file.key);
  if (const std::vector<Error> unknown = unknown_names(effective.names); !unknown.empty())
    throw Failure(Exit::config, unknown);
  std::vector<std::string> doubts = effective.notices;
  if (effective.check_data)
    for (const std::string& doubt : effective.check_data()) doubts.push_back(doubt);
  return fmt::format("{}: {}, right{}", path, kind, warnings(doubts));
}

}  // namespace langer

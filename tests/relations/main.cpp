// Random scenes and their twins: turned, mirrored, rescaled, unreduced, with loads split, killed
// and resumed, in other increments, by another solver (twins.hpp). No answer is known, but those of
// a scene and of its twin have to be the same to 1e-9 of the largest value. A run that crashes, or
// does not end, fails as well.
//   langer-relations <langer-solve> <folder> [--scenes 40] [--seed 1] [--from 0]
// A scene that fails stays in <folder>/<number>_<kind> with its twin and a file `failed`.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "relations/draw.hpp"
#include "relations/solve.hpp"
#include "relations/twins.hpp"

namespace fs = std::filesystem;
using namespace langer::relations;

namespace {

constexpr double tolerance = 1e-9;

struct Options {
  fs::path program;
  fs::path folder;
  int scenes = 40;
  int from = 0;
  std::uint64_t seed = 1;
};

struct Counts {
  int compared = 0;
  int failed = 0;
  int not_converged = 0;  // twins solved in another way, which need not
};

std::string last_lines(const std::string& log) {
  constexpr std::size_t most = 600;
  if (log.size() <= most) {
    return log;
  }
  return "..." + log.substr(log.size() - most);
}

class Study {
 public:
  explicit Study(const Options& options) : options_(options), solver_{options.program} {}

  void add(int number) {
    const DrawnScene drawn = drawn_scene(options_.seed, number);
    const fs::path folder = options_.folder / drawn.name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    const fs::path yaml = write_scene(drawn.scene, folder, "scene");
    const Answer answer = solver_.solve(yaml);
    cpu_seconds_ += answer.cpu_seconds;
    if (!answer.solved()) {
      // A scene that does not converge has no twins, and any other end is an error, of this
      // program too: it has to draw scenes that langer-solve takes.
      ++skipped_;
      if (!answer.converged_not()) {
        fail(drawn, "scene", folder, {answer.end() + "\n" + last_lines(answer.log)});
        return;
      }
      fs::remove_all(folder);
      return;
    }
    bool kept = false;
    for (const Twin& twin : twins(drawn.scene, options_.seed + static_cast<unsigned>(number))) {
      kept = !same(drawn, answer, twin, folder) || kept;
    }
    if (!kept) {
      fs::remove_all(folder);
    }
  }

  int end() const {
    fmt::print("\n| relation | compared | not converged | failed |\n| --- | --- | --- | --- |\n");
    int failed = failed_scenes_;
    for (const auto& [relation, counts] : counts_) {
      fmt::print("| {} | {} | {} | {} |\n", relation, counts.compared, counts.not_converged,
                 counts.failed);
      failed += counts.failed;
    }
    fmt::print("{} scenes of seed {}, {} without a solution; {} failures; {:.0f} s of CPU time\n",
               options_.scenes, options_.seed, skipped_, failed, cpu_seconds_);
    // too few comparisons would look like success
    const bool too_few = 4 * skipped_ > options_.scenes;
    if (too_few) {
      fmt::print("More than a quarter of the scenes have no solution.\n");
    }
    return failed > 0 || too_few ? 1 : 0;
  }

 private:
  bool same(const DrawnScene& drawn, const Answer& answer, const Twin& twin,
            const fs::path& folder) {
    std::string name = "twin_" + twin.relation;
    std::replace(name.begin(), name.end(), ' ', '_');
    const fs::path yaml = write_scene(twin.scene, folder, name);
    Counts& counts = counts_[twin.relation];
    if (twin.killed) {
      const double share = 0.2 + 0.7 * (static_cast<double>(drawn.name.size() * 7 % 10) / 10);
      const Answer first = solver_.solve(yaml, share * answer.cpu_seconds);
      cpu_seconds_ += first.cpu_seconds;
    }
    const Answer other = solver_.solve(yaml);
    cpu_seconds_ += other.cpu_seconds;
    if (other.converged_not() && twin.may_fail) {
      ++counts.not_converged;
      return true;
    }
    ++counts.compared;
    std::vector<std::string> wrong;
    if (other.solved()) {
      wrong = differences(answer, other, twin, tolerance);
    } else {
      wrong = {other.end() + "\n" + last_lines(other.log)};
    }
    if (wrong.empty()) {
      return true;
    }
    ++counts.failed;
    fail(drawn, twin.relation, folder, wrong);
    return false;
  }

  void fail(const DrawnScene& drawn, const std::string& relation, const fs::path& folder,
            const std::vector<std::string>& wrong) {
    if (relation == "scene") {
      ++failed_scenes_;
    }
    std::string text = fmt::format("{}, {}:\n", drawn.name, relation);
    for (const std::string& line : wrong) {
      text += "  " + line + "\n";
    }
    text += fmt::format("  again: make relations SEED={} FROM={} SCENES=1; files in {}\n",
                        options_.seed, drawn.name.substr(0, drawn.name.find('_')), folder.string());
    fmt::print("FAILED {}", text);
    std::fflush(stdout);
    std::ofstream(folder / "failed", std::ios::app) << text;
  }

  Options options_;
  Solver solver_;
  std::map<std::string, Counts> counts_;
  int skipped_ = 0;
  int failed_scenes_ = 0;
  double cpu_seconds_ = 0;
};

Options read_options(int argc, char** argv) {
  Options options;
  options.program = fs::absolute(argv[1]);
  options.folder = fs::absolute(argv[2]);
  for (int i = 3; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    const std::string value = argv[i + 1];
    if (option == "--scenes") {
      options.scenes = std::stoi(value);
    } else if (option == "--seed") {
      options.seed = std::stoull(value);
    } else if (option == "--from") {
      options.from = std::stoi(value);
    } else {
      throw std::invalid_argument(option);
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) {
    throw std::invalid_argument("too few arguments");
  }
  const Options options = read_options(argc, argv);
  Study study(options);
  for (int i = options.from; i < options.from + options.scenes; ++i) {
    study.add(i);
  }
  return study.end();
} catch (const std::logic_error& wrong) {
  fmt::print(stderr,
             "langer-relations <langer-solve> <folder> [--scenes 40] [--seed 1] [--from 0]: {}\n",
             wrong.what());
  return 2;
}

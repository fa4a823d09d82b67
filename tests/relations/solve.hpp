// langer-solve as a process of its own: a crash or a run without an end is then a result.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "results/store/solution_file.hpp"

namespace langer::relations {

struct Answer {
  int code = 0;    // exit code
  int signal = 0;  // that ended the process
  double cpu_seconds = 0;
  std::string log;  // what it wrote to the terminal
  Mesh mesh;
  std::vector<StepRecord> steps;

  bool solved() const { return code == 0 && signal == 0; }
  bool converged_not() const { return code == 4 && signal == 0; }
  std::string end() const;  // in words
};

struct Solver {
  std::filesystem::path program;
  double limit = 60;  // CPU time of a run [s]; a scene of this program takes less than a second

  // kill_after: the process is killed after this CPU time [s], and nothing is read
  Answer solve(const std::filesystem::path& yaml,
               std::optional<double> kill_after = std::nullopt) const;
};

}  // namespace langer::relations

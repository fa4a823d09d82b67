// What langer-solve says while it works, on stderr: sizes first, one line per step, costs last.
#pragma once

#include "scene/scene.hpp"
#include "solve/statics.hpp"
#include "store/solution_file.hpp"

namespace langer {

class Progress {
 public:
  Progress(bool quiet, const Equilibrium& body, const Scene& scene);
  void resumed(int steps, double t) const;
  void accepted(const StepRecord& record, const SolveReport& report);
  void failed(double t, const SolveReport& report) const;
  void finished(const PathReport& path, const Statics& statics, double files) const;  // files: CPU seconds of writing

 private:
  bool quiet_;
  bool contact_;
  int step_ = 0;
};

}  // namespace langer

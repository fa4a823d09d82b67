// How far langer-solve is. The log and, with `verbose`, stderr have sizes first, one line per step
// with what it says of the state, costs last; with `verbose` every iteration has a line. Without it
// a terminal has one line that is rewritten, iteration by iteration, and a file of stderr a step
// now and then (core/base/say.hpp).
#pragma once

#include "core/base/voice.hpp"
#include "scene/run/run.hpp"

namespace langer {

class Progress {
 public:
  Progress(const Voice& voice, const Run& run);
  void resumed(int steps, double t);
  Problem watched(Problem problem, double t);  // tells each assessment
  void accepted(const StepRecord& record, const SolveReport& report);
  void jumping(
      double t,
      int equilibria);  // says so now and then: a jump may take longer than the steps before it
  void failed(double t, const SolveReport& report) const;
  void finished(const PathReport& path, const Increment& increment,
                double files) const;  // files: CPU seconds of writing

 private:
  std::string left(double t) const;
  Voice voice_;
  bool live_;  // a line rewritten in place
  bool contact_;
  int step_ = 0;
  double from_ = 0;  // t of the resumed step
  double start_;     // seconds, when the first step began
  double said_ = 0;  // seconds, when a jump was told of
};

// Goes along with the n-th scene of those that an estimate solves: a line for each, its iterations
// as above. A signal ends it within an iteration: nothing of it is kept.
RunListener estimate_progress(const Voice& voice, const Run& run, int n, int of);

}  // namespace langer

// <output>.steps: the journal of a solve that has not ended, from which the next run goes on.
// docs/schema.md
//   first record   the task: what the steps are steps of
//   then           a record for each run (its config, command, code) and one for each accepted step, in the order they came
// The HDF5 file <output>.part is made from it anew: after a crash nobody can tell what of an HDF5
// file is whole, and HDF5 may crash on it.
#pragma once

#include <string>
#include <vector>

#include "results/store/journal.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

class StepJournal {
 public:
  // Reads what an earlier run of the same task left and gives its steps one after another to
  // `take`, until that says false: this step and all behind it are dropped. Of another task,
  // another version of langer, or without its <output>.part: begun anew, which is said.
  using Take = SolutionWriter::StillGood;
  StepJournal(const std::string& output, const SolutionHeader& header, const Take& take);
  void append(const StepRecord& step);
  const std::vector<EarlierRun>& earlier() const { return earlier_; }  // with at least one step
  void remove() { journal_.remove(); }

 private:
  void replay(const Take& take);
  Journal journal_;
  std::string this_run_;
  std::vector<EarlierRun> earlier_;
};

// what a solve has kept of a model that another one takes the place of
void forget_steps(const std::string& output);

}  // namespace langer

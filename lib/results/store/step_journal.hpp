// <output>.steps: the journal of a solve that has not finished, from which the next run continues.
// docs/schema.md
//   first record   the task: identifies what the steps belong to
//   then           a record for each run (its config, command, code) and one for each accepted
//                  step, in order of time
// The HDF5 file <output>.part is written again from the journal. After a crash it is not known
// which parts of an HDF5 file are complete, and the HDF5 library itself may crash on a damaged
// file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "results/store/journal.hpp"
#include "results/store/solution_file.hpp"

namespace langer {

// The journal of one output.
class StepJournal {
 public:
  // Reads the steps that an earlier run of the same task kept and gives them one after another to
  // `accept`. If it returns false, this step and all after it are discarded. The journal is begun
  // anew, with a message, if it belongs to another task or another version of langer, or if
  // <output>.part is missing.
  using Accept = SolutionWriter::StillGood;
  StepJournal(const std::string& output, const SolutionHeader& header, const Accept& accept);
  void append(const StepRecord& step);
  const std::vector<EarlierRun>& earlier() const { return earlier_; }  // with at least one step
  void remove() { journal_.remove(); }

 private:
  void replay(const Accept& accept);
  Journal journal_;
  std::string this_run_;
  std::vector<EarlierRun> earlier_;
};

// Follows the journal of a solve that another process computes.
class StepFollower {
 public:
  explicit StepFollower(const std::string& output);
  // The steps that have come since the last call. If the solve has begun anew, for example with
  // finer cells, `anew` is set and they are those of the new beginning.
  std::vector<StepRecord> more(bool& anew);

 private:
  std::string path_;
  std::unique_ptr<Journal> journal_;
};

// Removes the kept steps of a solve whose model was replaced by another one.
void discard_steps(const std::string& output);

}  // namespace langer

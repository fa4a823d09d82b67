// Scripts that send the steps of a run to Slurm, from a login node without an allocation.
//   slurm/<node>.steps    one line per member: its output, then the outputs that it reads
//   slurm/<node>.sbatch   makes one of them through the run's Makefile, unless it is up to date
//   slurm/submit          sends one job, or one array of jobs, per node; a node waits for its inputs
// A member that fails stops only the members that read its output: they report it and end. A
// requeued member continues where it stopped.
#pragma once

#include <string>
#include <vector>

#include "pipeline/plan/expand.hpp"

namespace langer::pipeline {

// One script; `program`: it can be executed.
struct SlurmFile {
  std::string name;  // relative to the run's folder
  std::string text;
  bool program = false;
};

std::vector<SlurmFile> slurm_files(const std::string& run_name, const std::vector<Step>& steps);

}  // namespace langer::pipeline

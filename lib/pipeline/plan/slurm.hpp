// Steps -> scripts for Slurm, for a login node without an allocation. Pure.
//   slurm/<node>.steps    one line per member: its output, then the outputs that it reads
//   slurm/<node>.sbatch   makes one of them through the run's Makefile: what is up to date ends at once
//   slurm/submit          sends one job, or one array of jobs, per node; a node waits for those that it reads
// A member that fails holds up only those that read it: they say so and end. A requeued member goes
// on where it stopped.
#pragma once

#include <string>
#include <vector>

#include "pipeline/plan/expand.hpp"

namespace langer::pipeline {

struct SlurmFile {
  std::string name;  // relative to the run's folder
  std::string text;
  bool program = false;
};

std::vector<SlurmFile> slurm_files(const std::string& run_name, const std::vector<Step>& steps);

}  // namespace langer::pipeline

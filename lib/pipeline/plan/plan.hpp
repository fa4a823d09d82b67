// Plans a run: reads the pipeline, checks every config that it names, then writes the effective
// configs and a Makefile.
//
// Nothing is written unless everything is right. A file is rewritten only if its text changes, so
// make repeats exactly the steps that depend on a changed value. Comments and the order of keys do
// not change the effective config, so they repeat nothing.
#pragma once

#include <string>
#include <vector>

#include "pipeline/plan/overrides.hpp"

namespace langer {

// The size of a plan, and warnings.
struct PlanReport {
  std::string folder;
  std::size_t nodes = 0;
  std::size_t steps = 0;
  std::size_t changed = 0;  // files that were written because their text is new
  // Warnings, each once: former names of keys, and of check_pipeline() also doubts about measured
  // data.
  std::vector<std::string> doubts;
};

// What is written in addition to the Makefile.
struct PlanFor {
  bool slurm = false;      // scripts for Slurm (pipeline/plan/slurm.hpp)
  bool snakemake = false;  // a Snakefile (pipeline/plan/snakefile.hpp)
};

// `folder` empty: runs/<name of the pipeline>. `bin` is the folder of the programs.
PlanReport plan(const std::string& pipeline_file, std::string folder, const std::string& bin,
                const std::string& command = "", PlanFor others = {},
                const pipeline::Overrides& overrides = {});

// The same checks; nothing is written.
PlanReport check_pipeline(const std::string& pipeline_file, std::string folder = "",
                          const pipeline::Overrides& overrides = {});

}  // namespace langer

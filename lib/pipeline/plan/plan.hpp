// Plans a run: reads the pipeline, checks every config that it names, then writes effective configs
// and a Makefile. Nothing is written unless everything is right. A file is rewritten only if its
// text changes, so make reruns exactly what depends on a changed value; comments and the order of
// keys change nothing.
#pragma once

#include <string>
#include <vector>

#include "pipeline/plan/overrides.hpp"

namespace langer {

struct PlanReport {
  std::string folder;
  std::size_t nodes = 0, steps = 0,
              changed = 0;  // changed: files written because their text is new
  // keys and words by their former names, each once; what looks wrong in measured data, which
  // check_pipeline() alone reads
  std::vector<std::string> doubts;
};

// What is written beside the Makefile.
struct PlanFor {
  bool slurm = false;      // scripts for Slurm (pipeline/slurm.hpp)
  bool snakemake = false;  // a Snakefile (pipeline/snakefile.hpp)
};

// `folder` empty: runs/<name of the pipeline>. `bin` is the folder of the programs.
PlanReport plan(const std::string& pipeline_file, std::string folder, const std::string& bin,
                const std::string& command = "", PlanFor others = {},
                const pipeline::Overrides& overrides = {});

// The same checks; nothing is written.
PlanReport check_pipeline(const std::string& pipeline_file, std::string folder = "",
                          const pipeline::Overrides& overrides = {});

}  // namespace langer

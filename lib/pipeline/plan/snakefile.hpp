// The text of a Snakefile for the whole pipeline. It has the same commands as the Makefile, so the
// results are the same to the last byte. All paths are relative to its folder.
//   snakemake --cores 4                              or, from elsewhere, -d runs/x -s runs/x/Snakefile
//   snakemake --cores 4 --config launch="srun -n1"   text before every command; bin=...: folder of
//                                                    the programs
#pragma once

#include <string>
#include <vector>

#include "pipeline/plan/makefile.hpp"

namespace langer::pipeline {

std::string snakefile_text(const std::string& pipeline_file, const std::string& bin,
                           const std::vector<Rule>& rules, const std::vector<std::string>& finals);

}  // namespace langer::pipeline

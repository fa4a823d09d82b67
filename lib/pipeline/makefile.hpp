// Rules -> the text of a Makefile. Pure. All paths are relative to the folder of the Makefile.
// Recipes are one plain command, so that LAUNCH ("srun -n1") moves them whole. Programs are order-only prerequisites:
// a rebuilt program throws nothing away unless STRICT=1.
#pragma once

#include <string>
#include <vector>

namespace langer::pipeline {

struct Rule {
  std::string target;
  std::vector<std::string> prerequisites;
  std::string program;    // in $(BIN)
  std::string arguments;  // without the output
};

std::string makefile_text(const std::string& pipeline_file, const std::string& bin, const std::vector<Rule>& rules,
                          const std::vector<std::string>& finals);

}  // namespace langer::pipeline

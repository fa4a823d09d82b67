#include "pipeline/plan/makefile.hpp"

#include <fmt/format.h>

#include "core/base/version.hpp"

namespace langer::pipeline {

// One rule for each step. The config is a prerequisite, and langer-plan rewrites it only if its
// text changes, so make finds changed values by the times of files alone.
std::string makefile_text(const std::string& pipeline_file, const std::string& bin,
                          const std::vector<Rule>& rules, const std::vector<std::string>& finals) {
  std::string text = fmt::format("{}{} from {}: do not edit\n", planned_by, version, pipeline_file);
  text +=
      "#   make [-j 4] [-k] [LAUNCH=\"srun -n1\"] [STRICT=1] [VERBOSE=1]\n"
      "#   STRICT: a rebuilt program makes its results again; VERBOSE: commands, and programs with -v\n"
      ".DELETE_ON_ERROR:\n"
      ".SUFFIXES:\n"
      "MAKEFLAGS += --no-builtin-rules\n"
      "LAUNCH ?=\n"
      "# OpenBLAS's threads come when `blas_threads` asks for them; made at every start they would "
      "burn 0.07 s of CPU each, waiting\n"
      "export OPENBLAS_NUM_THREADS ?= 1\n";
  text += fmt::format("BIN ?= {}\n\n.PHONY: all\nall: {}\n", bin, fmt::join(finals, " "));
  // `make` ends with the folder of the results instead of "Nothing to be done". The recipe is
  // hidden from `make -q`, which asks whether anything is to be made: any recipe of `all` would be.
  text +=
      "ifeq (,$(findstring q,$(filter-out --%,$(firstword -$(MAKEFLAGS)))))\n"
      "\t@echo \"results: $(CURDIR)\"\n"
      "endif\n";
  for (const Rule& rule : rules) {
    const std::string program = "$(BIN)/" + rule.program;
    text += fmt::format("\n{}: {} $(if $(STRICT),{}) | {}\n", rule.target,
                        fmt::join(rule.prerequisites, " "), program, program);
    // The name of what is made in place of its command, which the log has as its first line.
    text += fmt::format(
        "\t$(if $(VERBOSE),,$(info making $@)@)$(LAUNCH) {} {} $(if $(VERBOSE),-v )"
        "--log $(basename $@).log -o $@\n",
        program, rule.arguments);
  }
  return text;
}

}  // namespace langer::pipeline

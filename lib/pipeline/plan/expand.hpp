// Expands a pipeline into steps, one for each run of a program. Files are read only by the function
// that is passed, so the expansion can be tested without files.
//
// A node's axes are its own sweep plus those of its inputs; `over` removes the axes that it
// gathers. Several axes multiply. Axes nest in the order in which the pipeline declares them:
// code_FER/alpha_030/solve.
//
// Refused: nodes that depend on each other, an axis that is declared again with other points,
// `over` an unknown axis, an input of the wrong kind, two members with the same folder, and more
// than 10 000 steps.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/plan/pipeline.hpp"

namespace langer::pipeline {

// One input file of a step.
struct StepInput {
  std::string port;
  // Relative to the run's folder if a step makes it, otherwise as written in the pipeline.
  std::string path;
  bool made = false;  // by a step
  Place place;
};

// One run of a program: a node for one member of the sweep.
struct Step {
  std::string node;
  const StageSpec* stage = nullptr;
  std::string folder;  // relative to the run's folder
  Tree config;         // with `set` and the member's values applied
  std::vector<StepInput> inputs;
  bool final = true;  // no other step reads its output

  std::string output() const { return folder + "/" + stage->output; }
};

using ReadYaml = std::function<Tree(const std::string& path)>;
std::vector<Step> expand(const Pipeline& pipeline, const ReadYaml& read);

// "alpha_030": the integer part of numbers is padded so that folders sort
std::string member_folder(const Axis& axis, std::size_t point);

}  // namespace langer::pipeline

// Changes of a pipeline from the command line, before it is read: a value of a node's config, or a
// sweep that the file does not have.
//   --set   solve.friction=0.2          nodes.solve.set:   {friction: 0.2}
//   --sweep solve.friction=[0, 0.2]     nodes.solve.sweep: {friction: {key: friction, values: [0, 0.2]}}
// An axis is named after the last key of its path; `angle:solve.fibre_angles[0]=[0, 60]` gives it
// another name. Refused (Failure config): another form, an unknown node, and --set of a key that
// the node sweeps.
#pragma once

#include <string>
#include <vector>

#include "core/config/tree.hpp"

namespace langer::pipeline {

// The texts after --set and --sweep, in the order of the command line.
struct Overrides {
  std::vector<std::string> settings, sweeps;
};

void apply(const Overrides& overrides, Tree& pipeline);

// A value that was typed after an option. Messages about it name the option, because it has no line
// in a file.
Tree typed_value(const std::string& text, const char* option);

}  // namespace langer::pipeline

// The stages, and the input and output files of each. This one table is used by the arguments of
// the programs, by plan, by the JSON Schema of pipelines and by the docs.
//
// A stage reads its files at ports and writes one main output, whose name is the same in every run:
// langer-solve reads mesh.h5 at --mesh and writes solution.h5. A pipeline connects the output of
// one node with a port of another, and the table states which stages fit to which port.
#pragma once

#include <string>
#include <vector>

namespace langer {

// An input of a stage: the option --name of its program, and the key of that name of its node.
struct Port {
  const char* name;
  const char* says;                  // what the file contains
  std::vector<std::string> made_by;  // stages whose main output it takes
  bool required = true;
  bool or_key = false;      // the file, or a key of this name in the config: exactly one of the two
  bool several = false;     // --port may be repeated; the order counts
  bool takes_yaml = false;  // the file may be written by hand, as YAML
  // The keys `axes` and `members` of the config describe the files. They are written by plan.
  bool members = false;
};

// One stage, which is the program langer-<name>.
struct StageSpec {
  const char* name;
  const char* sentence;  // first line of --help
  std::vector<Port> inputs;
  const char* output;        // name of the main output file in the node's folder
  bool forecasts = false;    // --dry-run estimates time and memory
  const char* exports = "";  // help of --export; empty: the stage does not have it

  const Port* port(const std::string& name) const;
};

const std::vector<StageSpec>& stages();
const StageSpec* find_stage(const std::string& name);  // nullptr if there is none
std::vector<std::string> stage_names();

}  // namespace langer

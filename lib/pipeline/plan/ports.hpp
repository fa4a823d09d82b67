// Which inputs and which output each stage has: the single table used by the programs' arguments,
// by plan and by the docs.
#pragma once

#include <string>
#include <vector>

namespace langer {

struct Port {
  const char* name;
  const char* says;                  // what the file holds
  std::vector<std::string> made_by;  // stages whose main output it takes
  bool required = true;
  bool or_key = false;   // a key of this name in the config may stand in for the file; one of the
                         // two must be there
  bool several = false;  // --port may be repeated; the order counts
  bool takes_yaml = false;  // the file may be written by hand, as YAML
  bool members =
      false;  // the config's keys axes and members say what each file is; written by plan
};

struct StageSpec {
  const char* name;
  const char* sentence;  // first line of --help
  std::vector<Port> inputs;
  const char* output;        // name of the main output file in the node's folder
  bool forecasts = false;    // knows --dry-run
  const char* exports = "";  // knows --export, which says this

  const Port* port(const std::string& name) const;
};

const std::vector<StageSpec>& stages();
const StageSpec* find_stage(const std::string& name);  // nullptr if there is none
std::vector<std::string> stage_names();

}  // namespace langer

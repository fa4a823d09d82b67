// What a file of Gmsh holds, before it becomes a mesh of ours: nodes and cells by their tags, and
// the physical groups. Types of elements are those of the MSH format.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace langer {

struct MshElements {  // of one type
  int type = 0;
  std::string name;  // of the type, e.g. "Pyramid 5"
  std::vector<std::size_t> tags;
  std::vector<std::size_t> nodes;  // tags, one element after the other
  std::vector<int> lines;          // of the file, by element; empty if it is not a text
};

struct MshGroup {  // a physical group
  int dim = 0;
  int tag = 0;
  std::string name;                   // may be empty
  std::vector<MshElements> elements;  // of dim 2 and 3
  std::vector<std::size_t> nodes;     // of dim 0 and 1, by tag
};

struct MshModel {
  bool has_volumes = true;
  std::vector<std::size_t> node_tags;
  std::vector<double> X;           // three for each node
  std::vector<MshElements> cells;  // of dim 3, one for each type
  std::vector<MshGroup> groups;    // by dim and tag
};

}  // namespace langer

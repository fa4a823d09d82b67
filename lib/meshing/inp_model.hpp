// What the cards of an Abaqus or CalculiX input file say of its mesh, in the numbers of the file.
//
// Nodes, elements and sets belong to a scope. A flat file has one scope, the model. A file of
// Abaqus/CAE has a scope for each *PART. An *INSTANCE places a part in the assembly, moved and
// turned, and has all that the part has. Sets of the assembly are sets of the model; their members
// are nodes or elements of instances.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/tensor/types.hpp"
#include "meshing/inp_cells.hpp"
#include "meshing/inp_material.hpp"
#include "meshing/inp_scanner.hpp"

namespace langer {

inline constexpr int own_scope = -1;

// first, first + step, ... last; `instance` says whose numbers these are
struct InpMembers {
  int instance = own_scope;
  long long first = 0, last = 0, step = 1;
  auto operator<=>(const InpMembers&) const = default;
};

struct InpSet {
  std::string name;  // as the file writes it: sets are looked up without regard to case
  bool internal = false;
  std::vector<InpMembers> members;
};
using InpSets = std::map<std::string, InpSet>;  // by name in upper case

struct InpElement {
  std::vector<long long> nodes;
  Place place;
};

// a side of an element, or of those of a set
struct InpSide {
  std::string what, side;
  Place place;
};
struct InpSurface {
  std::string name;
  std::vector<InpSide> sides;
};

// *ORIENTATION: three directions by points of the file.
struct InpOrientation {
  std::string name;
  bool cylindrical = false;
  // Rectangular: a is on axis 1, b in the plane of axes 1 and 2, c the origin. Cylindrical: axis 3
  // runs from a to b, and axis 1 from it outwards.
  Vec3 a = Vec3::Zero();
  Vec3 b = Vec3::Zero();
  Vec3 c = Vec3::Zero();
  int about = 0;      // axis of a further rotation, from 1; 0: none
  double angle = 0;   // of it [rad]
  int n_lines = 0;    // of data so far
  std::string fault;  // why it cannot be used; empty if it can
};

struct InpScope {
  std::map<long long, Vec3> nodes;
  std::map<long long, InpElement> cells;  // hexahedra or tetrahedra
  std::map<long long, InpElement> faces;  // corners of plane elements and shells
  InpSets node_sets, element_sets;
  std::map<std::string, InpSurface> surfaces;
  std::vector<std::string> sections;                   // keys of element sets of *SOLID SECTION
  std::vector<std::string> cells_by_card;              // and of those of *ELEMENT
  std::map<std::string, InpOrientation> orientations;  // by name in upper case
  std::map<std::string, std::string> oriented;     // element sets of sections, their ORIENTATION
  std::map<std::string, std::string> material_of;  // element sets of sections, their MATERIAL

  std::size_t size() const;  // entries of all these
};

struct InpInstance {
  std::string name;
  Place place;
  InpScope scope;  // what its part has, and what stands below *INSTANCE itself
  Vec3 translation = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
  Vec3 centre = Vec3::Zero();  // a point of the axis of rotation
  int n_lines = 0;             // of data so far

  Vec3 moved(const Vec3& x) const { return centre + rotation * (x + translation - centre); }
};

struct InpModel {
  InpScope scope;                                // a flat file, or the assembly
  std::vector<InpInstance> instances;            // also parts, where a file has no instance at all
  InpCell kind;                                  // of all cells
  std::map<std::string, InpMaterial> materials;  // by name in upper case
  std::set<std::string> left_out;                // cards, kinds of elements and parts
};

// Throws Failure(input) with the line.
InpModel read_inp_model(InpScanner& scanner);

}  // namespace langer

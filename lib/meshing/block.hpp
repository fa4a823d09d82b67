// Geometries of the mesh stage, as values with their listings; they span [origin, origin + size].
//   Block        hexahedra on three families of grid lines: even, or refined towards the centre in x and z and to the top in y
//   IndentedBlock  a Block whose cells follow from the indenter and one number
//   GradedBlock  square core, rings and outer blocks in the x-z plane (an O-grid), extruded along y: edges turn with the rings
//   FromFile     what another program meshed
//   SectionBox, IndentedDisc  two-dimensional scenes (mechanics/mesh/section.hpp)
// Observation points become nodes: grid lines of a Block are moved through them; a GradedBlock or a
// file must have nodes there.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/input_path.hpp"
#include "mechanics/mesh/mesh.hpp"
#include "mechanics/mesh/order.hpp"
#include "meshing/box.hpp"
#include "meshing/section_mesh.hpp"

namespace langer {

inline constexpr long long most_cells =
    4'000'000;  // beyond, a number is more likely a slip than a wish

// Cells around a place beside the middle: numbers of them below and above it, along x and z.
struct AroundPlace {
  std::array<double, 2> at{}, within{};
  std::array<std::array<int, 2>, 2> n{};
  std::optional<std::array<std::array<int, 2>, 2>> instead;  // of `n`, graded as they are
};

struct Block {
  static constexpr const char* key = "block";
  std::array<double, 3> origin{}, size{};
  std::array<int, 3> divisions{1, 1, 1};
  std::optional<TowardsCentre> centre;
  std::optional<TowardsTop> top;
  std::optional<std::array<int, 3>> instead;  // of `divisions`, graded as they are; not for files
  std::vector<double>
      borders;  // y of the faces between layers: grid lines go through them; not for files
  std::optional<AroundPlace>
      around;  // in place of the middle; its numbers add up to those above; not for files
  std::optional<MeshFamily> family;  // not for files
  static void fields(auto& v) {
    v(&Block::origin, "origin", unit::mm, "corner with the least coordinates");
    v(&Block::size, "size", unit::mm, "lengths along x, y, z", required, between(1e-3, 1e6));
    v(&Block::divisions, "divisions", unit::none, "number of cells along x, y, z", required,
      between(1, 1000));
    v(&Block::centre, "centre", unit::none,
      "refinement towards the centre in x and z; none: even cells");
    v(&Block::top, "top", unit::none, "refinement towards the top in y; none: even cells");
  }
  std::vector<Complaint> complaints() const;
  std::array<int, 3> numbers() const;  // of cells, as meshed
};

struct Core {
  double half_width = 0;
  int cells = 2;
  static void fields(auto& v) {
    v(&Core::half_width, "half_width", unit::mm, "half the side of the square under the indenter",
      required, positive);
    v(&Core::cells, "cells", unit::none, "cells along its side; even, so that the centre is a node",
      required, between(2, 1000));
  }
};

struct Ring {
  double radius = 0;
  int cells = 1;
  static void fields(auto& v) {
    v(&Ring::radius, "radius", unit::mm, "outer radius of the ring; a circle of nodes", required,
      positive);
    v(&Ring::cells, "cells", unit::none, "cells along the radius", required, between(1, 1000));
  }
};

struct GradedBlock {
  static constexpr const char* key = "graded_block";
  std::array<double, 3> origin{}, size{};
  Core core;
  std::vector<Ring> rings;
  int outer_cells = 1;
  int layers = 1;
  std::optional<TowardsTop> top;
  Blocks blocks = Blocks::turned;
  static void fields(auto& v) {
    v(&GradedBlock::origin, "origin", unit::mm, "corner with the least coordinates");
    v(&GradedBlock::size, "size", unit::mm, "lengths along x, y, z", required, between(1e-3, 1e6));
    v(&GradedBlock::core, "core", unit::none, "square core around the centre", required);
    v(&GradedBlock::rings, "rings", unit::none, "rings from the core outwards, at least one",
      required);
    v(&GradedBlock::outer_cells, "outer_cells", unit::none,
      "cells from the last ring to the sides, growing outwards", required, between(1, 1000));
    v(&GradedBlock::layers, "layers", unit::none, "number of cells along y", required,
      between(1, 1000));
    v(&GradedBlock::top, "top", unit::none, "refinement towards the top in y; none: even cells");
    v(&GradedBlock::blocks, "blocks", unit::none,
      "how the four blocks around the core are numbered, which frames: element_edges follows: each as its neighbour turned by "
      "90 degrees, or opposite ones as mirror images");
  }
  std::vector<Complaint> complaints() const;
};

// A block for a round indenter: cells by one number, their length in radii of the contact. Under
// the indenter they are even, up to 1.1 contact radii or `even`; to the sides, the bottom and far
// layers they grow. Halving `edge` halves them all.
struct IndentedBlock {
  static constexpr const char* key = "indented_block";
  std::array<double, 3> origin{}, size{};
  double radius = 0, depth = 0, edge = 0.175;
  double longer = 1;  // all cells by this factor, as nearly as their numbers allow; not for files
  std::optional<std::array<double, 2>> under, even;
  std::vector<double> borders;       // y of the faces between layers; not for files
  std::optional<MeshFamily> family;  // its cells follow from edge; not for files
  // Longest cells towards the sides where edge is 0.5, in proportion to its root [mm]; none: they
  // grow as an indentation needs them, which is too long for a sheet that bends. Not for files.
  std::optional<double> longest;
  static void fields(auto& v) {
    v(&IndentedBlock::origin, "origin", unit::mm, "corner with the least coordinates");
    v(&IndentedBlock::size, "size", unit::mm, "lengths along x, y, z", required,
      between(1e-3, 1e6));
    v(&IndentedBlock::radius, "radius", unit::mm, "of the indenter", required, positive);
    v(&IndentedBlock::depth, "depth", unit::mm, "how deep it is pressed, at most", required,
      positive);
    v(&IndentedBlock::edge, "edge", unit::none,
      "length of the cells under the indenter, in radii of the contact", between(0.02, 1));
    v(&IndentedBlock::under, "under", unit::mm,
      "x and z of the place below the indenter, a node; none: the middle of the block");
    v(&IndentedBlock::even, "even", unit::mm,
      "how far from there cells are even, along x and z; none: 1.1 radii of the contact", positive);
  }
  double contact_radius() const;  // of a sphere, where it cuts the undeformed surface [mm]
  bool in_the_middle() const;
  Block block() const;
  std::vector<Complaint> complaints() const;
};

// A mesh that another program made, with its sets and bodies (meshing/exchange.hpp).
struct FromFile {
  static constexpr const char* key = "file";
  InputPath file;
  std::optional<double> edge;
  std::optional<double> seal;
  double scale = 1;
  static void fields(auto& v) {
    v(&FromFile::file, "path", unit::none,
      "mesh of 8-node hexahedra: .msh of Gmsh (physical groups are kept as sets and bodies; with cells: tet15 also of tetrahedra) or .inp "
      "of Abaqus or CalculiX (with cells: hex27 of 20 or 27 nodes, with cells: tet15 of tetrahedra of 4 or 10); or a solid "
      "of CAD, .step, or what triangles enclose, .stl, whose faces are the sets face_1, face_2, ...",
      required);
    v(&FromFile::edge, "edge", unit::mm,
      "length of the cells that a .step or .stl is meshed with, about", positive);
    v(&FromFile::seal, "seal", unit::mm,
      "holes of an .stl up to this width are filled; none: an open surface is refused", positive);
    v(&FromFile::scale, "scale", unit::none, "mm in one unit of length of the file", positive);
  }
  bool is_inp() const;
  std::vector<Complaint> complaints() const;
};

using Geometry =
    std::variant<Block, GradedBlock, IndentedBlock, FromFile, SectionBox, IndentedDisc>;
bool is_section(const Geometry& geometry);
double* edge_in_contact_radii(
    Geometry& geometry);  // of the kinds that one number scales, else nullptr
inline bool has_edge_in_contact_radii(Geometry geometry) { return edge_in_contact_radii(geometry); }

// Kinds whose cells are laid out along axes from numbers of them. The functions below are for
// these.
bool has_numbers_of_cells(const Geometry& geometry);
std::vector<int> numbers_of_cells(const Geometry& geometry);  // along each axis, as meshed
// All cells longer by one factor, as nearly as their numbers allow, graded as they were; not for
// files. Where there is one cell along an axis it stays.
void lengthen_cells(Geometry& geometry, double factor);
// Puts the geometry into a family of meshes, through these breaks; a disc stays as it is.
void put_in_family(Geometry& geometry, const std::array<std::vector<double>, 3>& breaks);
// of a geometry in a family; nullptr of others
MeshFamily* family_of(Geometry& geometry);
// the same in the keys of the config: edge, or divisions and the edges of graded cells; also
// shorter ones
void scale_cells(Geometry& geometry, double factor);
Box box(const Geometry& geometry);  // what it spans; of a file, not read yet, nothing
using Points = std::map<std::string, Vec3>;

// Mesh with positions and cells, numbered in order, exactly symmetric where it is symmetric; no
// sets, bodies or frames yet. `notes` gets what a user may want to know, such as moved grid lines.
// Failures name keys under `geometry` and `points`.
Mesh mesh_of(const Block& block, const Points& points, std::vector<std::string>& notes);
Mesh mesh_of(const GradedBlock& block, const Points& points, std::vector<std::string>& notes);
Mesh mesh_of(const IndentedBlock& block, const Points& points, std::vector<std::string>& notes);
Mesh mesh_of(const SectionBox& box, const Points& points, std::vector<std::string>& notes);
Mesh mesh_of(const IndentedDisc& disc, const Points& points, std::vector<std::string>& notes);
// with its sets and bodies, in its own order; cells: what a solid is meshed with
Mesh mesh_of(const FromFile& file, CellType cells, std::vector<std::string>& notes);

// What can be seen to be wrong before meshing: refinements that do not fit, points outside or too
// close to each other.
std::vector<Complaint> contradictions(const Block& block, const Points& points);
std::vector<Complaint> contradictions(const GradedBlock& block, const Points& points);
std::vector<Complaint> contradictions(const IndentedBlock& block, const Points& points);
std::vector<Complaint> contradictions(const SectionBox& box, const Points& points);
std::vector<Complaint> contradictions(const IndentedDisc& disc, const Points& points);
std::vector<Complaint> contradictions(const FromFile& file, const Points& points);

// Sets each point's node set, the node exactly there; throws Failure(config) with the nearest node
// where there is none.
void name_points(Mesh& mesh, const Points& points);

}  // namespace langer

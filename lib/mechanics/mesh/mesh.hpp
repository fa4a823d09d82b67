// A mesh with named sets and one orthonormal frame per cell.
//   X             reference positions [mm], one per node
//   connectivity  nodes of cell e at [e * nodes_per_cell, ...), in VTK order (mesh/reference.hpp)
//   body          per cell, index into `bodies`
//   frames        per cell, columns e_x e_y e_z (orthonormal, right-handed); a = cos(alpha) e_x + sin(alpha) e_z   [A23] eq. 1
//   node_sets     name -> nodes, ascending; observation points are sets of one node
//   facet_sets    name -> (cell, local facet)
//   section       the mesh is one layer of cells that stands for more (mesh/section.hpp)
//   hanging       nodes in the middle of an edge or facet of a larger cell, ascending (mesh/cut.hpp)
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

// All other properties of a cell type are in its reference cell (mesh/reference.hpp).
enum class CellType { hex8, hex27, tet15 };
constexpr auto names(CellType) { return std::array{"hex8", "hex27", "tet15"}; }
constexpr int nodes_per_cell(CellType type) {
  return std::array{8, 27, 15}[static_cast<std::size_t>(type)];
}
struct ReferenceCell;
const ReferenceCell& reference(CellType type);

struct Facet {
  int cell = 0;
  int local =
      0;  // hexahedra: 0 -xi, 1 +xi, 2 -eta, 3 +eta, 4 -zeta, 5 +zeta; tetrahedra: Tet15::facet
};

enum class SectionOf { axisymmetric, plane_strain };
constexpr auto names(SectionOf) { return std::array{"axisymmetric", "plane_strain"}; }
struct Section {
  SectionOf of = SectionOf::axisymmetric;
  double depth = 0;  // of the layer along z: for each mm of x [-]; of plane strain [mm]
  friend bool operator==(const Section&, const Section&) = default;
};

// A node that moves with the mean of four others: the corners of a facet, or the ends of an edge,
// each twice.
struct HangingNode {
  int node = 0;
  std::array<int, 4> of{};
};

struct Mesh {
  CellType type = CellType::hex8;
  std::vector<Vec3> X;
  std::vector<int> connectivity;
  std::vector<int> body;
  std::vector<std::string> bodies;
  std::vector<Mat3> frames;
  std::map<std::string, std::vector<int>> node_sets;
  std::map<std::string, std::vector<Facet>> facet_sets;
  std::optional<Section> section;
  std::vector<HangingNode> hanging;

  const ReferenceCell& cell() const { return reference(type); }
  int n_nodes() const { return static_cast<int>(X.size()); }
  int n_cells() const { return static_cast<int>(connectivity.size()) / nodes_per_cell(type); }
  std::span<const int> cell(int e) const {
    const int n = nodes_per_cell(type);
    return {connectivity.data() + static_cast<std::size_t>(e) * n, static_cast<std::size_t>(n)};
  }
};

}  // namespace langer

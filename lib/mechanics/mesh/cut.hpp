// Local refinement: marked cells are cut into eight, next to others that are not.
//   2:1      cells that share a node differ by at most one cut; further cells are cut to ensure this.
//            So an edge or a facet of a larger cell has at most one node in its middle, and the nodes
//            that this depends on are not hanging themselves (Mesh::hanging, mesh/hanging.hpp)
//   places   new nodes are the middles of edges, facets and cells: the surface of the body stays
//   kept     bodies, frames and sets: a node between nodes of a set is in it, and so are the quarters
//            of a facet
// For hex8 only, not for sections.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "mechanics/mesh/mesh.hpp"

namespace langer {

class CutMesh {
 public:
  explicit CutMesh(Mesh mesh);  // nothing cut yet; nothing hangs in it

  const Mesh& mesh() const { return mesh_; }
  int level(int e) const { return level_[e]; }  // cuts that made the cell

  void cut(std::vector<char> marked);  // by cell

 private:
  void close(std::vector<char>& marked) const;
  int middle(const std::vector<int>& corners);  // of an edge, a facet or a cell
  void add_children(int e, Mesh& to);
  void find_hanging();

  Mesh mesh_;
  std::vector<int> level_;
  std::map<std::array<int, 2>, int> edges_;  // by ends: the node in the middle
  std::map<std::array<int, 4>, int> facets_;
};

// Whether a region contains a part of a cell, by the bounding box of the cell.
struct CutRegion {
  Vec3 from, to;  // box, or the vertical cylinder in it
  bool round = false;
};
bool has_part_of(const CutRegion& region, const Mesh& mesh, int e);

}  // namespace langer

// Cells cut into eight, beside others that are not: where results ask for short cells, and nowhere
// else.
//   2:1      cells that share a node differ by one cut at most; what that asks for is cut too. So an edge or a facet of a larger cell has
//            one node in its middle at most, and none of those that it hangs on hangs itself (Mesh::hanging, mesh/hanging.hpp)
//   places   new nodes lie in the middles of edges, facets and cells: the body keeps the surface that it had
//   kept     bodies, frames and sets: a node between nodes of a set is in it, so are the quarters of a facet
// hex8 that are no section.
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

// The part of a cell that a region must have for it to be cut lies within the cell's bounding box.
struct CutRegion {
  Vec3 from, to;  // box, or the vertical cylinder in it
  bool round = false;
};
bool has_part_of(const CutRegion& region, const Mesh& mesh, int e);

}  // namespace langer

#include "mechanics/mesh/hanging.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace langer {

// A hanging node is in the middle of an edge or a facet of a larger neighbour and has no unknowns
// of its own: it moves with the mean of the corners that it hangs on. For each cell with such
// nodes, the constructor finds the nodes that do move and the weights of their displacements.
MovingNodes::MovingNodes(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.hanging.empty()) return;
  if (mesh.type != CellType::hex8)
    throw std::logic_error("nodes hang in a mesh of other cells than hex8");
  // By node: what it hangs on, or null. A search in the list for each corner would be quadratic.
  std::vector<const HangingNode*> hangs(mesh.X.size(), nullptr);
  for (const HangingNode& h : mesh.hanging) hangs[h.node] = &h;
  row_.assign(mesh.n_cells(), -1);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const auto nodes = mesh.cell(e);
    if (std::any_of(nodes.begin(), nodes.end(), [&](int n) { return hangs[n] != nullptr; }))
      add_cell(e, hangs);
  }
}

// A cell of eight corners must depend on eight moving nodes. Each hanging corner is replaced by a
// node that it hangs on and that is not yet a corner of the cell. The counts agree where neighbours
// differ by one level of cutting; a larger difference is refused.
void MovingNodes::add_cell(int e, const std::vector<const HangingNode*>& hangs) {
  const auto own = mesh_.cell(e);
  std::array<int, 8> moves;
  std::vector<int> others;  // ascending
  for (std::size_t a = 0; a < 8; ++a) {
    moves[a] = own[a];
    if (const HangingNode* h = hangs[own[a]]) {
      moves[a] = -1;  // replaced below
      others.insert(others.end(), h->of.begin(), h->of.end());
    }
  }
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  // Corners of the cell that move themselves are already among the eight.
  std::erase_if(others,
                [&](int n) { return std::find(moves.begin(), moves.end(), n) != moves.end(); });
  std::size_t next = 0;
  for (int& n : moves)
    if (n < 0 && next < others.size()) n = others[next++];
  const bool one_for_each =
      next == others.size() && std::find(moves.begin(), moves.end(), -1) == moves.end();
  // A node that hangs on a node that hangs would need products of weights, which a mesh cut level
  // by level never has.
  const bool hang_again =
      std::any_of(others.begin(), others.end(), [&](int n) { return hangs[n] != nullptr; });
  if (!one_for_each || hang_again)
    throw std::logic_error("a neighbour of an element is less than half as long");
  // u_corner = C u_moving. A row of a moving corner has a single 1. A row of a hanging corner has
  // four quarters; on an edge each end is listed twice, so its two weights become 1/2.
  MatX C = MatX::Zero(8, 8);
  const auto slot = [&](int n) {
    return std::find(moves.begin(), moves.end(), n) - moves.begin();
  };
  for (Eigen::Index a = 0; a < 8; ++a) {
    const HangingNode* h = hangs[own[static_cast<std::size_t>(a)]];
    if (!h)
      C(a, a) = 1;
    else
      for (int n : h->of) C(a, slot(n)) += 0.25;
  }
  row_[e] = static_cast<int>(nodes_.size());
  nodes_.push_back(moves);
  weights_.push_back(std::move(C));
}

// Cells without hanging corners have no row: their own nodes are those that move.
std::span<const int> MovingNodes::of(int e) const {
  if (row_.empty() || row_[e] < 0) return mesh_.cell(e);
  return std::span<const int>(nodes_[row_[e]]);
}

const MatX* MovingNodes::weights(int e) const {
  if (row_.empty() || row_[e] < 0) return nullptr;
  return &weights_[row_[e]];
}

// The list ascends by node, so a binary search is enough.
const HangingNode* hanging_at(const std::vector<HangingNode>& hanging, int node) {
  const auto at = std::ranges::lower_bound(hanging, node, {}, &HangingNode::node);
  if (at != hanging.end() && at->node == node) return &*at;
  return nullptr;
}

// A set of nodes, together with the hanging nodes all of whose supports are in the set. A node on a
// supported edge moves with its ends, so it belongs to the support as well.
std::vector<int> with_hanging(const Mesh& mesh, std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  const std::vector<int> own = nodes;
  for (const HangingNode& h : mesh.hanging)
    if (std::all_of(h.of.begin(), h.of.end(),
                    [&](int n) { return std::binary_search(own.begin(), own.end(), n); }))
      nodes.push_back(h.node);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Checks hanging nodes that were read from a file. An empty text means no fault. Each node must be
// in the middle of its supports, to 1e-6 of their distance: the weights of 1/4 assume it.
std::string hanging_fault(const Mesh& mesh) {
  if (mesh.type != CellType::hex8 || mesh.section)
    return "hanging nodes in a mesh of other elements than hex8";
  int before = -1;
  for (const HangingNode& h : mesh.hanging) {
    if (h.node <= before) return fmt::format("node {} behind node {}", h.node, before);
    before = h.node;
    Vec3 middle = Vec3::Zero();
    double size = 0;
    for (int n : h.of) {
      middle += 0.25 * mesh.X[n];
      size = std::max(size, (mesh.X[n] - mesh.X[h.of[0]]).norm());
    }
    if (!((middle - mesh.X[h.node]).norm() <= 1e-6 * size))
      return fmt::format("node {}, which is not in the middle of those it hangs on", h.node);
  }
  // The table of moving nodes finds what remains: cells with wrong numbers of supports.
  try {
    const MovingNodes moving(mesh);
  } catch (const std::logic_error& wrong) {
    return wrong.what();
  }
  return "";
}

}  // namespace langer

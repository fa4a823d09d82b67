#include "mechanics/mesh/cut.hpp"

#include <algorithm>
#include <stdexcept>

#include "mechanics/mesh/reference.hpp"

namespace langer {

namespace {

// Place 0, 1 or 2 along each axis of a cell: the corners that a node there lies between.
std::vector<int> corners_at(std::span<const int> cell, const std::array<int, 3>& place) {
  std::vector<int> corners;
  for (std::size_t c = 0; c < 8; ++c) {
    bool near = true;
    for (std::size_t k = 0; k < 3; ++k)
      near = near && (place[k] == 1 || (place[k] == 2) == (Hex8::corner[c][k] > 0));
    if (near) corners.push_back(cell[c]);
  }
  return corners;
}

template <std::size_t n>
// Sorted corners identify an edge or a facet in whichever cell it is seen.
std::array<int, n> key_of(const std::vector<int>& corners) {
  std::array<int, n> key;
  std::copy(corners.begin(), corners.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

// every edge (n = 2) or facet (n = 4) of a cell, as its corners
template <class On>
void each_middle(std::span<const int> cell, const On& on) {
  for (int i = 0; i < 27; ++i) {
    const std::array<int, 3> place{i % 3, i / 3 % 3, i / 9};
    const auto ones = std::count(place.begin(), place.end(), 1);
    if (ones == 1 || ones == 2) on(corners_at(cell, place));
  }
}

}  // namespace

CutMesh::CutMesh(Mesh mesh)
    : mesh_(std::move(mesh)), level_(static_cast<std::size_t>(mesh_.n_cells()), 0) {
  if (mesh_.type != CellType::hex8 || mesh_.section || !mesh_.hanging.empty())
    throw std::logic_error("cells of this mesh cannot be cut");
}

// Whoever shares a node with a cell that is cut, and was cut less often than it, is cut as well.
void CutMesh::close(std::vector<char>& marked) const {
  std::vector<std::vector<int>> cells(mesh_.X.size());
  for (int e = 0; e < mesh_.n_cells(); ++e)
    for (int n : mesh_.cell(e)) cells[n].push_back(e);
  std::vector<int> left;
  for (int e = 0; e < mesh_.n_cells(); ++e)
    if (marked[e]) left.push_back(e);
  while (!left.empty()) {
    const int e = left.back();
    left.pop_back();
    for (int n : mesh_.cell(e))
      for (int other : cells[n])
        if (!marked[other] && level_[other] < level_[e]) {
          marked[other] = 1;
          left.push_back(other);
        }
  }
}

// The node in the middle of an edge, a facet or a cell. Cells that share an edge or a facet share
// its node; the middle of a cell belongs to that cell alone. A new node joins the node sets that
// have all its corners, unless it is inside the cell.
int CutMesh::middle(const std::vector<int>& corners) {
  const auto added = [&] {
    Vec3 X = Vec3::Zero();
    for (int n : corners) X += mesh_.X[n];
    mesh_.X.push_back(X / static_cast<double>(corners.size()));
    const int node = mesh_.n_nodes() - 1;
    for (auto& [name, set] : mesh_.node_sets)
      if (corners.size() < 8 &&
          std::all_of(corners.begin(), corners.end(), [&, &nodes = set](int n) {
            return std::binary_search(nodes.begin(), nodes.end(), n);
          }))
        set.push_back(node);  // the largest so far
    return node;
  };
  if (corners.size() == 8) return added();
  int* known = nullptr;
  if (corners.size() == 2)
    known = &edges_.try_emplace(key_of<2>(corners), -1).first->second;
  else
    known = &facets_.try_emplace(key_of<4>(corners), -1).first->second;
  int& node = *known;
  if (node < 0) node = added();
  return node;
}

// Cuts a cell into eight. A grid of 3 x 3 x 3 places holds the old corners and the middles; each
// child has a corner of the old cell and the middles around it. Bodies and fibre frames are
// inherited: a child has the frame of its parent.
void CutMesh::add_children(int e, Mesh& to) {
  const auto span = mesh_.cell(e);
  const std::vector<int> cell(span.begin(), span.end());
  std::array<int, 27> at;
  for (int ones = 0; ones < 4; ++ones)  // edges before facets
    for (int i = 0; i < 27; ++i) {
      const std::array<int, 3> place{i % 3, i / 3 % 3, i / 9};
      if (std::count(place.begin(), place.end(), 1) != ones) continue;
      const std::vector<int> corners = corners_at(cell, place);
      if (ones == 0) {
        at[i] = corners[0];
      } else {
        at[i] = middle(corners);
      }
    }
  for (int child = 0; child < 8; ++child) {
    for (int c = 0; c < 8; ++c) {
      int i = 0;
      for (int k = 2; k >= 0; --k) i = 3 * i + (child >> k & 1) + (Hex8::corner[c][k] > 0);
      to.connectivity.push_back(at[i]);
    }
    if (!mesh_.body.empty()) to.body.push_back(mesh_.body[e]);
    if (!mesh_.frames.empty()) to.frames.push_back(mesh_.frames[e]);
  }
}

// Cuts the marked cells and those that the rule of one level requires. Children replace their
// parent at its place in the order of cells. A facet in a set is replaced by its four quarters:
// those of the children on the same side, as bit k of a child's number is its side along axis k and
// facet 2 k + s is on side s of axis k.
void CutMesh::cut(std::vector<char> marked) {
  close(marked);
  Mesh to;
  std::vector<int> first, level;
  for (int e = 0; e < mesh_.n_cells(); ++e) {
    first.push_back(static_cast<int>(level.size()));
    const int n = marked[e] ? 8 : 1;
    level.insert(level.end(), n, level_[e] + (marked[e] ? 1 : 0));
    if (marked[e]) {
      add_children(e, to);
      continue;
    }
    for (int node : mesh_.cell(e)) to.connectivity.push_back(node);
    if (!mesh_.body.empty()) to.body.push_back(mesh_.body[e]);
    if (!mesh_.frames.empty()) to.frames.push_back(mesh_.frames[e]);
  }
  for (auto& [name, facets] : mesh_.facet_sets) {
    std::vector<Facet> parts;
    for (const Facet& f : facets)
      for (int child = 0; child < (marked[f.cell] ? 8 : 1); ++child)
        if (!marked[f.cell] || (child >> f.local / 2 & 1) == f.local % 2)
          parts.push_back({first[f.cell] + child, f.local});
    facets = std::move(parts);
  }
  mesh_.connectivity = std::move(to.connectivity);
  mesh_.body = std::move(to.body);
  mesh_.frames = std::move(to.frames);
  level_ = std::move(level);
  find_hanging();
}

// A middle that was made for an edge or a facet hangs as long as some cell still has the whole edge
// or facet. Edges list each end twice, so that four weights of 1/4 are the mean of two.
void CutMesh::find_hanging() {
  std::map<int, HangingNode> found;
  for (int e = 0; e < mesh_.n_cells(); ++e)
    each_middle(mesh_.cell(e), [&](const std::vector<int>& corners) {
      if (corners.size() == 2) {
        const auto at = edges_.find(key_of<2>(corners));
        if (at != edges_.end())
          found[at->second] = {at->second,
                               {at->first[0], at->first[1], at->first[0], at->first[1]}};
      } else {
        const auto at = facets_.find(key_of<4>(corners));
        if (at != facets_.end()) found[at->second] = {at->second, at->first};
      }
    });
  mesh_.hanging.clear();
  for (const auto& [node, hangs] : found) mesh_.hanging.push_back(hangs);
}

// Whether a cell overlaps a region, by the box around the cell: touching faces do not count. A
// round region is an elliptic cylinder along y; the point of the box nearest to its axis decides.
bool has_part_of(const CutRegion& region, const Mesh& mesh, int e) {
  Vec3 low = mesh.X[mesh.cell(e)[0]];
  Vec3 high = low;
  for (int n : mesh.cell(e)) {
    low = low.cwiseMin(mesh.X[n]);
    high = high.cwiseMax(mesh.X[n]);
  }
  const double slack = 1e-9 * (high - low).norm();
  for (int k = 0; k < 3; ++k)
    if (high[k] - slack <= region.from[k] || low[k] + slack >= region.to[k]) return false;
  if (!region.round) return true;
  const Vec3 middle = 0.5 * (region.from + region.to);
  const Vec3 half = 0.5 * (region.to - region.from);
  double sum = 0;  // of the nearest point, in half axes
  for (int k : {0, 2})
    sum += std::pow((std::clamp(middle[k], low[k], high[k]) - middle[k]) / half[k], 2);
  return sum < 1;
}

}  // namespace langer

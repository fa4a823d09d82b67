#include "mechanics/mortar/mortar_linearisation.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <utility>

namespace langer {

namespace {

// Adds to a matrix at columns of degrees of freedom, if they have one.
class Columns {
 public:
  explicit Columns(const std::vector<int>& column_of) : column_of_(column_of) {}
  int of(int dof) const { return column_of_[static_cast<std::size_t>(dof)]; }

 private:
  const std::vector<int>& column_of_;
};

struct Turning {
  int dof;
  Vec3 dn;
};

// d nu_i by the corners of the facets around each candidate
std::vector<std::vector<Turning>> turnings(const SurfaceContact& contact, const VecX& x) {
  std::vector<Vec3> sum(contact.nodes.size(), Vec3::Zero());
  std::vector<std::map<int, Vec3>> change(contact.nodes.size());
  for (const QuadNodes& f : contact.own) {
    const Vec3 a = position(x, f[2]) - position(x, f[0]);
    const Vec3 b = position(x, f[3]) - position(x, f[1]);
    for (int node : f) {
      const auto i = static_cast<std::size_t>(
          std::lower_bound(contact.nodes.begin(), contact.nodes.end(), node) -
          contact.nodes.begin());
      sum[i] -= 0.5 * a.cross(b);
      for (int j = 0; j < 3; ++j) {
        const Vec3 e = Vec3::Unit(j);
        const Vec3 by_first = 0.5 * e.cross(b);
        const Vec3 by_second = 0.5 * a.cross(e);
        change[i].try_emplace(3 * f[0] + j, Vec3::Zero()).first->second += by_first;
        change[i].try_emplace(3 * f[2] + j, Vec3::Zero()).first->second -= by_first;
        change[i].try_emplace(3 * f[1] + j, Vec3::Zero()).first->second += by_second;
        change[i].try_emplace(3 * f[3] + j, Vec3::Zero()).first->second -= by_second;
      }
    }
  }
  std::vector<std::vector<Turning>> out(contact.nodes.size());
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const Vec3 mean = contact.within_mirrors(i, sum[i]);
    const double size = mean.norm();
    const Vec3 n = mean / size;
    for (const auto& [dof, change_of_sum] : change[i]) {
      const Vec3 dm = contact.within_mirrors(i, change_of_sum);
      out[i].push_back({dof, (dm - n * n.dot(dm)) / size});
    }
  }
  return out;
}

// Changes of one facet's weights by one coordinate.
struct WeightChange {
  int dof = 0;
  Vec4 dD;
  Mat4 dS;
  std::vector<Mat4> dB;  // by overlap
};

std::vector<WeightChange> weight_changes(const SurfaceContact& contact, const MortarFacet& facet,
                                         const VecX& x) {
  const QuadNodes& own = contact.own[static_cast<std::size_t>(facet.own)];
  const Vec3 a = position(x, own[2]) - position(x, own[0]);
  const Vec3 b = position(x, own[3]) - position(x, own[1]);
  const Vec3 n = a.cross(b).normalized();
  Mat4 inverse = Mat4::Zero();
  if (facet.beta > 0) inverse = facet.M.inverse();
  const Mat4 dual = facet.D.asDiagonal() * inverse;
  const double covered = facet.D.sum() / facet.area;
  // dK of one overlap, or of all of them
  const auto change = [&](int dof, const Mat4& dM, double d_area, int only, std::size_t c) {
    WeightChange out;
    out.dof = dof;
    out.dD = dM.rowwise().sum();
    Mat4 dA = Mat4::Zero();
    if (facet.beta > 0) {
      dA = facet.beta * (out.dD.asDiagonal() * inverse - dual * dM * inverse);
    }
    if (facet.beta_slope != 0) {
      const double d_covered = (out.dD.sum() - covered * d_area) / facet.area;
      dA += facet.beta_slope * d_covered * (dual - Mat4::Identity());
    }
    out.dS = dA * facet.M + facet.A * dM;
    for (std::size_t p = 0; p < facet.overlaps.size(); ++p) {
      Mat4 dB = dA * facet.overlaps[p].K;
      if (only < 0 || only == static_cast<int>(p)) dB += facet.A * facet.overlaps[p].dK[c];
      out.dB.push_back(dB);
    }
    return out;
  };
  std::vector<WeightChange> changes;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 3; ++j) {
      const auto c = static_cast<std::size_t>(3 * k + j);
      Mat4 dM = Mat4::Zero();
      for (const FacetOverlap& o : facet.overlaps) dM += o.dM[c];
      const Vec3 e = Vec3::Unit(j);
      Vec3 d_vector = 0.5 * a.cross(e);
      if (k == 0) d_vector = -0.5 * e.cross(b);
      if (k == 1) d_vector = -0.5 * a.cross(e);
      if (k == 2) d_vector = 0.5 * e.cross(b);
      changes.push_back(
          change(3 * own[static_cast<std::size_t>(k)] + j, dM, n.dot(d_vector), -1, c));
    }
  for (std::size_t p = 0; p < facet.overlaps.size(); ++p) {
    const QuadNodes& other = contact.other[static_cast<std::size_t>(facet.overlaps[p].other)];
    for (int k = 0; k < 4; ++k)
      for (int j = 0; j < 3; ++j) {
        const auto c = static_cast<std::size_t>(12 + 3 * k + j);
        changes.push_back(change(3 * other[static_cast<std::size_t>(k)] + j,
                                 facet.overlaps[p].dM[c], 0, static_cast<int>(p), c));
      }
  }
  return changes;
}

}  // namespace

MortarLaw mortar_law(const std::vector<MortarNode>& nodes, const std::vector<char>& wanted,
                     const VecX& x, const VecX& x0, const std::vector<Vec3>& reactions,
                     const std::vector<Vec3>& bonds) {
  MortarLaw law;
  const VecX moved = x - x0;
  for (const MortarNode& node : nodes) {
    const auto i = static_cast<std::size_t>(node.candidate);
    if (!wanted[i]) continue;
    const Mat3 frame = contact_frame(node.normal);
    const Vec3 v = frame.transpose() * node.average(moved);
    law.nodes.push_back(node);
    law.frames.push_back(frame);
    law.q.emplace_back(node.gap(), v[1], v[2]);
    law.r.emplace_back(frame.transpose() * reactions[i]);
    law.beside.emplace_back(Vec3::Zero());
    if (!bonds.empty()) law.beside.back() = frame.transpose() * bonds[i];
  }
  return law;
}

void add_mortar_matrices(const SurfaceContact& contact, const MortarLaw& law, const VecX& x,
                         const VecX& x0, const std::vector<int>& column_of, int first_row,
                         MortarMatrices& into) {
  const Columns columns(column_of);
  const VecX moved = x - x0;
  std::vector<int> row_of(contact.nodes.size(), -1);
  std::vector<Vec3> slip, traction, reaction;
  const auto turning = turnings(contact, x);
  // What changes a reaction as a whole acts on its nodes with their weights: by row and column.
  const auto n_rows = static_cast<Eigen::Index>(3 * law.nodes.size());
  const auto n_columns = static_cast<Eigen::Index>(
      std::count_if(column_of.begin(), column_of.end(), [](int c) { return c >= 0; }));
  SparseEntries weights, turned;
  for (std::size_t p = 0; p < law.nodes.size(); ++p) {
    const MortarNode& node = law.nodes[p];
    const Mat3& frame = law.frames[p];
    const int own_row = 3 * static_cast<int>(p);
    const int row = first_row + own_row;
    row_of[static_cast<std::size_t>(node.candidate)] = static_cast<int>(p);
    const Vec3 v = node.average(moved);
    slip.push_back(v);
    reaction.push_back(frame * (law.r[p] + law.beside[p]));
    traction.push_back(reaction[p] / node.area);
    const bool acts = !reaction[p].isZero(0);
    for (const auto* side : {&node.own, &node.other})
      for (const Weight& w : *side)
        for (int j = 0; j < 3; ++j) {
          const int column = columns.of(3 * w.node + j);
          if (column < 0 || node.mirrored[static_cast<std::size_t>(j)]) continue;
          into.L.add_block(row, column, Vec3(w.of * frame.row(j).transpose()));
          if (acts) weights.add(column, own_row + j, w.of);
        }
    for (const NodalForce& force : force_operator(node, x))
      for (int j = 0; j < 3; ++j)
        if (const int column = columns.of(3 * force.node + j); column >= 0)
          into.G.add_block(column, row, (force.per_reaction.row(j) * frame).eval());
    // normals turn, and the present reaction with them
    const Vec3 n = node.normal;
    for (const Turning& turn : turning[static_cast<std::size_t>(node.candidate)]) {
      const int column = columns.of(turn.dof);
      if (column < 0) continue;
      const Vec3 across = frame.transpose() * turn.dn;
      into.L.add_block(row, column,
                       Vec3(turn.dn.dot(node.jump), -across[1] * n.dot(v), -across[2] * n.dot(v)));
      if (!acts) continue;
      const Vec3 dr = reaction[p].dot(n) * turn.dn - n * reaction[p].dot(turn.dn);
      turned.add_block(own_row, column, dr);
    }
  }
  std::vector<std::map<int, double>> area_changes(law.nodes.size());
  for (const MortarFacet& facet : mortar_facets(contact, x, true)) {
    const QuadNodes& own = contact.own[static_cast<std::size_t>(facet.own)];
    std::array<int, 4> rows{};
    bool any = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = std::lower_bound(contact.nodes.begin(), contact.nodes.end(), own[i]);
      rows[i] = row_of[static_cast<std::size_t>(at - contact.nodes.begin())];
      any = any || rows[i] >= 0;
    }
    if (!any) continue;
    const Vec3 origin = position(x, own[0]);
    for (const WeightChange& change : weight_changes(contact, facet, x)) {
      const int column = columns.of(change.dof);
      if (column < 0) continue;
      // forces on the corners of the own facet, and of each overlapping one
      std::array<Vec3, 4> own_force;
      own_force.fill(Vec3::Zero());
      std::vector<std::array<Vec3, 4>> other_force(facet.overlaps.size(), own_force);
      bool forces = false;
      for (int i = 0; i < 4; ++i) {
        const int p = rows[static_cast<std::size_t>(i)];
        if (p < 0) continue;
        const auto at = static_cast<std::size_t>(p);
        Vec3 jump = Vec3::Zero();
        Vec3 v = Vec3::Zero();
        const Vec3& force = traction[at];
        const bool acts = !force.isZero(0);
        forces = forces || acts;
        for (int j = 0; j < 4; ++j) {
          const int node = own[static_cast<std::size_t>(j)];
          const double d = change.dS(i, j);
          jump += d * (position(x, node) - origin);
          v += d * position(moved, node);
          if (acts) own_force[static_cast<std::size_t>(j)] += d * force;
        }
        for (std::size_t o = 0; o < facet.overlaps.size(); ++o) {
          const QuadNodes& other = contact.other[static_cast<std::size_t>(facet.overlaps[o].other)];
          for (int k = 0; k < 4; ++k) {
            const int node = other[static_cast<std::size_t>(k)];
            const double d = change.dB[o](i, k);
            jump -= d * (position(x, node) - origin);
            v -= d * position(moved, node);
            if (acts) other_force[o][static_cast<std::size_t>(k)] -= d * force;
          }
        }
        const MortarNode& node = law.nodes[at];
        const Mat3& frame = law.frames[at];
        const double da = change.dD[i];
        const Vec3 dv = frame.transpose() * (node.within_mirrors(v) - da * slip[at]) / node.area;
        const double dg = node.normal.dot(jump - da * node.jump) / node.area;
        into.L.add_block(first_row + 3 * p, column, Vec3(dg, dv[1], dv[2]));
        if (acts) area_changes[at][column] += da / node.area;
      }
      if (!forces) continue;
      const auto add = [&](const QuadNodes& corners, const std::array<Vec3, 4>& force) {
        for (std::size_t j = 0; j < 4; ++j)
          for (int k = 0; k < 3; ++k)
            if (const int at = columns.of(3 * corners[j] + k); at >= 0)
              into.C.add(at, column, force[j][k]);
      };
      add(own, own_force);
      for (std::size_t o = 0; o < facet.overlaps.size(); ++o)
        add(contact.other[static_cast<std::size_t>(facet.overlaps[o].other)], other_force[o]);
    }
  }
  // the sums are divided by the area of their node
  for (std::size_t p = 0; p < law.nodes.size(); ++p)
    for (const auto& [column, share] : area_changes[p])
      turned.add_block(3 * static_cast<int>(p), column, Vec3(-share * reaction[p]));
  const Eigen::SparseMatrix<double> of_reactions =
      weights.matrix(n_columns, n_rows) * turned.matrix(n_rows, n_columns);
  for (int column = 0; column < of_reactions.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(of_reactions, column); entry; ++entry)
      into.C.add(static_cast<int>(entry.row()), column, entry.value());
}

}  // namespace langer

#include "mechanics/solve/surface_laws.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "mechanics/solve/touching_bodies.hpp"

namespace langer {

namespace {

class Linearisation {
 public:
  Linearisation(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
                const VecX& moves)
      : state_(state),
        bodies_(bodies),
        moves_(moves),
        x_(positions(state.X, state.u)),
        x0_(positions(state.X, u_begin)) {}

  SurfaceLaws laws(SurfaceLaws::Of of, SurfaceLaws::Nodes nodes) {
    if (of == SurfaceLaws::Of::near) find_rigid_rows();
    find_mortar_rows(of);
    number_columns(nodes);
    assemble();
    return std::move(out_);
  }

 private:
  Vec3 move_of(int node) const { return moves_.segment<3>(3 * static_cast<Eigen::Index>(node)); }

  bool holds(std::size_t contact, std::size_t candidate) const {
    return state_.bonds && state_.bonds->holds(contact, candidate);
  }

  // Candidates whose gap the movement may close. Those that are far off would only cost time.
  void find_rigid_rows() {
    for (std::size_t k = 0; k < state_.contacts.size(); ++k) {
      const RigidContact& contact = state_.contacts[k];
      const Vec3 c = state_.c[k];
      const Vec3 c0 = state_.c_start[k];
      for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
        const auto node = static_cast<std::size_t>(contact.nodes[i]);
        const Vec3 x = x_.segment<3>(3 * static_cast<Eigen::Index>(node));
        const Vec3 x0 =
            state_.X[node] + state_.u_start[k].segment<3>(3 * static_cast<Eigen::Index>(node));
        const double reach = (c - c0).norm() + 2 * move_of(contact.nodes[i]).norm() + 0.05;
        const Vec3& r = state_.r[k][i];
        const bool bonded = holds(k, i);
        if (!bonded && r.isZero(0) && shape_at(contact.shape, x - c).gap > reach) continue;
        LinearisedContact law = linearise(contact, x, x0, c, c0, r);
        if (bonded) law.D += law.frame.transpose() * state_.bonds->tangent(k, i) * law.frame;
        out_.rigid.push_back({k, i, law, law.frame.transpose() * r});
      }
    }
  }

  void find_mortar_rows(SurfaceLaws::Of of) {
    const auto& averages = bodies_.at(state_.X, state_.u);
    for (std::size_t s = 0; s < bodies_.surfaces().size(); ++s) {
      const SurfaceContact& surface = bodies_.surfaces()[s];
      const std::size_t k = state_.contacts.size() + s;
      const std::vector<Vec3>& r = state_.r[k];
      std::vector<char> wanted(surface.nodes.size(), 0);
      for (const MortarNode& node : averages[s]) {
        const auto i = static_cast<std::size_t>(node.candidate);
        const double reach = 2 * node.average(moves_).norm() + std::sqrt(node.area);
        wanted[i] =
            !r[i].isZero(0) || holds(k, i) || (of == SurfaceLaws::Of::near && node.gap() <= reach);
      }
      const bool adheres = state_.bonds && state_.bonds->of(k);
      out_.mortar.push_back(mortar_law(averages[s], wanted, x_, x0_, r,
                                       adheres ? state_.bonds->forces(k) : std::vector<Vec3>{}));
    }
  }

  void number_columns(SurfaceLaws::Nodes which) {
    out_.column_of.assign(static_cast<std::size_t>(x_.size()), -1);
    std::set<int> nodes;
    if (which == SurfaceLaws::Nodes::all) {
      for (int node : bodies_.nodes()) nodes.insert(node);
      for (const RigidContact& contact : state_.contacts)
        nodes.insert(contact.nodes.begin(), contact.nodes.end());
    }
    for (const SurfaceLaws::Rigid& row : out_.rigid)
      nodes.insert(state_.contacts[row.contact].nodes[row.candidate]);
    for (std::size_t s = 0; s < out_.mortar.size(); ++s) {
      const SurfaceContact& surface = bodies_.surfaces()[s];
      std::set<int> own;
      for (const MortarNode& node : out_.mortar[s].nodes) {
        own.insert(surface.nodes[static_cast<std::size_t>(node.candidate)]);
        for (const Weight& w : node.other) nodes.insert(w.node);
      }
      for (const QuadNodes& facet : surface.own)
        if (std::any_of(facet.begin(), facet.end(), [&](int n) { return own.count(n) > 0; }))
          nodes.insert(facet.begin(), facet.end());
    }
    for (int node : nodes)
      for (int dof = 3 * node; dof < 3 * node + 3; ++dof) {
        out_.column_of[static_cast<std::size_t>(dof)] = static_cast<int>(out_.dofs.size());
        out_.dofs.push_back(dof);
      }
  }

  void assemble() {
    const Eigen::Index rows = 3 * static_cast<Eigen::Index>(out_.n_rows());
    const auto columns = static_cast<Eigen::Index>(out_.dofs.size());
    out_.q.resize(rows);
    out_.r.resize(rows);
    out_.mu.resize(rows / 3);
    MortarMatrices into;
    int row = 0;
    for (const SurfaceLaws::Rigid& rigid : out_.rigid) {
      const RigidContact& contact = state_.contacts[rigid.contact];
      const int column =
          out_.column_of[3 * static_cast<std::size_t>(contact.nodes[rigid.candidate])];
      const LinearisedContact& law = rigid.law;
      into.L.add_block(row, column, Mat3(law.T * law.frame.transpose()));
      into.G.add_block(column, row, law.frame);
      into.C.add_block(column, column, Mat3(law.frame * law.D * law.frame.transpose()));
      out_.q.segment<3>(row) = law.q;
      out_.r.segment<3>(row) = rigid.r;
      out_.mu[row / 3] = contact.mu;
      row += 3;
    }
    for (std::size_t s = 0; s < out_.mortar.size(); ++s) {
      const MortarLaw& law = out_.mortar[s];
      if (law.nodes.empty()) continue;
      add_mortar_matrices(bodies_.surfaces()[s], law, x_, x0_, out_.column_of, row, into);
      add_bonds(s, into.C);
      for (std::size_t p = 0; p < law.nodes.size(); ++p) {
        out_.q.segment<3>(row) = law.q[p];
        out_.r.segment<3>(row) = law.r[p];
        out_.mu[row / 3] = bodies_.surfaces()[s].mu;
        row += 3;
      }
    }
    out_.L = into.L.matrix(rows, columns);
    out_.G = into.G.matrix(columns, rows);
    out_.C = into.C.matrix(columns, columns);
  }

  // The forces of bonds follow the movements of their nodes. How weights and normals change the
  // opening is left out: of the order of the opening over a facet.
  void add_bonds(std::size_t s, SparseEntries& C) const {
    const std::size_t k = state_.contacts.size() + s;
    for (const MortarNode& node : out_.mortar[s].nodes) {
      const auto candidate = static_cast<std::size_t>(node.candidate);
      if (!holds(k, candidate)) continue;
      const Mat3& tangent = state_.bonds->tangent(k, candidate);
      for (const NodalForce& force : force_operator(node, x_)) {
        const Mat3 by_opening = force.per_reaction * tangent;
        for (const auto* side : {&node.own, &node.other})
          for (const Weight& w : *side) {
            const int to = out_.column_of[3 * static_cast<std::size_t>(force.node)];
            const int by = out_.column_of[3 * static_cast<std::size_t>(w.node)];
            if (to >= 0 && by >= 0) C.add_block(to, by, Mat3(w.of * by_opening));
          }
      }
    }
  }

  const ContactState& state_;
  TouchingBodies& bodies_;
  const VecX& moves_;
  VecX x_, x0_;
  SurfaceLaws out_;
};

}  // namespace

int SurfaceLaws::n_rows() const {
  std::size_t n = rigid.size();
  for (const MortarLaw& law : mortar) n += law.nodes.size();
  return static_cast<int>(n);
}

void SurfaceLaws::give_reactions(const VecX& local, Reactions& out) const {
  Eigen::Index row = 0;
  for (const Rigid& one : rigid) {
    out[one.contact][one.candidate] = one.law.frame * local.segment<3>(row);
    row += 3;
  }
  const std::size_t first = out.size() - mortar.size();
  for (std::size_t s = 0; s < mortar.size(); ++s)
    for (std::size_t p = 0; p < mortar[s].nodes.size(); ++p) {
      out[first + s][static_cast<std::size_t>(mortar[s].nodes[p].candidate)] =
          mortar[s].frames[p] * local.segment<3>(row);
      row += 3;
    }
}

SurfaceLaws surface_laws(const ContactState& state, TouchingBodies& bodies, const VecX& u_begin,
                         const VecX& moves, SurfaceLaws::Of of, SurfaceLaws::Nodes nodes) {
  return Linearisation(state, bodies, u_begin, moves).laws(of, nodes);
}

}  // namespace langer

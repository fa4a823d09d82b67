#include "mechanics/solve/bond_changes.hpp"

#include <utility>

namespace langer {

namespace {

Vec3 of_node(const VecX& all, int node) {
  return all.segment<3>(3 * static_cast<Eigen::Index>(node));
}

}  // namespace

BondChanges::BondChanges(const Bonds& bonds, const std::vector<RigidContact>& contacts,
                         const std::vector<Vec3>& X, const VecX& u, std::vector<Vec3> c)
    : bonds_(bonds), contacts_(contacts), X_(X), u_(u), c_(std::move(c)) {}

Vec3 BondChanges::moved(std::size_t contact, std::size_t candidate, const ParameterChange& change,
                        const VecX& du) const {
  Vec3 v = of_node(du, contacts_[contact].nodes[candidate]);
  if (!change.indenters.empty()) v -= change.indenters[contact];
  return v;
}

// How the curvature changes on the way of a node along its indenter, by a central difference that
// is short against the radius.
Mat3 BondChanges::curvature_change(std::size_t contact, const Vec3& x, const Vec3& moved) const {
  constexpr double short_step = 1e-4;
  const Indenter& shape = contacts_[contact].shape;
  const double curvature = shape_at(shape, x).curvature.norm();
  const double way = moved.norm();
  if (curvature == 0 || way == 0) return Mat3::Zero();
  const double h = short_step / curvature;
  const Vec3 step = h / way * moved;
  const Mat3 more = shape_at(shape, x + step).curvature;
  const Mat3 less = shape_at(shape, x - step).curvature;
  return way / (2 * h) * (more - less);
}

AdhesiveChange BondChanges::at(std::size_t contact, std::size_t candidate, const BondMoves& moves,
                               const VecX& du) const {
  const int node = contacts_[contact].nodes[candidate];
  const Vec3 x = X_[static_cast<std::size_t>(node)] + of_node(u_, node) - c_[contact];
  BondChange change;
  if (!moves.start.empty()) {
    change.beta = moves.start[contact][candidate].beta;
    change.at = moves.start[contact][candidate].at;
    change.opening = moves.start[contact][candidate].opening;
  }
  change.v = moved(contact, candidate, moves.change, du);
  if (!moves.change.adhesion.empty()) change.law = moves.change.adhesion[contact];
  change.shape = shape_change(moves.change, contact, x);
  if (contacts_[contact].adhesion->tangential > 0)
    change.shape.curvature += curvature_change(contact, x, change.v);
  return bonds_.change(contact, candidate, X_, u_, c_[contact], change);
}

std::vector<std::vector<Vec3>> BondChanges::forces(const BondMoves& moves, const VecX& du) const {
  std::vector<std::vector<Vec3>> out(contacts_.size());
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!bonds_.of(k)) continue;
    for (std::size_t i = 0; i < contacts_[k].nodes.size(); ++i)
      out[k].push_back(bonds_.holds(k, i) ? at(k, i, moves, du).force : Vec3(Vec3::Zero()));
  }
  return out;
}

BondRates BondChanges::after(const BondMoves& moves, const VecX& du,
                             const std::vector<std::vector<Vec3>>& r,
                             const std::vector<std::vector<Vec3>>& r_0) const {
  BondRates out(contacts_.size());
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    if (!bonds_.of(k)) continue;
    for (std::size_t i = 0; i < contacts_[k].nodes.size(); ++i) {
      BondRate& rate = out[k].emplace_back();
      if (bonds_.made_anew(k, i, r, r_0)) {
        rate.at = moved(k, i, moves.change, du);
        continue;
      }
      if (!moves.start.empty()) rate = moves.start[k][i];
      const AdhesiveChange change = at(k, i, moves, du);
      rate.beta = change.beta;
      rate.opening = change.opening;
    }
  }
  return out;
}

}  // namespace langer

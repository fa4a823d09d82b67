#include "mechanics/solve/bonds.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/solve/touching_bodies.hpp"

namespace langer {

Bonds::Bonds(const std::vector<RigidContact>& contacts, TouchingBodies* surfaces)
    : contacts_(contacts) {
  bool by_surfaces = false;
  const auto add = [&](const auto& contact) {
    any_ = any_ || contact.adhesion;
    now_.emplace_back(contact.adhesion ? contact.nodes.size() : 0);
  };
  for (const RigidContact& contact : contacts) add(contact);
  if (surfaces)
    for (const SurfaceContact& surface : surfaces->surfaces()) {
      add(surface);
      by_surfaces = by_surfaces || surface.adhesion;
    }
  if (by_surfaces) surfaces_ = surfaces;
  if (!any_) now_.clear();
}

const Adhesion& Bonds::law(std::size_t contact) const {
  if (contact < contacts_.size()) return *contacts_[contact].adhesion;
  return *surfaces_->surfaces()[contact - contacts_.size()].adhesion;
}

double Bonds::area(std::size_t contact, std::size_t candidate) const {
  if (contact < contacts_.size()) return contacts_[contact].area[candidate];
  return surfaces_->surfaces()[contact - contacts_.size()].area[candidate];
}

BondStates Bonds::at_rest(const std::vector<Vec3>& X) const {
  constexpr double touch = 1e-9;  // [mm]
  BondStates states;
  for (const auto& contact : now_) states.emplace_back(contact.size());
  for (std::size_t k = 0; any_ && k < contacts_.size(); ++k) {
    const RigidContact& contact = contacts_[k];
    const Vec3 c = indenter_displacement(contact, 0);
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      if (shape_at(contact.shape, X[contact.nodes[i]] - c).gap <= touch)
        states[k][i] = {1, -c, true};
  }
  if (!surfaces_) return states;
  const VecX none = VecX::Zero(3 * static_cast<Eigen::Index>(X.size()));
  const auto& averages = surfaces_->at(X, none);
  for (std::size_t s = 0; s < averages.size(); ++s)
    for (const MortarNode& node : averages[s]) {
      const std::size_t k = contacts_.size() + s;
      if (!now_[k].empty() && node.gap() <= touch)
        states[k][static_cast<std::size_t>(node.candidate)] = {1, Vec3::Zero(), true};
    }
  return states;
}

void Bonds::begin(const BondStates& start, double seconds, const std::vector<Vec3>& X,
                  const VecX& u, const std::vector<Vec3>& c) {
  start_ = start;
  seconds_ = seconds;
  damping_ = 0;
  begin_surfaces(X, u);
  find_openings(X, u, c);
}

void Bonds::begin_surfaces(const std::vector<Vec3>& X, const VecX& u) {
  if (!surfaces_) return;
  u_start_ = u;
  const VecX x = positions(X, u);
  normals_.clear();
  for (const SurfaceContact& surface : surfaces_->surfaces()) {
    normals_.emplace_back();
    if (surface.adhesion) normals_.back() = mortar_normals(surface, x);
  }
}

void Bonds::find_openings(const std::vector<Vec3>& X, const VecX& u, const std::vector<Vec3>& c) {
  for (std::size_t k = 0; k < start_.size(); ++k) {
    if (start_[k].empty()) continue;
    const bool by_time = viscous(k) > 0;
    for (std::size_t i = 0; i < start_[k].size(); ++i) {
      Bond& bond = start_[k][i];
      bond.opening = -1;
      if (!by_time || !bond.made) continue;
      if (k < contacts_.size()) {
        const int node = contacts_[k].nodes[i];
        const Vec3 v = u.segment<3>(3 * node) - c[k];
        bond.opening = opening(law(k), shape_at(contacts_[k].shape, X[node] + v), v, bond);
      } else {
        const Vec3& normal = normals_[k - contacts_.size()][i];
        bond.opening =
            opening(law(k), {-normal.dot(bond.at), normal, Mat3::Zero()}, Vec3::Zero(), bond);
      }
    }
  }
}

double Bonds::viscous(std::size_t contact) const {
  const double viscosity = law(contact).viscosity;
  double rate = 0;
  if (viscosity > 0 && seconds_ > 0) rate = viscosity / seconds_;
  return rate + damping_;
}

Adhesive Bonds::bond(std::size_t contact, std::size_t candidate, const ShapePoint& shape,
                     const Vec3& v, const Bond& from) const {
  Adhesive now = adhesive(law(contact), shape, v, from, viscous(contact));
  const double size = area(contact, candidate);
  now.force *= size;
  now.tangent *= size;
  now.stored *= size;
  now.dissipated *= size;
  now.error *= size;
  return now;
}

void Bonds::evaluate(const std::vector<Vec3>& X, const VecX& u, const std::vector<Vec3>& c) {
  for (std::size_t k = 0; any_ && k < contacts_.size(); ++k) {
    const RigidContact& contact = contacts_[k];
    for (std::size_t i = 0; i < now_[k].size(); ++i) {
      now_[k][i] = {};
      if (!start_[k][i].made) continue;
      const int node = contact.nodes[i];
      const Vec3 v = u.segment<3>(3 * node) - c[k];
      now_[k][i] = bond(k, i, shape_at(contact.shape, X[node] + v), v, start_[k][i]);
    }
  }
  if (surfaces_) evaluate_surfaces(X, u);
}

// The law of a mortar node has no curvature: how its normal follows from the displacements is
// linearised with its reaction (solve/touching_bodies.cpp).
void Bonds::evaluate_surfaces(const std::vector<Vec3>& X, const VecX& u) {
  const VecX x = positions(X, u);
  const VecX moved = u - u_start_;
  const auto& averages = surfaces_->at(X, u);
  on_both_sides_ = VecX::Zero(u.size());
  openings_.resize(averages.size());
  for (std::size_t s = 0; s < averages.size(); ++s) {
    const std::size_t k = contacts_.size() + s;
    if (now_[k].empty()) continue;
    std::fill(now_[k].begin(), now_[k].end(), Adhesive{});
    openings_[s].assign(now_[k].size(), Vec3::Zero());
    for (const MortarNode& node : averages[s]) {
      const auto i = static_cast<std::size_t>(node.candidate);
      Bond from = start_[k][i];
      if (!from.made) continue;
      from.at = turn_with_normal(from.at, normals_[s][i], node.normal);
      // A bond that is open turns with the normal: in bodies that turn together it does not move.
      const Vec3 jump_before = node.jump - node.average(moved);
      const Vec3 v = node.jump - turn_with_normal(jump_before, normals_[s][i], node.normal);
      openings_[s][i] = v - from.at;
      const double gap = node.normal.dot(openings_[s][i]);
      now_[k][i] = bond(k, i, {gap, node.normal, Mat3::Zero()}, v, from);
    }
    add_mortar_forces(averages[s], x, forces(k), on_both_sides_);
  }
}

void Bonds::go_on() {
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      if (Bond& bond = start_[k][i]; bond.made) {
        bond.beta = now_[k][i].beta;
        bond.opening = -1;
      }
}

std::vector<Vec3> Bonds::forces(std::size_t contact) const {
  std::vector<Vec3> all;
  for (const Adhesive& now : now_[contact]) all.push_back(now.force);
  return all;
}

Vec3 Bonds::sum(std::size_t contact) const {
  Vec3 sum = Vec3::Zero();
  if (of(contact))
    for (const Adhesive& now : now_[contact]) sum += now.force;
  return sum;
}

void Bonds::add_forces(VecX& f) const {
  for (std::size_t k = 0; any_ && k < contacts_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      f.segment<3>(3 * contacts_[k].nodes[i]) += now_[k][i].force;
  if (on_both_sides_.size() > 0) f += on_both_sides_;
}

double Bonds::squared_norm() const {
  double sum = 0;
  for (const auto& contact : now_)
    for (const Adhesive& now : contact) sum += now.force.squaredNorm();
  return sum;
}

double Bonds::stored() const {
  double sum = 0;
  for (const auto& contact : now_)
    for (const Adhesive& now : contact) sum += now.stored;
  return sum;
}

double Bonds::dissipated() const {
  double sum = 0;
  for (const auto& contact : now_)
    for (const Adhesive& now : contact) sum += now.dissipated;
  return sum;
}

double Bonds::dissipated_since(const BondStates& from) const {
  double sum = 0;
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      if (from[k][i].made) sum += law(k).work * area(k, i) * (from[k][i].beta - now_[k][i].beta);
  return sum;
}

double Bonds::loosened() const {
  double most = 0;
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      if (start_[k][i].made) most = std::max(most, std::abs(start_[k][i].beta - now_[k][i].beta));
  return most;
}

double Bonds::time_error() const {
  double sum = 0;
  double touched = 0;
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i) {
      if (!start_[k][i].made || law(k).viscosity == 0) continue;
      sum += now_[k][i].error;
      touched += area(k, i);
    }
  if (touched == 0) return 0;
  return sum / touched;
}

bool Bonds::made_anew(std::size_t contact, std::size_t candidate,
                      const std::vector<std::vector<Vec3>>& r,
                      const std::vector<std::vector<Vec3>>& r_0) const {
  const bool touches = !r[contact][candidate].isZero(0);
  const bool came = r_0[contact][candidate].isZero(0);
  if (!touches) return false;
  if (!start_[contact][candidate].made) return true;
  return came && law(contact).healing;
}

AdhesiveChange Bonds::change(std::size_t contact, std::size_t candidate, const std::vector<Vec3>& X,
                             const VecX& u, const Vec3& c, const BondChange& by) const {
  const RigidContact& of = contacts_[contact];
  const int node = of.nodes[candidate];
  const Vec3 v = u.segment<3>(3 * node) - c;
  BondChange all = by;
  if (seconds_ > 0) all.viscous += by.law.viscosity / seconds_;
  AdhesiveChange out = adhesive_change(*of.adhesion, shape_at(of.shape, X[node] + v), v,
                                       start_[contact][candidate], viscous(contact), all);
  out.force *= of.area[candidate];
  return out;
}

BondStates Bonds::after(const std::vector<std::vector<Vec3>>& r,
                        const std::vector<std::vector<Vec3>>& r_0, const VecX& u,
                        const std::vector<Vec3>& c) const {
  BondStates next = start_;
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i) {
      Bond& bond = next[k][i];
      const bool of_surface = k >= contacts_.size();
      if (bond.made) bond.beta = now_[k][i].beta;
      if (bond.made && of_surface) bond.at = -openings_[k - contacts_.size()][i];
      if (!made_anew(k, i, r, r_0)) continue;
      bond = {1, Vec3::Zero(), true};
      if (!of_surface) bond.at = u.segment<3>(3 * contacts_[k].nodes[i]) - c[k];
    }
  return next;
}

}  // namespace langer

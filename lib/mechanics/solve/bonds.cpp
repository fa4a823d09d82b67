#include "mechanics/solve/bonds.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

Bonds::Bonds(const std::vector<RigidContact>& contacts)
    : contacts_(contacts),
      any_(std::any_of(contacts.begin(), contacts.end(),
                       [](const RigidContact& c) { return c.adhesion.has_value(); })) {
  if (!any_) return;
  for (const RigidContact& contact : contacts)
    now_.emplace_back(contact.adhesion ? contact.nodes.size() : 0);
}

BondStates Bonds::at_rest(const std::vector<Vec3>& X) const {
  constexpr double touch = 1e-9;  // [mm]
  BondStates states;
  for (std::size_t k = 0; k < now_.size(); ++k) {
    states.emplace_back(now_[k].size());
    for (std::size_t i = 0; i < now_[k].size(); ++i) {
      const RigidContact& contact = contacts_[k];
      if (shape_at(contact.shape, X[contact.nodes[i]] - indenter_displacement(contact, 0)).gap <=
          touch)
        states[k][i] = {1, -indenter_displacement(contact, 0), true};
    }
  }
  return states;
}

void Bonds::begin(const BondStates& start, double seconds) {
  start_ = start;
  seconds_ = seconds;
  damping_ = 0;
}

double Bonds::viscous(std::size_t contact) const {
  const double viscosity = contacts_[contact].adhesion->viscosity;
  double rate = 0;
  if (viscosity > 0 && seconds_ > 0) rate = viscosity / seconds_;
  return rate + damping_;
}

void Bonds::evaluate(const std::vector<Vec3>& X, const VecX& u, const std::vector<Vec3>& c) {
  for (std::size_t k = 0; k < now_.size(); ++k) {
    const RigidContact& contact = contacts_[k];
    for (std::size_t i = 0; i < now_[k].size(); ++i) {
      now_[k][i] = {};
      if (!start_[k][i].made) continue;
      const int node = contact.nodes[i];
      const Vec3 v = u.segment<3>(3 * node) - c[k];
      Adhesive& now = now_[k][i] = adhesive(*contact.adhesion, shape_at(contact.shape, X[node] + v),
                                            v, start_[k][i], viscous(k));
      const double area = contact.area[i];
      now.force *= area;
      now.tangent *= area;
      now.stored *= area;
      now.dissipated *= area;
    }
  }
}

void Bonds::go_on() {
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      if (start_[k][i].made) start_[k][i].beta = now_[k][i].beta;
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
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      f.segment<3>(3 * contacts_[k].nodes[i]) += now_[k][i].force;
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
      if (from[k][i].made)
        sum += contacts_[k].adhesion->work * contacts_[k].area[i] *
               (from[k][i].beta - now_[k][i].beta);
  return sum;
}

double Bonds::loosened() const {
  double most = 0;
  for (std::size_t k = 0; k < now_.size(); ++k)
    for (std::size_t i = 0; i < now_[k].size(); ++i)
      if (start_[k][i].made) most = std::max(most, std::abs(start_[k][i].beta - now_[k][i].beta));
  return most;
}

bool Bonds::made_anew(std::size_t contact, std::size_t candidate,
                      const std::vector<std::vector<Vec3>>& r,
                      const std::vector<std::vector<Vec3>>& r_0) const {
  const bool touches = !r[contact][candidate].isZero(0);
  const bool came = r_0[contact][candidate].isZero(0);
  if (!touches) return false;
  if (!start_[contact][candidate].made) return true;
  return came && contacts_[contact].adhesion->healing;
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
      if (bond.made) bond.beta = now_[k][i].beta;
      if (made_anew(k, i, r, r_0)) bond = {1, u.segment<3>(3 * contacts_[k].nodes[i]) - c[k], true};
    }
  return next;
}

}  // namespace langer

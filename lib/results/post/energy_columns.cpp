#include "results/post/energy_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "mechanics/contact/touch.hpp"

namespace langer {

namespace {

bool is_zero(const Vec3& v) { return v.isZero(0); }

// The movement of a force-controlled indenter that does work. In the increment in which it reaches
// the body, the movement before the first touch does none.
Vec3 movement_in_contact(const RigidContact& contact, const Mesh& mesh,
                         const EnergyPath::State& from, std::size_t k, const Vec3& c,
                         const Vec3& dc) {
  const bool in_contact = !std::ranges::all_of(from.r[k], is_zero);
  if (!contact.control || in_contact) return dc;
  const RigidContact pushed{
      contact.name, contact.shape, 0, contact.nodes, {}, ForceControl{contact.control->along, {}}};
  const auto position = [&](int node) {
    return Vec3(mesh.X[node] + from.u[node] - c);
  };
  const double free = std::max(0.0, travel_to_touch(pushed, 0, 0, position).value_or(0));
  const double way = dc.dot(contact.control->along);
  if (free < way) return Vec3(dc - free * contact.control->along);
  return dc;
}

// The part of a sum over nodes that a whole ring has: in a body of revolution radial forces
// cancel.
Vec3 sum_over_ring(const Mesh& mesh, const Vec3& sum) {
  if (mesh.section && mesh.section->of == SectionOf::axisymmetric) {
    return Vec3(0, sum[1], 0);
  }
  return sum;
}

double pull_along(const Vec3& normal, const Vec3& force) {
  if (normal.isZero(0)) return 0;
  return std::max(0.0, -force.dot(normal.normalized()));
}

}  // namespace

double pull_force(const RigidContact& contact, const Mesh& mesh, std::span<const Vec3> u,
                  std::span<const Vec3> r, std::span<const Vec3> bonds, const Vec3& c) {
  Vec3 force = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    if (r[i].isZero(0) && bonds[i].isZero(0)) continue;
    const int node = contact.nodes[i];
    const Vec3 n = shape_at(contact.shape, mesh.X[node] + u[node] - c).normal;
    force += r[i] + bonds[i];
    normal += (r[i].norm() + bonds[i].norm()) * n;
  }
  normal = sum_over_ring(mesh, normal);
  return pull_along(normal, force);
}

double pull_force(const std::vector<MortarNode>& nodes, std::span<const Vec3> r,
                  std::span<const Vec3> bonds) {
  Vec3 force = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  for (const MortarNode& node : nodes) {
    const auto i = static_cast<std::size_t>(node.candidate);
    force += r[i] + bonds[i];
    normal += (r[i].norm() + bonds[i].norm()) * node.normal;
  }
  return pull_along(normal, force);
}

VecX positions(const Mesh& mesh, const std::vector<Vec3>& u) {
  VecX x(3 * static_cast<Eigen::Index>(u.size()));
  for (std::size_t i = 0; i < u.size(); ++i)
    x.segment<3>(3 * static_cast<Eigen::Index>(i)) = mesh.X[i] + u[i];
  return x;
}

EnergyPath::EnergyPath(const Mesh& mesh, std::vector<RigidContact> contacts,
                       std::vector<double> kinks, std::vector<TurnedSet> turned,
                       std::vector<SurfaceContact> surfaces)
    : mesh_(mesh),
      contacts_(std::move(contacts)),
      kinks_(std::move(kinks)),
      turned_(std::move(turned)),
      surfaces_(std::move(surfaces)) {
  for (const RigidContact& contact : contacts_) slips_.emplace_back(contact.nodes.size(), 0.0);
  for (const SurfaceContact& surface : surfaces_) slips_.emplace_back(surface.nodes.size(), 0.0);
}

namespace {

// What friction takes at a node while it slips, from -r . slip with the reactions r of both ends of
// the step. Friction opposes slip, so a negative one is that of a node that stuck first: there the
// reaction turned round before the node slipped, and only the other one acts.
double taken_by_friction(double begin, double end) {
  if (begin < 0) begin = end;
  if (end < 0) end = begin;
  return std::max(0.5 * (begin + end), 0.0);
}

// Adds the forces of reactions on both sides of a surface.
void add_nodal(const std::vector<MortarNode>& nodes, const VecX& x, const std::vector<Vec3>& r,
               std::vector<Vec3>& to) {
  VecX f = VecX::Zero(x.size());
  add_mortar_forces(nodes, x, r, f);
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] += f.segment<3>(3 * static_cast<Eigen::Index>(i));
}

}  // namespace

// Reactions at both ends of the interval act on the mean slip in it, as those of indenters do.
void EnergyPath::add_surfaces(const State& now, Interval& step, Ends& from_contact) {
  const VecX x0 = positions(mesh_, last_.u);
  const VecX x = positions(mesh_, now.u);
  const VecX moved = x - x0;
  std::vector<std::vector<MortarNode>> nodes;
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const std::size_t k = contacts_.size() + s;
    nodes.push_back(mortar_nodes(surfaces_[s], x));
    add_nodal(last_nodes_[s], x0, last_.r[k], from_contact.begin);
    add_nodal(nodes[s], x, now.r[k], from_contact.end);
    if (k < last_.bonds.size() && !last_.bonds[k].empty())
      add_nodal(last_nodes_[s], x0, last_.bonds[k], from_contact.begin);
    if (k < now.bonds.size() && !now.bonds[k].empty()) {
      add_nodal(nodes[s], x, now.bonds[k], from_contact.end);
      step.pull = std::max(step.pull, pull_force(nodes[s], now.r[k], now.bonds[k]));
    }
    // -r . slip of each candidate, at the beginning and at the end
    std::vector<std::array<double, 2>> work_of_slip(now.r[k].size(), {0, 0});
    for (const MortarNode& node : last_nodes_[s]) {
      const auto i = static_cast<std::size_t>(node.candidate);
      work_of_slip[i][0] = -last_.r[k][i].dot(node.slip(moved));
    }
    for (const MortarNode& node : nodes[s]) {
      const auto i = static_cast<std::size_t>(node.candidate);
      work_of_slip[i][1] = -now.r[k][i].dot(node.slip(moved));
      const bool touched = !last_.r[k][i].isZero(0) && !now.r[k][i].isZero(0);
      if (touched) slips_[k][i] += node.slip(moved).norm();
    }
    for (const auto& [begin, end] : work_of_slip) step.dissipated += taken_by_friction(begin, end);
  }
  last_nodes_ = std::move(nodes);
}

// Adds the work and the dissipation of contact k in the increment to `step`, and its nodal forces
// at both ends to `from_contact`.
void EnergyPath::add_contact(std::size_t k, const State& now, Interval& step, Ends& from_contact,
                             std::vector<Vec3>& rates) {
  const RigidContact& contact = contacts_[k];
  // The movement of the indenter in the increment.
  const Vec3 c0 = indenter_displacement(contact, last_.t);
  const Vec3 c = indenter_displacement(contact, now.t);
  const Vec3 dc = c - c0;
  rates.push_back(dc / step.dt);
  if (k == 0) {
    Vec3 force = Vec3::Zero();
    for (const Vec3& r : now.r[0]) force += r;
    step.way = dc.norm();
    step.travel = c.norm();
    step.force = sum_over_ring(mesh_, force).norm();
  }
  if (!now.bonds.empty() && !now.bonds[k].empty())
    step.pull = std::max(step.pull, pull_force(contact, mesh_, now.u, now.r[k], now.bonds[k], c));
  double angle = 0;
  if (contact.rotation) {
    angle = contact.rotation->angle.at(now.t) - contact.rotation->angle.at(last_.t);
    rates.push_back(angle / step.dt * contact.rotation->axis.along);
    const auto last_position = [&](int node) {
      return Vec3(mesh_.X[node] + last_.u[node]);
    };
    const auto position = [&](int node) {
      return Vec3(mesh_.X[node] + now.u[node]);
    };
    step.begin += angle * torque(contact, last_position, c0, last_.r[k]);
    step.end += angle * torque(contact, position, c, now.r[k]);
  }
  const Vec3 worked = movement_in_contact(contact, mesh_, last_, k, c0, dc);
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    const int node = contact.nodes[i];
    const Vec3& r0 = last_.r[k][i];
    const Vec3& r1 = now.r[k][i];
    from_contact.begin[node] += r0;
    from_contact.end[node] += r1;
    step.begin += r0.dot(worked);
    step.end += r1.dot(worked);
    // Bonds are forces on the body like the reactions.
    for (const auto& [state, from, power] :
         {std::tuple{&std::as_const(last_), &from_contact.begin, &step.begin},
          {&now, &from_contact.end, &step.end}})
      if (k < state->bonds.size() && !state->bonds[k].empty()) {
        (*from)[node] += state->bonds[k][i];
        *power += state->bonds[k][i].dot(worked);
      }
    // The relative movement of the node. Its part in the tangent plane of the state whose reaction
    // it meets is the slip. With respect to an indenter that turns, a node at rest slips along an
    // arc about the axis: v is the chord seen from the end, turned back by half of the angle and
    // lengthened to the arc.
    const Vec3 x0 = mesh_.X[node] + last_.u[node];
    Vec3 v = now.u[node] - last_.u[node] - dc;
    if (angle != 0) {
      v -= carried(contact, angle, x0, c0);
      v = 0.5 * angle / std::sin(0.5 * angle) *
          (v + turned_by(contact.rotation->axis.along, -0.5 * angle, v));
    }
    const auto work_of_slip = [&](const Vec3& r, const Vec3& x) {
      if (r.isZero(0)) return 0.0;
      const Vec3 n = shape_at(contact.shape, x).normal;
      return -r.dot(v - v.dot(n) * n);
    };
    step.dissipated += taken_by_friction(work_of_slip(r0, x0 - c0),
                                         work_of_slip(r1, mesh_.X[node] + now.u[node] - c));
    // Slip counts only with contact at both ends.
    if (r0.isZero(0) || r1.isZero(0)) continue;
    const Vec3 n = shape_at(contact.shape, Vec3(mesh_.X[node] + now.u[node] - c)).normal;
    slips_[k][i] += (v - v.dot(n) * n).norm();
  }
}

// The movement of nodes with imposed displacements. Nodes of a set that turns move along arcs, so
// the rates at the two ends differ.
EnergyPath::Ends EnergyPath::imposed(const State& now) const {
  Ends du;
  for (std::size_t i = 0; i < now.u.size(); ++i) du.begin.push_back(now.u[i] - last_.u[i]);
  du.end = du.begin;
  for (const TurnedSet& set : turned_) {
    const Vec3 p0 = set.axis_at(last_.t);
    const Vec3 p = set.axis_at(now.t);
    const Vec3 turn = (set.angle.at(now.t) - set.angle.at(last_.t)) * set.axis.along;
    for (int node : set.nodes) {
      du.begin[node] = p - p0 + cross(turn, mesh_.X[node] + last_.u[node] - p0);
      du.end[node] = p - p0 + cross(turn, mesh_.X[node] + now.u[node] - p);
    }
  }
  return du;
}

// Adds the increment from the last state to this one: the power of indenters, loads and supports
// at its two ends, and whether the path continues without a kink.
void EnergyPath::add(State now) {
  stored_.push_back(now.stored);
  if (stored_.size() == 1) {
    const VecX x = surfaces_.empty() ? VecX() : positions(mesh_, now.u);
    for (const SurfaceContact& surface : surfaces_) last_nodes_.push_back(mortar_nodes(surface, x));
    last_ = std::move(now);
    return;
  }
  Interval step{now.t - last_.t, 0, 0, intervals_.size() > 0, 0, 0, 0, 0};
  const std::vector<Vec3> none(now.u.size(), Vec3::Zero());
  Ends from_contact{none, none};
  std::vector<Vec3> rates;
  for (std::size_t k = 0; k < contacts_.size(); ++k) add_contact(k, now, step, from_contact, rates);
  if (!surfaces_.empty()) add_surfaces(now, step, from_contact);
  // The rest of the reactions belongs to supports, which do not move, and to imposed displacements.
  const Ends du = imposed(now);
  for (std::size_t i = 0; i < now.u.size(); ++i) {
    if (now.loads.size() > 0) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const Vec3 moved = now.u[i] - last_.u[i];
      step.begin += last_.loads.segment<3>(row).dot(moved);
      step.end += now.loads.segment<3>(row).dot(moved);
    }
    step.begin += (last_.reaction[i] - from_contact.begin[i]).dot(du.begin[i]);
    step.end += (now.reaction[i] - from_contact.end[i]).dot(du.end[i]);
  }
  step.begin /= step.dt;
  step.end /= step.dt;
  for (std::size_t k = 0; k < rates.size() && step.continues; ++k)
    step.continues =
        (rates[k] - rates_[k]).norm() <= 1e-6 * std::max(rates[k].norm(), rates_[k].norm());
  for (double t : kinks_) step.continues = step.continues && std::abs(t - last_.t) > 1e-9;
  // The work of a jump is known. Its friction is part of the energy that it releases.
  const double jump = now.jumps - last_.jumps;
  if (jump != 0 || jumped_) step.continues = false;
  jumped_ = jump != 0;
  if (jumped_) {
    step.begin = jump / step.dt;
    step.end = step.begin;
    step.dissipated = 0;
  }
  intervals_.push_back(step);
  rates_ = std::move(rates);
  last_ = std::move(now);
}

// Integrates the powers over the intervals. A parabola through three states differs from the
// trapezoid by dt^3/6 times its curvature, the second divided difference of the power. If there
// is a parabola on both sides of an interval, their mean is used.
std::vector<PathSums> EnergyPath::sums() const {
  std::vector<PathSums> all(stored_.size());
  double largest = 0, most_force = 0, work_at_begin = 0;
  bool came_back = false;
  for (std::size_t k = 0; k < intervals_.size(); ++k) {
    const Interval& here = intervals_[k];
    double advance = here.travel;
    if (k > 0) advance = here.travel - intervals_[k - 1].travel;
    if (advance > 0 && came_back) work_at_begin = all[k].work;
    if (advance != 0) came_back = advance < 0;
    const double slope = (here.end - here.begin) / here.dt;
    double curvature = 0;
    int neighbours = 0;
    if (here.continues) {
      const Interval& before = intervals_[k - 1];
      curvature += (slope - (here.begin - before.begin) / before.dt) / (here.dt + before.dt);
      ++neighbours;
    }
    if (k + 1 < intervals_.size() && intervals_[k + 1].continues) {
      const Interval& after = intervals_[k + 1];
      curvature += ((after.end - here.end) / after.dt - slope) / (here.dt + after.dt);
      ++neighbours;
    }
    if (neighbours > 0) curvature /= neighbours;
    // The sums of the state at the end of the interval.
    PathSums& sum = all[k + 1];
    sum.path = all[k].path + here.way;
    sum.work = all[k].work + 0.5 * here.dt * (here.begin + here.end) -
               std::pow(here.dt, 3) / 6 * curvature;
    sum.dissipated = all[k].dissipated + here.dissipated;
    sum.hysteresis = sum.work - work_at_begin;
    most_force = std::max(most_force, here.force);
    sum.pull_off = std::max(all[k].pull_off, here.pull);
    if (most_force > 0) sum.relaxation = here.force / most_force;
    largest = std::max(largest, std::abs(sum.work));
    if (largest > 0) sum.balance = (sum.work - stored_[k + 1] - sum.dissipated) / largest;
  }
  return all;
}

}  // namespace langer

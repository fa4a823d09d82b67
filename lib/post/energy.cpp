#include "post/energy.hpp"

#include <algorithm>
#include <cmath>

#include "contact/touch.hpp"

namespace langer {

namespace {

// Of an increment in which a pushed indenter comes to the body, the movement behind the touch: before it there is no force.
Vec3 behind_touch(const RigidContact& contact, const Mesh& mesh, const EnergyPath::State& from, std::size_t k, const Vec3& c,
                  const Vec3& dc) {
  const std::vector<Vec3>& r = from.r[k];
  if (!contact.control || std::any_of(r.begin(), r.end(), [](const Vec3& r_i) { return !r_i.isZero(0); })) return dc;
  const RigidContact pushed{contact.name, contact.shape, 0, contact.nodes, {}, ForceControl{contact.control->along, {}}};
  const auto position = [&](int node) { return Vec3(mesh.X[node] + from.u[node] - c); };
  const double free = std::max(0.0, travel_to_touch(pushed, 0, 0, position).value_or(0)), way = dc.dot(contact.control->along);
  return free < way ? Vec3(dc - free * contact.control->along) : dc;
}

}  // namespace

EnergyPath::EnergyPath(const Mesh& mesh, std::vector<RigidContact> contacts, std::vector<double> kinks)
    : mesh_(mesh), contacts_(std::move(contacts)), kinks_(std::move(kinks)) {}

void EnergyPath::add(State now) {
  stored_.push_back(now.stored);
  if (stored_.size() == 1) {
    last_ = std::move(now);
    return;
  }
  Interval step{now.t - last_.t, 0, 0, intervals_.size() > 0, 0, 0, 0, 0};
  std::vector<Vec3> from_contact_0(now.u.size(), Vec3::Zero()), from_contact_1 = from_contact_0, rates;
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const RigidContact& contact = contacts_[k];
    const Vec3 c0 = indenter_displacement(contact, last_.t), c = indenter_displacement(contact, now.t), dc = c - c0;
    rates.push_back(dc / step.dt);
    if (k == 0) {
      Vec3 force = Vec3::Zero();
      for (const Vec3& r : now.r[0]) force += r;
      step.way = dc.norm(), step.travel = c.norm(), step.force = force.norm();
    }
    const Vec3 worked = behind_touch(contact, mesh_, last_, k, c0, dc);
    for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
      const int node = contact.nodes[i];
      const Vec3 &r0 = last_.r[k][i], &r1 = now.r[k][i];
      from_contact_0[node] += r0, from_contact_1[node] += r1;
      step.begin += r0.dot(worked), step.end += r1.dot(worked);
      // the slip lies in the tangent plane of the state whose reaction it meets; the part along the normal is no slip
      const Vec3 v = now.u[node] - last_.u[node] - dc;
      for (const auto& [r, x] :
           {std::pair{r0, Vec3(mesh_.X[node] + last_.u[node] - c0)}, std::pair{r1, Vec3(mesh_.X[node] + now.u[node] - c)}}) {
        if (r.isZero(0)) continue;
        const Vec3 n = shape_at(contact.shape, x).normal;
        step.dissipated -= 0.5 * r.dot(v - v.dot(n) * n);
      }
    }
  }
  for (std::size_t i = 0; i < now.u.size(); ++i) {  // imposed displacements; supports do not move
    const Vec3 du = now.u[i] - last_.u[i];
    if (now.loads.size() > 0)
      step.begin += last_.loads.segment<3>(3 * static_cast<Eigen::Index>(i)).dot(du),
          step.end += now.loads.segment<3>(3 * static_cast<Eigen::Index>(i)).dot(du);
    step.begin += (last_.reaction[i] - from_contact_0[i]).dot(du);
    step.end += (now.reaction[i] - from_contact_1[i]).dot(du);
  }
  step.begin /= step.dt, step.end /= step.dt;
  for (std::size_t k = 0; k < rates.size() && step.goes_on; ++k)
    step.goes_on = (rates[k] - rates_[k]).norm() <= 1e-6 * std::max(rates[k].norm(), rates_[k].norm());
  for (double t : kinks_) step.goes_on = step.goes_on && std::abs(t - last_.t) > 1e-9;
  intervals_.push_back(step);
  rates_ = std::move(rates);
  last_ = std::move(now);
}

std::vector<PathSums> EnergyPath::sums() const {
  std::vector<PathSums> all(stored_.size());
  double largest = 0, most_force = 0, work_at_begin = 0;
  bool came_back = false;
  for (std::size_t k = 0; k < intervals_.size(); ++k) {
    const Interval& here = intervals_[k];
    const double goes = here.travel - (k > 0 ? intervals_[k - 1].travel : 0);
    if (goes > 0 && came_back) work_at_begin = all[k].work;
    if (goes != 0) came_back = goes < 0;
    const double slope = (here.end - here.begin) / here.dt;
    // second divided differences with the states before and after
    double curvature = 0;
    int neighbours = 0;
    if (here.goes_on) {
      const Interval& before = intervals_[k - 1];
      curvature += (slope - (here.begin - before.begin) / before.dt) / (here.dt + before.dt), ++neighbours;
    }
    if (k + 1 < intervals_.size() && intervals_[k + 1].goes_on) {
      const Interval& after = intervals_[k + 1];
      curvature += ((after.end - here.end) / after.dt - slope) / (here.dt + after.dt), ++neighbours;
    }
    if (neighbours > 0) curvature /= neighbours;
    PathSums& sum = all[k + 1];
    sum.path = all[k].path + here.way;
    sum.work = all[k].work + 0.5 * here.dt * (here.begin + here.end) - std::pow(here.dt, 3) / 6 * curvature;
    sum.dissipated = all[k].dissipated + here.dissipated;
    sum.hysteresis = sum.work - work_at_begin;
    most_force = std::max(most_force, here.force);
    if (most_force > 0) sum.relaxation = here.force / most_force;
    largest = std::max(largest, std::abs(sum.work));
    if (largest > 0) sum.balance = (sum.work - stored_[k + 1] - sum.dissipated) / largest;
  }
  return all;
}

}  // namespace langer

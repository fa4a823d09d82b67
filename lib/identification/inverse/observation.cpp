#include "identification/inverse/observation.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "identification/inverse/sensitivity.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/select.hpp"
#include "scene/run/step_record.hpp"

namespace langer {

namespace {

// Weights of the corners of a bilinear quadrilateral at a place, by Gauss-Newton iterations for its
// coordinates (a, b). in_plan: seen from above, heights do not count. Nothing if the place is
// outside.
std::optional<std::array<double, 4>> weights_in(const std::array<Vec3, 4>& corner,
                                                const Vec3& place, bool in_plan, double tolerance) {
  double a = 0, b = 0;
  Vec3 miss = Vec3::Zero();
  const auto shapes = [&] {
    return std::array{0.25 * (1 - a) * (1 - b), 0.25 * (1 + a) * (1 - b), 0.25 * (1 + a) * (1 + b),
                      0.25 * (1 - a) * (1 + b)};
  };
  for (int i = 0; i < 20; ++i) {
    const auto N = shapes();
    Vec3 x = Vec3::Zero();
    Vec3 along_a = Vec3::Zero();
    Vec3 along_b = Vec3::Zero();
    const std::array<double, 4> Na{-0.25 * (1 - b), 0.25 * (1 - b), 0.25 * (1 + b),
                                   -0.25 * (1 + b)};
    const std::array<double, 4> Nb{-0.25 * (1 - a), -0.25 * (1 + a), 0.25 * (1 + a),
                                   0.25 * (1 - a)};
    for (std::size_t k = 0; k < 4; ++k) {
      x += N[k] * corner[k];
      along_a += Na[k] * corner[k];
      along_b += Nb[k] * corner[k];
    }
    miss = place - x;
    if (in_plan) miss[1] = along_a[1] = along_b[1] = 0;
    Eigen::Matrix<double, 3, 2> A;
    A << along_a, along_b;
    const Eigen::Matrix2d normal = A.transpose() * A;
    if (!(normal.determinant() > 1e-14 * normal.squaredNorm())) return std::nullopt;
    const Eigen::Vector2d d = normal.inverse() * (A.transpose() * miss);
    a = std::clamp(a + d[0], -1.5, 1.5);
    b = std::clamp(b + d[1], -1.5, 1.5);
    if (d.norm() < 1e-12) break;
  }
  constexpr double edge = 1 + 1e-6;
  if (!(std::abs(a) <= edge && std::abs(b) <= edge) || miss.norm() > tolerance) return std::nullopt;
  return shapes();
}

// The displacement of the named indenter, or of the first one.
Vec3 way_of(const std::string& contact, const StepRecord& whole,
            const std::vector<RigidContact>& contacts) {
  for (const RigidContact& one : contacts)
    if (one.name == contact) return indenter_at(one, whole);
  return whole.u_ind;
}

}  // namespace

double Observation::value(const StepRecord& whole,
                          const std::vector<RigidContact>& contacts) const {
  if (of == Of::travel) return whole.scalars.at("travel_" + contact);
  if (of != Of::force) return sum(whole);
  // The force against the motion of the indenter; its size if the indenter does not move.
  Vec3 force = whole.force_ind;
  if (!contact.empty()) force = force_on(whole, contact);
  const Vec3 way = way_of(contact, whole, contacts);
  if (way.norm() > 0) return -force.dot(way.normalized());
  return force.norm();
}

double Observation::slope(const StepRecord& whole, const StepRecord& derivative,
                          const std::vector<RigidContact>& contacts) const {
  if (of == Of::travel) return derivative.scalars.at("travel_" + contact);
  if (of != Of::force) return sum(derivative);
  if (contact.empty()) return force_derivative(whole, derivative);
  return derivative_against(way_of(contact, whole, contacts), force_on(whole, contact),
                            force_on(derivative, contact));
}

// Weighted sum of a component over the nodes of the observation.
double Observation::sum(const StepRecord& whole) const {
  double sum = 0;
  const std::vector<Vec3>& field = of == Of::reaction ? whole.reaction : whole.u;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    sum += weights[k] * field[static_cast<std::size_t>(nodes[k])][axis];
  return sum;
}

// Finds the facet that contains a place of the surface, and the weights of its nodes there.
bool find_place(const Mesh& mesh, const Vec3& place, Observation& found) {
  const bool in_plan = std::isnan(place[1]);
  const double tolerance = 1e-6 * size(mesh);
  std::vector<Facet> facets;
  Vec3 seen = place;
  if (in_plan) {
    facets = mesh.facet_sets.at("top");
    seen[1] = 0;
  } else {
    facets = boundary(mesh);
  }
  for (const Facet& facet : facets)
    for (const auto& quad : facet_quads(mesh, facet)) {
      std::array<Vec3, 4> corner;
      for (std::size_t k = 0; k < 4; ++k) corner[k] = mesh.X[static_cast<std::size_t>(quad[k])];
      const auto N = weights_in(corner, seen, in_plan, tolerance);
      if (!N) continue;
      found.nodes.assign(quad.begin(), quad.end());
      found.weights.assign(N->begin(), N->end());
      return true;
    }
  return false;
}

}  // namespace langer

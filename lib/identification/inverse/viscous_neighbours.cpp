#include "identification/inverse/viscous_neighbours.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

// Half the width of the difference by a number. Forces are linear in a modulus, but not in the past
// that it brings about, so that its step is short, too.
double half_width(const SceneParameters& parameters, std::size_t i) {
  constexpr double share = 1e-4;
  if (!parameters.of_laws(i)) return share * std::max(std::abs(parameters.list()[i].value), 0.1);
  if (parameters.linear(i)) return share * parameters.step(i);
  return parameters.step(i);
}

// Internal forces and energy, with the pressures that belong to these displacements.
Assembler::Forces forces_at(Assembler& body, const VecX& u) {
  body.assemble(u, false);
  body.pressures_from(u);
  body.assemble(u, false);
  return {body.f_int(), body.W()};
}

}  // namespace

ViscousNeighbours::ViscousNeighbours(const Reduction& reduction,
                                     const SceneParameters& parameters) {
  const Scene& scene = reduction.scene();
  const Mesh& mesh = reduction.mesh();
  const auto varied = [&](std::size_t i, double by) {
    SceneParameters::Laws laws{scene.materials, scene.directions};
    if (parameters.of_laws(i)) laws = parameters.varied(scene, mesh, i, by);
    return reduction.assembler_on(mesh, std::move(laws.materials), std::move(laws.directions));
  };
  for (std::size_t i = 0; i < parameters.list().size(); ++i) {
    const double h = half_width(parameters, i);
    pairs_.push_back({varied(i, -h), varied(i, h), h});
  }
}

void ViscousNeighbours::begin(double seconds) {
  for (Pair& pair : pairs_) {
    pair.less->begin_increment(seconds);
    pair.more->begin_increment(seconds);
  }
}

Assembler::Forces ViscousNeighbours::change(std::size_t i, const VecX& u) {
  Pair& pair = pairs_[i];
  const Assembler::Forces less = forces_at(*pair.less, u);
  const Assembler::Forces more = forces_at(*pair.more, u);
  return {(more.f - less.f) / (2 * pair.h), (more.W - less.W) / (2 * pair.h)};
}

double ViscousNeighbours::accept(std::size_t i, const VecX& u0, const VecX& d0, const VecX& u,
                                 const VecX& d) {
  Pair& pair = pairs_[i];
  const auto follow = [&](Assembler& body, double by) {
    const VecX begin = u0 + by * d0;
    const VecX end = u + by * d;
    const double energy = forces_at(body, end).W;
    body.end_increment(end);
    body.accept_increment(begin, end);
    return energy;
  };
  const double less = follow(*pair.less, -pair.h);
  const double more = follow(*pair.more, pair.h);
  return (more - less) / (2 * pair.h);
}

}  // namespace langer

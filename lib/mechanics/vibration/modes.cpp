#include "mechanics/vibration/modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/vibration/frozen_body.hpp"

namespace langer {

double Mode::frequency() const {
  return std::sqrt(std::max(0.0, eigenvalue)) / (2 * std::numbers::pi);
}

double Mode::growth() const { return std::sqrt(std::max(0.0, -eigenvalue)); }

namespace {

VecX with_largest_movement_1(VecX u) {
  double largest = 0;
  for (Eigen::Index i = 0; i + 2 < u.size(); i += 3)
    largest = std::max(largest, u.segment<3>(i).norm());
  if (largest > 0) u /= largest;
  // the first component of some size is positive, whatever the eigenvector's sign
  for (double x : u) {
    if (std::abs(x) < 0.5) continue;
    if (x < 0) u = -u;
    break;
  }
  return u;
}

}  // namespace

Modes modes_of(Assembler& body, const Increment& increment, const std::vector<double>& density,
               const std::vector<Dofs>& breaking, int count, int threads) {
  body.begin_small_movements([](const ViscousBranch&) { return 0.0; });
  Modes out;
  out.counted = true;
  for (std::size_t kind = 0; kind <= breaking.size(); ++kind) {
    const bool symmetric = kind == 0;
    FrozenBody frozen(body, increment, density, symmetric ? body.dofs() : breaking[kind - 1],
                      symmetric);
    if (frozen.size() == 0) continue;
    const Eigenpairs found = lowest_eigenpairs(frozen.stiffness(), frozen.mass(), count, threads);
    out.counted = out.counted && found.counted;
    for (Eigen::Index i = 0; i < found.values.size(); ++i) {
      VecX u = with_largest_movement_1(frozen.displacements(found.vectors.col(i)));
      out.modes.push_back({found.values[i], static_cast<int>(kind), std::move(u)});
    }
  }
  std::ranges::stable_sort(out.modes, {}, &Mode::eigenvalue);
  if (out.modes.size() > static_cast<std::size_t>(count))
    out.modes.resize(static_cast<std::size_t>(count));
  return out;
}

std::vector<double> rayleigh_quotients(Assembler& body, const Increment& increment,
                                       const std::vector<double>& density,
                                       const std::vector<Dofs>& breaking,
                                       const std::vector<Mode>& modes) {
  body.begin_small_movements([](const ViscousBranch&) { return 0.0; });
  std::vector<double> quotients(modes.size());
  for (std::size_t kind = 0; kind <= breaking.size(); ++kind) {
    const auto is_of_kind = [&](const Mode& mode) {
      return mode.kind == static_cast<int>(kind);
    };
    if (std::ranges::none_of(modes, is_of_kind)) continue;
    const bool symmetric = kind == 0;
    FrozenBody frozen(body, increment, density, symmetric ? body.dofs() : breaking[kind - 1],
                      symmetric);
    const SparseX stiffness = frozen.stiffness();
    for (std::size_t i = 0; i < modes.size(); ++i) {
      if (!is_of_kind(modes[i])) continue;
      const VecX q = frozen.coordinates(modes[i].shape);
      quotients[i] = q.dot(stiffness * q) / q.dot(frozen.mass() * q);
    }
  }
  return quotients;
}

}  // namespace langer

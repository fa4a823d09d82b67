#include "mechanics/material/review.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/traps.hpp"
#include "mechanics/material/terms.hpp"

namespace langer {

namespace {

// Stiff fibres change the volume by per cents at moderate stretches below the first ratio of the
// bulk modulus to their stiffness. At the second they do not.
constexpr double few_fibre_stiffnesses = 20;
constexpr double enough_fibre_stiffnesses = 100;

// Of 16 digits a stress keeps those that the ratio K/mu leaves.
constexpr double largest_ratio = 1e10;
constexpr double harmless_ratio = 1e6;

// of the law at once after a step, when no branch has relaxed
double instant_factor(const Material& material) {
  double factor = 1;
  for (const ViscousBranch& branch : branches_of(material)) {
    if (branch.of != BranchOf::fibres) factor += branch.gamma;
  }
  return factor;
}

const char* volume_term(const Volume& volume) {
  return std::visit([](const auto& law) { return std::decay_t<decltype(law)>::key; }, volume);
}

bool has_d(const Volume& volume) { return std::holds_alternative<QuadraticVolume>(volume); }

std::string key_of(const Volume& volume) {
  const char* number = has_d(volume) ? "d" : "bulk_modulus";
  return fmt::format("volume.{}.{}", volume_term(volume), number);
}

// A number that was typed for the other of d and the bulk modulus.
std::string other_meaning(const Volume& volume) {
  const double bulk = bulk_modulus(volume);
  if (has_d(volume)) {
    const double typed = 2 / bulk;
    return fmt::format("d is 2/K: if {:.4g} MPa is the bulk modulus K, write {}", typed,
                       volume_key(volume, typed));
  }
  return fmt::format("if {:.4g} is d = 2/K in 1/MPa, write {}", bulk, volume_key(volume, 2 / bulk));
}

}  // namespace

double poisson_ratio(double bulk_modulus, double shear_modulus) {
  return (3 * bulk_modulus - 2 * shear_modulus) / (2 * (3 * bulk_modulus + shear_modulus));
}

double poisson_ratio(const Material& material) {
  return poisson_ratio(bulk_modulus(material), shear_modulus(material));
}

double fibre_stiffness(const Material& material) {
  const NoTraps parameters_may_be_any;
  double stiffest = 0;
  for (const Fibre& fibre : material.fibres) {
    if (!acts(fibre)) continue;
    const double along = 1 - 3 * fibre.kappa;
    stiffest = std::max(stiffest, 4 * along * along * fibre_energy(fibre, 1.0).ddW);
  }
  return stiffest;
}

std::string volume_key(const Volume& volume, double bulk_modulus) {
  double value = bulk_modulus;
  if (has_d(volume)) value = 2 / bulk_modulus;
  return fmt::format("{}: {:.4g}", key_of(volume), value);
}

std::vector<MaterialFinding> review(const Material& material) {
  const NoTraps parameters_may_be_any;
  std::vector<MaterialFinding> found;
  const double bulk = bulk_modulus(material);
  const double shear = shear_modulus(material);
  // A law that is unstable at rest has findings of its own (at_rest.hpp).
  if (!(shear > 0) || !(bulk > 0)) return found;
  const std::string key = key_of(material.volume);

  const double instant = shear * instant_factor(material);
  if (bulk < 2. / 3 * instant) {
    const bool at_once = !(bulk < 2. / 3 * shear);
    const double modulus = at_once ? instant : shear;
    found.push_back(
        {key,
         fmt::format("Poisson's ratio is {:.3g}{}: the bulk modulus of {:.4g} MPa is less than "
                     "2/3 of the shear modulus of {:.4g} MPa, so that a body grows sideways "
                     "when it is pulled; {}",
                     poisson_ratio(bulk, modulus), at_once ? " at once after a step" : "", bulk,
                     modulus, other_meaning(material.volume))});
    return found;
  }
  if (const double along = fibre_stiffness(material); bulk < few_fibre_stiffnesses * along) {
    const double enough = enough_fibre_stiffnesses * along;
    found.push_back(
        {key,
         fmt::format("the bulk modulus of {:.4g} MPa is only {:.3g} times the stiffness of the "
                     "fibres at rest, {:.4g} MPa: their energy is one of I4_bar, so that they "
                     "change the volume, and under equal tension from all sides they carry "
                     "nothing; {} keeps the volume",
                     bulk, bulk / along, along, volume_key(material.volume, enough))});
  }
  if (bulk > largest_ratio * shear) {
    found.push_back(
        {key,
         fmt::format("the bulk modulus is {:.2g} times the shear modulus: rounding removes most "
                     "digits of the stress; {} is as good as incompressible",
                     bulk / shear, volume_key(material.volume, harmless_ratio * shear))});
  }
  return found;
}

}  // namespace langer

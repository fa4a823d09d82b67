// Inertia as the solve stage's YAML may name it: `dynamics` of the scene and `free` of an indenter.
// Users think in kg/m3, g and mm/s; mechanics computes in t, mm and s.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/percent.hpp"
#include "mechanics/dynamics/inertia.hpp"

namespace langer {

struct RayleighConfig {
  double mass_per_s = 0;
  double stiffness_s = 0;
  static void fields(auto& v) {
    v(&RayleighConfig::mass_per_s, "mass_per_s", "1/s",
      "part in proportion to the mass; damps rigid motions, too", at_least(0));
    v(&RayleighConfig::stiffness_s, "stiffness_s", "s",
      "part in proportion to the stiffness of the body at rest", at_least(0));
  }
};

// What becomes of the mass of nodes that may touch an indenter.
enum class ContactMass { moved_inwards, kept };
constexpr auto names(ContactMass) { return std::array{"moved_inwards", "kept"}; }

struct DynamicsConfig {
  double density_kg_m3 = 0;
  std::map<std::string, double> densities_kg_m3;
  Scheme scheme = Scheme::generalised_alpha;
  std::optional<double> rho_inf;
  double theta = 0.5, xi = 0.5;
  MassKind mass = MassKind::consistent;
  ContactMass contact_mass = ContactMass::moved_inwards;
  std::optional<RayleighConfig> damping;
  std::array<double, 3> gravity{}, velocity{}, spin{};
  std::optional<double> step;
  std::optional<std::string> error;
  static void fields(auto& v) {
    v(&DynamicsConfig::density_kg_m3, "density_kg_m3", "kg/m^3",
      "of the undeformed bodies; skin has about 1100", required, between(10, 30000),
      Hint{"in kg/m3: 1.1 g/cm3 and 1.1e-9 t/mm3 are 1100"});
    v(&DynamicsConfig::densities_kg_m3, "densities_kg_m3", "kg/m^3",
      "of single bodies by name, in the place of density_kg_m3", between(10, 30000),
      Hint{"in kg/m3: 1.1 g/cm3 and 1.1e-9 t/mm3 are 1100"});
    v(&DynamicsConfig::scheme, "scheme", unit::none,
      "generalised_alpha: second order, takes the highest frequencies away by rho_inf; "
      "energy_momentum: keeps energy and angular momentum, without contact; theta: "
      "first order, impulses in the place of accelerations");
    v(&DynamicsConfig::rho_inf, "rho_inf", unit::none,
      "of generalised_alpha: what is left of the highest frequencies after a step; none: 0.8, with "
      "contacts 1, where it loses no energy",
      between(0, 1));
    v(&DynamicsConfig::theta, "theta", unit::none,
      "of theta: weight of the velocity at the end of a step; 0.5 loses no energy",
      between(0.5, 1));
    v(&DynamicsConfig::xi, "xi", unit::none, "of theta: weight of the forces at the end of a step",
      between(0.5, 1));
    v(&DynamicsConfig::mass, "mass", unit::none, "lumped by sums of rows: hex8 only");
    v(&DynamicsConfig::contact_mass, "contact_mass", unit::none,
      "moved_inwards: nodes that may touch an indenter have no mass, and that of the body, its "
      "centre and its moments stay as they are: the contact pressure does not ring; kept: it does");
    v(&DynamicsConfig::damping, "damping", unit::none, "Rayleigh's damping");
    v(&DynamicsConfig::gravity, "gravity", "mm/s^2",
      "acceleration of the body and of an indenter with mass; on earth [0, -9810, 0]");
    v(&DynamicsConfig::velocity, "velocity", "mm/s", "of the body at the beginning");
    v(&DynamicsConfig::spin, "spin", "1/s",
      "angular velocity of the body at the beginning, about the middle of its box");
    v(&DynamicsConfig::step, "step", unit::s, "length of all increments", positive);
    v(&DynamicsConfig::error, "error", unit::none,
      "such as 0.1%: error of displacement that an increment may make, per time, over the speed "
      "that belongs to the energy of the body; increments follow from it. With neither step nor "
      "error: 0.1%");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (step && error) found.push_back({"error", "found together with step", "one of the two", ""});
    if (error && !percent_of(*error))
      found.push_back(
          {"error", "found \"" + *error + "\"", "a percentage above 0, such as 0.1%", ""});
    if (rho_inf && scheme != Scheme::generalised_alpha)
      found.push_back({"rho_inf", "found with another scheme", "scheme: generalised_alpha", ""});
    if ((theta != 0.5 || xi != 0.5) && scheme != Scheme::theta)
      found.push_back(
          {theta != 0.5 ? "theta" : "xi", "found with another scheme", "scheme: theta", ""});
    return found;
  }
};

// An indenter that flies by itself: its travel is an unknown with inertia.
struct FreeConfig {
  double mass_g = 0;
  std::array<double, 3> velocity{};
  std::array<double, 3> along{0, -1, 0};
  static void fields(auto& v) {
    v(&FreeConfig::mass_g, "mass_g", "g", "of the indenter; of a section that of the whole one",
      required, positive);
    v(&FreeConfig::velocity, "velocity", "mm/s", "at the beginning, parallel to `along`", required,
      between(-1e9, 1e9));
    v(&FreeConfig::along, "along", unit::none, "direction in which it may move; any length",
      between(-1e100, 1e100));
  }
  static double length(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }
  double speed() const {  // along its direction [mm/s]
    double dot = 0;
    for (std::size_t k = 0; k < 3; ++k) dot += along[k] / length(along) * velocity[k];
    return dot;
  }
  std::vector<Complaint> complaints() const {
    if (along == std::array<double, 3>{}) return {{"along", "found [0, 0, 0]", "a direction", ""}};
    const double size = length(velocity);
    const double along_it = size > 0 ? speed() / size : 1;
    if (1 - along_it * along_it > 1e-12)
      return {{"velocity", "found a velocity across `along`", "one parallel to it",
               "the indenter is guided along that direction"}};
    return {};
  }
};

}  // namespace langer

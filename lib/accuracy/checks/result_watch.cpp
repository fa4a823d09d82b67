#include "accuracy/checks/result_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/checks/place_text.hpp"
#include "core/tensor/kinematics.hpp"
#include "results/post/nodal_fields.hpp"

namespace langer {

namespace {

constexpr double worth_saying =
    0.02;  // error of the forces by the formulation, which is known to a factor of three
constexpr double known = 0.3;              // from here on only that it is large
constexpr double largest_residual = 1e-3;  // beside the reactions

const ArrudaBoyce* chains_of(const Material& material) {
  for (const MatrixTerm& term : material.matrix)
    if (const auto* chains = std::get_if<ArrudaBoyce>(&term)) return chains;
  return nullptr;
}

double rounded_up(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  return std::ceil(x / power - 1e-9) * power;
}

}  // namespace

ResultWatch::ResultWatch(const Assembler& body)
    : body_(body),
      may_lock_(may_lock(body.formulation(), body.mesh().type)),
      has_chains_(false),
      stiffest_(body.material(0).volume) {
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const Material& material = body.material(e);
    if (bulk_modulus(material) > bulk_modulus(stiffest_)) stiffest_ = material.volume;
    has_chains_ = has_chains_ || chains_of(material);
  }
}

void ResultWatch::look(double t, const VecX& u, const SolveReport& report) {
  t_ = t;
  residual_ = report.residual;
  reactions_ = std::max(reactions_, report.reference);
  asked_ = std::max(asked_, report.asked);
  if (report.tolerance > report.asked && report.tolerance > raised_.tolerance) {
    raised_.tolerance = report.tolerance;
    raised_.t = t;
  }
  if (may_lock_) {
    const Locking now = locking(body_, u);
    if (now.energy > locking_.energy) locking_ = now;
  }
  if (has_chains_) look_at_chains(u);
  if (body_.viscous()) look_at_branches();
}

// A cycle that ends in a hold costs the work against the branches and nothing else
// (element/viscous_points.hpp): what is negative beyond the error of the increments is no
// dissipation.
void ResultWatch::look_at_branches() {
  const ViscousPoints& points = *body_.viscous_points();
  double volume = 0, given = 0, worst = 0;
  for (int e = 0; e < body_.mesh().n_cells(); ++e) volume += body_.geometry(e).V;
  const double little = -1e-2 * std::abs(body_.viscous_work()) / volume;
  Vec3 place = Vec3::Zero();
  for (int e = 0; e < body_.mesh().n_cells(); ++e)
    for (int g = 0; points.has(e) && g < body_.geometry(e).n_gauss(); ++g) {
      const double work = points.work(e, g);
      if (!(work < little)) continue;
      given += body_.geometry(e).w[g] / volume;
      if (work < worst) {
        worst = work;
        place = gauss_position(body_.mesh(), e, g);
      }
    }
  if (given > given_.share) {
    given_.share = given;
    given_.t = t_;
    given_.place = place;
  }
}

void ResultWatch::look_at_chains(const VecX& u) {
  for (int e = 0; e < body_.mesh().n_cells(); ++e) {
    const ArrudaBoyce* law = chains_of(body_.material(e));
    if (!law) continue;
    const ElementNodes q = body_.element_displacements(u, e);
    for (int g = 0; g < body_.geometry(e).n_gauss(); ++g) {
      const Mat3 H = displacement_gradient(q, body_.geometry(e).dN_dX[g]);
      const double stretch =
          (Mat3::Identity() + H).norm() / std::sqrt(3.0) / std::cbrt(1 + volume_change(H));
      if (stretch <= law->locking_stretch ||
          stretch / law->locking_stretch <=
              chains_.stretch / std::max(chains_.locking_stretch, 1e-300))
        continue;
      chains_.stretch = stretch;
      chains_.locking_stretch = law->locking_stretch;
      chains_.place = gauss_position(body_.mesh(), e, g);
    }
  }
}

std::optional<Error> ResultWatch::refusal() const {
  if (!(residual_ > largest_residual * reactions_) || !(residual_ > asked_)) return std::nullopt;
  return Error{
      {},
      "",
      fmt::format(
          "at t = {:.6g} the residual is {:.2g} N, with reactions of {:.3g} N: with {} the rounding of the "
          "displacements leaves forces of this size",
          t_, residual_, reactions_, stiffness()),
      fmt::format("a residual of at most {:g} % of the reactions", 100 * largest_residual),
      fmt::format("material.volume.{}.{} leaves a residual as small as asked",
                  std::visit([](const auto& law) { return law.key; }, stiffest_), soft_enough())};
}

std::string ResultWatch::stiffness() const {
  if (const auto* law = std::get_if<QuadraticVolume>(&stiffest_))
    return fmt::format("d = {:g}", law->d);
  return fmt::format("bulk_modulus = {:g}", bulk_modulus(stiffest_));
}

// The d or bulk modulus with which rounding allows the requested tolerance: the rounding of the
// residual grows with the bulk modulus 2/d.
std::string ResultWatch::soft_enough() const {
  const auto* law = std::get_if<QuadraticVolume>(&stiffest_);
  double present = 2 / bulk_modulus(stiffest_);
  if (law) present = law->d;
  const double d = rounded_up(present * raised_.tolerance / std::max(asked_, 1e-300));
  if (law) return fmt::format("d: {:.0e}", d);
  return fmt::format("bulk_modulus: {:.0e}", 2 / d);
}

std::vector<std::string> ResultWatch::warnings() const {
  std::vector<std::string> lines;
  const double share = std::abs(locking_.share);
  if (share > worth_saying) {
    std::string cause = "the cells lock";
    std::string size = "large";
    if (locking_.share < 0) {
      cause = "the volume changes within cells, which nothing opposes";
      size = "small";
    }
    std::string amount = "5 % or much more";
    if (share < known) amount = fmt::format("some {:.2g} %", 100 * share);
    const CellType type = body_.mesh().type;
    lines.push_back(fmt::format(
        "formulation {} on {}: {}, most near {}: the forces are too {} by {}; formulation: {} cures it",
        names(body_.formulation())[static_cast<int>(body_.formulation())],
        names(type)[static_cast<int>(type)], cause, place_text(locking_.place), size, amount,
        names(usual_formulation(type))[static_cast<int>(usual_formulation(type))]));
  }
  if (raised_.tolerance > asked_)
    lines.push_back(fmt::format(
        "the residual's tolerance was raised from {:.1g} N to {:.1g} N at t = {:.4g}, {:.1g} % of the reactions: "
        "with {} rounding allows no less; {} leaves what was asked",
        asked_, raised_.tolerance, raised_.t,
        100 * raised_.tolerance / std::max(reactions_, 1e-300), stiffness(), soft_enough()));
  if (given_.share > 1e-4)
    lines.push_back(fmt::format(
        "the dissipation is negative in {:.2g} % of the volume at t = {:.4g}, most near {}: along such paths the linear "
        "evolution of the viscous branches gives work for nothing, and its stresses mean little",
        100 * given_.share, given_.t, place_text(given_.place)));
  if (chains_.stretch > 0)
    lines.push_back(fmt::format(
        "the chains of arruda_boyce are stretched to {:.4g} near {}, beyond their locking_stretch of {:.4g}: the "
        "series of five terms that the law is continues there, the chains do not",
        chains_.stretch, place_text(chains_.place), chains_.locking_stretch));
  return lines;
}

}  // namespace langer

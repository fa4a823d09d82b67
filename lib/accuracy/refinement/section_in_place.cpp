#include "accuracy/refinement/section_in_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "accuracy/refinement/constants.hpp"
#include "scene/model/scene.hpp"

namespace langer {

namespace {

Vec3 middle_of(const IndentedBlock& block) {
  return {block.origin[0] + 0.5 * block.size[0], 0, block.origin[2] + 0.5 * block.size[2]};
}

bool is_end(const std::string& set) {
  return set == "top" || set == "bottom" || set == "y_min" || set == "y_max";
}

// a set that is the same around the axis
bool is_round(const SetConfig& set, const Vec3& axis) {
  if (set.of && !is_end(*set.of)) return false;
  if (const auto* plane = std::get_if<OnPlane>(&set.within)) return plane->axis == "y";
  const auto* cylinder = std::get_if<InCylinder>(&set.within);
  return cylinder && cylinder->axis == "y" &&
         std::hypot(cylinder->through[0] - axis[0], cylinder->through[2] - axis[2]) == 0;
}

// All sets that supports, loads and contacts name are the same around the axis.
bool has_round_sets(const SolveConfig& config, const Vec3& axis) {
  const auto round = [&](const std::string& name) {
    const auto found = config.mesh->sets.find(name);
    return is_end(name) || (found != config.mesh->sets.end() && is_round(found->second, axis));
  };
  const auto& sets = config.mesh->sets;
  return std::all_of(sets.begin(), sets.end(),
                     [&](const auto& set) { return is_round(set.second, axis); }) &&
         std::all_of(config.supports.begin(), config.supports.end(),
                     [&](const auto& s) { return round(s.on); }) &&
         std::all_of(config.loads.begin(), config.loads.end(),
                     [&](const auto& l) { return round(l.on); }) &&
         std::all_of(config.contacts.begin(), config.contacts.end(),
                     [&](const auto& c) { return c.second.on.empty() || round(c.second.on); });
}

// held or moved in the plane of x and z in all directions or in none
bool holds_alike(const SolveConfig& config) {
  const auto alike = [](const SupportConfig& s) {
    const auto holds = [&](Axis axis) {
      return std::find(s.hold.begin(), s.hold.end(), axis) != s.hold.end();
    };
    return holds(Axis::x) == holds(Axis::z);
  };
  return std::all_of(config.supports.begin(), config.supports.end(), alike) &&
         std::all_of(config.loads.begin(), config.loads.end(), [](const LoadConfig& l) {
           return l.displacement && !l.rotation && !l.imposed(0) && !l.imposed(2);
         });
}

bool has_direction(const std::optional<Material>& material) {
  return material && std::any_of(material->fibres.begin(), material->fibres.end(),
                                 [](const Fibre& f) { return has_direction(f); });
}

// No fibres that point somewhere, in any of the materials.
bool is_isotropic(const SolveConfig& config, const std::optional<Material>& material) {
  return !has_direction(material) && !has_direction(config.material) &&
         std::none_of(config.materials.begin(), config.materials.end(),
                      [](const auto& body) { return has_direction(body.second.material); });
}

// an indenter of revolution about the axis, that moves along it
bool is_round(const ContactConfig& contact, const Vec3& axis) {
  return !contact.control && !contact.rotation &&
         is_revolved_about({axis, Vec3::UnitY()}, contact.rigid.value()) &&
         std::all_of(contact.motion.begin(), contact.motion.end(),
                     [](const WaypointConfig& w) { return w.to[0] == 0 && w.to[2] == 0; });
}

// of a quantity that is known at each step, or at the end only
double value_of(const SolvedPath& solved, const std::string& name, double t) {
  if (!solved.path.empty() && solved.path.back().of.contains(name))
    return force_at(solved.path, name, t);
  const auto found = std::ranges::find(solved.found, name, &Valued::name);
  return found == solved.found.end() ? 0 : found->value;
}

void shift(std::array<double, 3>& x, const Vec3& by) {
  for (int k = 0; k < 3; ++k) x[static_cast<std::size_t>(k)] -= by[k];
}

// all places as seen from the axis
void move_to_axis(SolveConfig& config, const Vec3& axis) {
  for (auto& [name, x] : config.mesh->points) shift(x, axis);
  for (auto& [name, set] : config.mesh->sets)
    if (auto* cylinder = std::get_if<InCylinder>(&set.within)) shift(cylinder->through, axis);
  for (auto& [name, contact] : config.contacts)
    std::visit(
        [&]<class S>(S& shape) {
          if constexpr (requires { shape.centre; }) shift(shape.centre, axis);
          if constexpr (requires { shape.face; }) shift(shape.face, axis);
          if constexpr (requires { shape.point; }) shift(shape.point, axis);
        },
        contact.rigid.value());
}

}  // namespace

// Discs that lie inside the block, that have its area, and that lie around it. The force of the
// block lies between those of the first and the last.
RadiiOfBlock radii_of(const IndentedBlock& block) {
  const double a = block.size[0];
  const double b = block.size[2];
  return {0.5 * std::min(a, b), std::sqrt(a * b / std::numbers::pi), 0.5 * std::hypot(a, b)};
}

// The same scene on a section of a disc, or nothing where the scene is not the same around the
// axis: the indenter off the middle, fibres, supports that hold one direction of the plane, sets at
// sides.
std::optional<SolveConfig> on_a_disc(const SolveConfig& config,
                                     const std::optional<Material>& material, double radius) {
  const auto* block = config.mesh ? std::get_if<IndentedBlock>(&config.mesh->geometry) : nullptr;
  if (!block || config.contacts.empty() || !block->in_the_middle() ||
      (block->even && (*block->even)[0] != (*block->even)[1]))
    return std::nullopt;
  const Vec3 axis = middle_of(*block);
  const bool named =
      config.symmetry != SymmetryChoice::none && config.symmetry != SymmetryChoice::automatic;
  const bool round =
      std::all_of(config.contacts.begin(), config.contacts.end(),
                  [&](const auto& contact) { return is_round(contact.second, axis); });
  const auto& points = config.mesh->points;  // in the plane of the section
  const bool seen = std::all_of(points.begin(), points.end(), [&](const auto& p) {
    return p.second[2] == axis[2] && p.second[0] >= axis[0];
  });
  if (named || !round || !seen || !is_isotropic(config, material) || !holds_alike(config) ||
      !has_round_sets(config, axis))
    return std::nullopt;
  SolveConfig section = config;
  section.accuracy.reset();
  section.fidelity.reset();
  section.symmetry = SymmetryChoice::none;
  section.reduce = Reduce::none;
  IndentedDisc disc{
      {radius, block->size[1]}, block->origin[1], block->radius, block->depth, block->edge};
  if (block->even) disc.even = (*block->even)[0];
  section.mesh->geometry = disc;
  section.mesh->frames = Frames::global;
  move_to_axis(section, axis);
  return section;
}

SectionInPlace::SectionInPlace(const Voice& voice, const SolveConfig& config,
                               const std::optional<Material>& material, const Where& where,
                               bool dry)
    : voice_(voice), asked_(config) {
  const auto* block = config.mesh ? std::get_if<IndentedBlock>(&config.mesh->geometry) : nullptr;
  if (block) radii_ = radii_of(*block);
  if (config.reduce == Reduce::automatic)
    decide(material, where, dry);
  else if ((offered_ = on_a_disc(config, material, radii_.alike).has_value()))
    voice_.say(
        "the scene is the same around an axis but for its sides: reduce: auto solves a section where they do not matter");
}

// The section is used where the sides of the block change the force by less than the accuracy that
// the user wants. Three sections show how much they change it.
void SectionInPlace::decide(const std::optional<Material>& material, const Where& where, bool dry) {
  SolveConfig chosen = asked_;
  accuracy_ = choose_accuracy(chosen, material);
  auto section = on_a_disc(chosen, material, radii_.alike);
  if (!section) {
    const bool given = std::ranges::any_of(
        asked_.contacts, [](const auto& contact) { return contact.second.control.has_value(); });
    std::string why = "no indented_block here whose scene is the same around an axis";
    if (given) why = "an indenter with a given force";
    return voice_.say("reduce: {}; the body is solved as it is", why);
  }
  if (dry) return voice_.say("reduce: a section may take the block's place (not with --dry-run)");
  if (accuracy_) {
    const bool bilinear =
        asked_.formulation && asked_.formulation != Formulation::linear_dilatation;
    accuracy_->level.cells = CellType::hex27;
    accuracy_->level.edge = refinement::section_edge_hex27;
    if (bilinear) {
      accuracy_->level.cells = CellType::hex8;
      accuracy_->level.edge = refinement::section_edge_hex8;
    }
    accuracy_->finest = refinement::finest_of_section;
    accuracy_->written = section->mesh->geometry;
    put(*accuracy_, *section);
  }
  try {
    measure_sides(*section, material, where);
  } catch (const Failure& failure) {
    if (failure.code() != Exit::not_converged) throw;
    return voice_.say("reduce: {}; the block is solved", failure.what());
  }
  const std::string sides = fmt::format(
      "discs of {:.4g} and {:.4g} mm inside and around the block show that its sides change the force by up to {:.2g} %",
      radii_.inside, radii_.around, sides_percent_);
  if (!(sides_percent_ < wanted()))
    return voice_.say("reduce: {}, and {:g} % is allowed: the block is solved", sides, wanted());
  voice_.say("reduce: a section of a disc of {:.4g} mm, of the block's area, takes its place; {}",
             radii_.alike, sides);
  section_ = std::move(section);
}

// on meshes alike near the indenter, without what is no matter there
void SectionInPlace::measure_sides(const SolveConfig& section,
                                   const std::optional<Material>& material, const Where& where) {
  const auto solved = [&](double radius) {
    SolveConfig disc = section;
    std::get<IndentedDisc>(disc.mesh->geometry).size[0] = radius;
    disc.mesh->points.clear();
    return solved_path(disc, material, where);
  };
  const SolvedPath alike = solved(radii_.alike);
  const SolvedPath inside = solved(radii_.inside);
  const SolvedPath around = solved(radii_.around);
  for (const Valued& force : forces_judged(alike.found)) {
    const auto [value, most] = largest_change(force.name, alike, {&inside, &around});
    sides_.push_back({force.name, force.unit, most});
    sides_percent_ = std::max(sides_percent_, 100 * most / std::max(value, 1e-300));
  }
}

// Of a force where it is judged, which need not be the end of the path.
SectionInPlace::Change SectionInPlace::largest_change(
    const std::string& force, const SolvedPath& alike,
    const std::vector<const SolvedPath*>& others) const {
  Change change;
  const auto look_at = [&](double t) {
    const double here = value_of(alike, force, t);
    change.of = std::max(change.of, std::abs(here));
    for (const SolvedPath* other : others)
      change.most = std::max(change.most, std::abs(value_of(*other, force, t) - here));
  };
  if (asked_.accuracy && asked_.accuracy->at == AccuracyAt::every_step) {
    for (const StepForces& step : alike.path) look_at(step.t);
  } else {
    look_at(judged_at(asked_, alike.path, force));
  }
  return change;
}

double SectionInPlace::percent(const std::vector<ErrorEstimate>& errors) const {
  double most = 0;
  for (const ErrorEstimate& e : errors)
    for (const Valued& side : sides_)
      if (side.name == e.of.name) most = std::max(most, e.in_percent(e.total() + side.value));
  return most;
}

// Whether the section is accurate enough, with the influence of the sides added to its error. If
// not, a finer section follows, or the block where none is left.
bool SectionInPlace::accurate(const std::vector<ErrorEstimate>& errors) {
  if (!section_ || !accuracy_ || (errors.empty() && section_->estimate != EstimateBy::refinement))
    return true;
  if (!errors.empty() && percent(errors) <= wanted()) return true;
  if (errors.empty())
    voice_.say("reduce: no estimate of the section's errors");
  else
    voice_.say("reduce: {:.2g} % with the sides, and {:g} % is asked for", percent(errors),
               wanted());
  ChosenLevel left = *accuracy_;  // what the sides leave of what is asked for
  left.wanted -= sides_percent_;
  const auto finer = errors.empty() ? with_shorter_cells(left) : finer_level(left, errors);
  if (finer) {
    accuracy_->level = *finer;
    put(*accuracy_, *section_);
    voice_.say("reduce: again with {}", in_words(*finer));
  } else {
    voice_.say("reduce: the block is solved");
    section_.reset();
  }
  return false;
}

std::vector<Summary> SectionInPlace::summary(const std::vector<ErrorEstimate>& errors) const {
  if (!section_) return {};
  std::vector<Summary> summary;
  for (const Valued& side : sides_)
    summary.push_back({side.name + "_error_sides", side.value, side.unit});
  if (accuracy_ && !errors.empty()) summary.push_back({"accuracy", percent(errors), "percent"});
  return summary;
}

}  // namespace langer

#include "accuracy/refinement/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/checks/progress.hpp"
#include "accuracy/estimate/pad_edges.hpp"
#include "accuracy/refinement/adaptive_cells.hpp"
#include "accuracy/refinement/constants.hpp"
#include "accuracy/refinement/level_cost.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "scene/model/supports.hpp"
#include "scene/run/footprint.hpp"

namespace langer {

using namespace refinement;

namespace {

bool has_fibres(const SolveConfig& config, const std::optional<Material>& material) {
  const auto fibrous = [](const std::optional<Material>& m) {
    return m && !m->fibres.empty();
  };
  return fibrous(material) ||
         std::any_of(config.materials.begin(), config.materials.end(),
                     [&](const auto& body) { return fibrous(body.second.material); });
}

// cells to where the indenters are, unless the config says where
void place_cells(IndentedBlock& block, const Footprint& print) {
  const double a = block.contact_radius();
  const auto middle = [&](int k) {
    return block.origin[2 * k] + 0.5 * block.size[2 * k];
  };
  const bool beside = std::abs(print.middle(0) - middle(0)) > 0.02 * a ||
                      std::abs(print.middle(1) - middle(1)) > 0.02 * a;
  const double widest = std::max(print.half(0), print.half(1));
  // a plane over all of the top has no place of its own
  if (2 * print.half(0) > 0.99 * block.size[0] && 2 * print.half(1) > 0.99 * block.size[2]) return;
  if (!block.under && beside) block.under = {print.middle(0), print.middle(1)};
  if (!block.even && widest > 1.05 * a) {
    block.even.emplace();
    for (int k : {0, 1}) (*block.even)[static_cast<std::size_t>(k)] = print.half(k) + 0.1 * a;
  }
}

// Whether the body lies on its bottom, as the study's bodies do: each support holds all of the
// bottom, and its bottom cannot move along y.
bool lies_on_its_bottom(const SolveConfig& config) {
  return std::ranges::all_of(config.supports, is_at_bottom) && !has_nothing_below(config);
}

// Where a set ends, on the axes along which it is a part of the body. A box that holds less than
// one cell along an axis selects a plane there.
void add_ends(const MeshConfig& mesh, const SetConfig& set,
              std::array<std::vector<double>, 3>& breaks) {
  const auto [origin, size] = box(mesh.geometry);
  const std::vector<int> n = numbers_of_cells(mesh.geometry);
  if (const auto* plane = std::get_if<OnPlane>(&set.within)) {
    breaks[static_cast<std::size_t>(plane->axis[0] - 'x')].push_back(plane->at);
    return;
  }
  const auto* part = std::get_if<InBox>(&set.within);
  if (!part) return;
  for (std::size_t i = 0; i < n.size(); ++i) {
    const bool across = set.of && axis_of_side(*set.of) == static_cast<int>(i);
    if (across || part->to[i] - part->from[i] < 0.5 * size[i] / n[i]) continue;
    breaks[i].push_back(part->from[i]);
    breaks[i].push_back(part->to[i]);
  }
}

// Where lines have to go on every mesh of an estimate: ends of the sets that supports, loads and
// contacts name, points, borders of layers. So sets have the same area on all of them.
std::array<std::vector<double>, 3> breaks_of(const SolveConfig& config) {
  std::array<std::vector<double>, 3> breaks;
  const MeshConfig& mesh = *config.mesh;
  const auto add = [&](const std::string& name) {
    const auto found = mesh.sets.find(name);
    if (found != mesh.sets.end()) add_ends(mesh, found->second, breaks);
  };
  for (const SupportConfig& support : config.supports) add(support.on);
  for (const LoadConfig& load : config.loads) add(load.on);
  for (const auto& [name, contact] : config.contacts) add(contact.on);
  for (const auto& [name, x] : mesh.points)
    for (std::size_t i = 0; i < 3; ++i) breaks[i].push_back(x[i]);
  double y = box(mesh.geometry).origin[1];
  for (const LayerConfig& layer : mesh.bodies) breaks[1].push_back(y += layer.thickness);
  return breaks;
}

// Scenes that no study stands for are judged on meshes of one family, whose order shows by itself.
// Indentations of a body that lies on its bottom have been measured on meshes of their own kind.
bool wants_family(const SolveConfig& config) {
  if (std::holds_alternative<IndentedDisc>(config.mesh->geometry)) return false;
  if (!std::holds_alternative<IndentedBlock>(config.mesh->geometry)) return true;
  return !lies_on_its_bottom(config) || !config.loads.empty();
}

// one sphere above the middle of one layer, at least as thick as the contact is wide
bool of_the_studys_kind(const SolveConfig& config, const std::optional<Footprint>& print) {
  const auto* block = std::get_if<IndentedBlock>(&config.mesh->geometry);
  if (!block || config.contacts.size() != 1 || !config.loads.empty() ||
      config.mesh->bodies.size() > 1 || !print || !lies_on_its_bottom(config))
    return false;
  const ContactConfig& contact = config.contacts.begin()->second;
  if (!ball_of(contact.rigid.value()) || contact.rotation) return false;
  const double a = std::max(print->half(0), print->half(1));
  return !block->under && !block->even && a <= block->size[1] && a > 0.7 * block->contact_radius();
}

// Whether an estimate by refinement may answer with the limit of its meshes.
bool limit_may_answer(const SolveConfig& config) {
  const bool by_other_meshes = !config.estimate || *config.estimate == EstimateBy::refinement ||
                               *config.estimate == EstimateBy::automatic;
  return by_other_meshes && !needs_the_mesh(config);
}

bool wants_other_than_hex27(const SolveConfig& config) {
  return config.formulation && *config.formulation != Formulation::linear_dilatation;
}

// Of bodies that are held and moved at their faces, or pressed by planes without friction, hex27
// are as near as hex8 for a tenth of the time and less (docs/work_precision.md).
CellType first_cells(const SolveConfig& config, bool cut) {
  const auto is_plane = [](const auto& c) {
    return is_flat(c.second.rigid.value()) && !c.second.adhesion;
  };
  // a body that is not held below bends, and hex8 are too stiff for that
  const bool bends =
      has_edge_in_contact_radii(config.mesh->geometry) && !lies_on_its_bottom(config);
  const bool by_faces = std::ranges::all_of(config.contacts, is_plane) &&
                        !has_edge_in_contact_radii(config.mesh->geometry);
  const bool better =
      (by_faces || bends) && !has_friction(config) && !wants_other_than_hex27(config);
  if (better && !cut && config.mesh->cells == CellType::hex8) return CellType::hex27;
  return config.mesh->cells;
}

// With the config's own cells, or as many nodes; shorter where there are too few of them to make
// coarser ones.
AccuracyLevel the_configs_own(const SolveConfig& config, CellType cells) {
  AccuracyLevel level{cells, cells == config.mesh->cells ? 1.0 : 2.0,
                      config.path.largest_increment(), 0, false};
  for (int n : numbers_of_cells(config.mesh->geometry))
    if (n > 1) level.edge = std::min(level.edge, n / 4.0);
  return level;
}

// in thin layers with cells that are short enough for some layers of them
AccuracyLevel where_to_begin(const SolveConfig& config, const ChosenLevel& chosen, CellType cells,
                             bool by_limit) {
  Geometry geometry = config.mesh->geometry;
  double* const edge = edge_in_contact_radii(geometry);
  if (!edge) return the_configs_own(config, cells);
  const int per_layer = cells == CellType::hex27 ? 2 : 5;
  const int fewest_layers = per_layer * std::max(1, static_cast<int>(config.mesh->bodies.size()));
  AccuracyLevel level = coarsest;
  if (is_section(geometry)) {
    level = of_disc;
  } else if (cells == CellType::hex27) {
    level = bent;
  } else if (chosen.cut) {
    level = to_be_cut;
  } else if (has_friction(config) && chosen.wanted < enough_for_coarsest) {
    level = coarsest_with_friction;
    if (by_limit) level.edge = resolves_friction;
  }
  *edge = level.edge;
  while (*edge > chosen.finest && numbers_of_cells(geometry)[1] < fewest_layers) *edge *= 0.95;
  level.edge = *edge;
  return level;
}

// of the geometry along which there is more than one cell; at least one
std::ptrdiff_t axes_with_cells(const Geometry& geometry) {
  const auto axes = std::ranges::count_if(numbers_of_cells(geometry), [](int n) { return n > 1; });
  return std::max<std::ptrdiff_t>(axes, 1);
}

double finest_edge(const MeshConfig& mesh, CellType first) {
  if (std::holds_alternative<IndentedBlock>(mesh.geometry)) return finest_of_block;
  if (std::holds_alternative<IndentedDisc>(mesh.geometry)) return finest_of_disc;
  const double cells = (reference(first).second_order() ? 8 : 1) * n_cells(mesh.geometry);
  const auto axes = static_cast<double>(axes_with_cells(mesh.geometry));
  return std::min(1.0, std::pow(cells / most_hex8, 1 / axes));
}

// Keeps the mesh size and increments of the config if they are finer than the level's, and returns
// the others as words for a message. `written`: the config before anything was chosen.
std::string kept_and_replaced(const SolveConfig& written, AccuracyLevel& level) {
  std::string replaced;
  const auto replace = [&](const std::string& what) {
    append(replaced, ", ", what);
  };
  Geometry geometry = written.mesh->geometry;
  const SolveConfig usual;
  if (const double* edge = edge_in_contact_radii(geometry); edge && *edge != IndentedBlock{}.edge) {
    if (*edge < level.edge && written.mesh->cells == level.cells)
      level.edge = *edge;
    else if (*edge != level.edge)
      replace(fmt::format("edge of {:g}", *edge));
  }
  if (const CellType cells = written.mesh->cells;
      (cells != CellType::hex8 || !level.in_contact_radii) && cells != level.cells)
    replace(names(cells)[static_cast<int>(cells)]);
  const double step = written.path.largest_increment();
  if (!written.path.steps && step == usual.path.largest) return replaced;
  if (step < level.step)
    level.step = step;
  else if (step > level.step)
    replace(fmt::format("increments of {:g}", step));
  return replaced;
}

// Of several bodies: the config's own cells, whose estimate decides. All bodies get shorter cells
// together.
void choose_for_bodies(const SolveConfig& config, ChosenLevel& chosen) {
  for (const auto& [name, body] : config.bodies) {
    Block& block = chosen.bodies[name] = std::get<Block>(body.mesh.geometry);
    if (has_pads(config)) block.family = MeshFamily{.breaks = pad_edges_on(config, name)};
  }
  chosen.level = {CellType::hex8, 1, config.path.largest_increment(), 0, false};
  chosen.finest = std::min(1.0, std::cbrt(n_cells(chosen, chosen.level) / most_hex8));
  chosen.shown = false;
  chosen.words = fmt::format("{:g} % wanted: {}", chosen.wanted, in_words(chosen.level));
}

}  // namespace

const std::vector<AccuracyLevel>& accuracy_levels(bool plain) {
  static const std::vector<AccuracyLevel> smooth(std::begin(smooth_levels),
                                                 std::end(smooth_levels));
  static const std::vector<AccuracyLevel> others(std::begin(other_levels), std::end(other_levels));
  return plain ? smooth : others;
}

std::optional<ChosenLevel> choose_accuracy(SolveConfig& config,
                                           const std::optional<Material>& material,
                                           bool by_estimate) {
  if (!asks_for_accuracy(config)) return std::nullopt;
  constexpr double by_name[]{5, 1, 0.2};
  ChosenLevel chosen;
  if (config.accuracy) {
    chosen.wanted = *percent_of(config.accuracy->within);
  } else {
    chosen.wanted = by_name[static_cast<int>(*config.fidelity)];
  }
  if (!config.bodies.empty()) {
    choose_for_bodies(config, chosen);
    return chosen;
  }
  const bool may_be_cut =
      !config.mesh || (config.mesh->cells == CellType::hex8 && !is_section(config.mesh->geometry));
  chosen.cut = by_estimate && may_be_cut && reason_not_refinable(config).empty();
  if (!config.mesh || !has_numbers_of_cells(config.mesh->geometry)) {  // judged as it is
    chosen.level = {config.mesh ? config.mesh->cells : CellType::hex8, 1,
                    config.path.largest_increment(), 0, false};
    chosen.shown = false;
    chosen.words = fmt::format("{:g} % wanted of the mesh as it is", chosen.wanted);
    return chosen;
  }
  const SolveConfig written = config;
  Geometry& geometry = config.mesh->geometry;
  std::optional<Footprint> print;
  if (std::holds_alternative<IndentedBlock>(geometry)) {
    print = footprint(config, box(geometry));
  }
  if (print) place_cells(std::get<IndentedBlock>(geometry), *print);
  const CellType first = first_cells(config, chosen.cut);
  auto* const sheet = std::get_if<IndentedBlock>(&geometry);
  if (sheet && first == CellType::hex27 && has_nothing_below(config))
    sheet->longest = longest_of_sheet * sheet->size[1];
  if (wants_family(config) && !chosen.cut) put_in_family(geometry, breaks_of(config));
  chosen.written = geometry;
  chosen.finest = finest_edge(*config.mesh, first);
  const bool elastic = !config.path.seconds;  // as the study's bodies
  chosen.shown = of_the_studys_kind(config, print) && elastic && !chosen.cut;
  const bool plain = chosen.shown && !wants_other_than_hex27(config) && !has_friction(config) &&
                     !has_fibres(config, material);
  const auto& levels = accuracy_levels(plain);
  const bool by_limit = by_estimate && limit_may_answer(config);
  double closer = limit_is_closer;
  if (plain && chosen.wanted >= enough_for_smooth_limit) closer = limit_is_closer_smooth;
  auto level = std::find_if(levels.begin(), levels.end(), [&](const AccuracyLevel& r) {
    // On longer elements the estimate does not see the shear at the edge of a contact with
    // friction.
    const bool limit_known = by_limit && (!has_friction(config) || r.edge <= resolves_friction);
    return r.error <= (limit_known ? closer : 1) * chosen.wanted;
  });
  if (!chosen.shown) {
    chosen.level = where_to_begin(config, chosen, first, by_limit);
  } else if (level != levels.end()) {
    chosen.level = *level;
  } else {
    chosen.level = levels.back();
  }
  chosen.met = chosen.shown && chosen.level.error <= chosen.wanted;
  if (!plain && !has_friction(config))
    chosen.level.step = coarsest.step;  // the force does not depend on the path
  if (elastic && config.contacts.empty())
    chosen.level.step = std::max(coarsest.step, written.path.largest_increment());
  // what relaxes wants the cells of what does not
  if (!elastic && has_friction(config) && level != levels.end() &&
      of_the_studys_kind(config, print))
    chosen.level.edge = std::min(chosen.level.edge, level->edge);
  std::string replaced = kept_and_replaced(written, chosen.level);
  if (!replaced.empty()) replaced = "; instead of the config's " + replaced;
  put(chosen, config);
  // what increments change of the force in the paper's scene, held, is a twentieth of this
  // (docs/time.md); the estimate judges
  if (config.path.seconds && config.path.time_error == LoadPathOptions{}.time_error)
    config.path.time_error = std::min(2e-2 * chosen.wanted, 0.1);
  if (!config.estimate || config.estimate == EstimateBy::automatic)
    config.estimate = EstimateBy::refinement;
  chosen.words =
      fmt::format("{:g} % wanted: {}{}", chosen.wanted, in_words(chosen.level), replaced);
  if (chosen.shown)
    chosen.words +=
        fmt::format("; in the refinement study's scenes {} the force was within {:g} %{}",
                    plain ? "without fibres and friction" : "with friction", chosen.level.error,
                    level == levels.end() ? ", the finest level measured" : "");
  return chosen;
}

std::string in_words(const AccuracyLevel& level) {
  const char* cells = names(CellType{})[static_cast<int>(level.cells)];
  if (level.in_contact_radii)
    return fmt::format("{} of {:.3g} contact radii, increments of {:.3g}", cells, level.edge,
                       level.step);
  if (level.edge == 1)
    return fmt::format("{} of the config's length, increments of {:.3g}", cells, level.step);
  return fmt::format("{} of {:.3g} times the config's length, increments of {:.3g}", cells,
                     level.edge, level.step);
}

ReachedAccuracy reached(const ChosenLevel& chosen, const std::vector<ErrorEstimate>& estimates) {
  ReachedAccuracy found{chosen.level.error, chosen.met, ""};
  const std::vector<ErrorEstimate> forces = forces_judged(estimates);
  const bool estimated = !forces.empty();
  if (estimated) found.percent = 0;
  for (const ErrorEstimate& e : forces) found.percent = std::max(found.percent, e.percent());
  if (estimated) found.met = found.percent <= chosen.wanted;
  if (found.met) return found;
  const auto in_a_word = [](const Valued& q) {
    if (q.of_force()) return "force";
    return q.unit == unit::MPa ? "stress" : "displacement";
  };
  if (estimated)
    found.words = fmt::format("asked for {:g} %, and the error of the {} is estimated at {:.2g} %",
                              chosen.wanted, in_a_word(forces.front().of), found.percent);
  else if (chosen.shown)
    found.words = fmt::format(
        "asked for {:g} %, and the error of the force is in scenes of this kind up to {:.2g} %",
        chosen.wanted, found.percent);
  else
    found.words = fmt::format(
        "asked for {:g} %, and the error of the force is not known: nothing was estimated",
        chosen.wanted);
  return found;
}

Accuracy::Accuracy(const Voice& voice, const SolveConfig& config,
                   const std::optional<Material>& material, Where where, bool dry)
    : voice_(voice),
      config_(config),
      material_(material),
      where_(std::move(where)),
      chosen_(choose_accuracy(config_, material, true)) {
  if (!chosen_) return;
  voice_.detail("accuracy: {}", chosen_->words);
  if (chosen_->cut)
    voice_.detail("accuracy: cells are cut where the error comes from, until it is within that");
  begins_ = !chosen_->shown && chosen_->level.in_contact_radii &&
            config_.estimate == EstimateBy::refinement;
  if (begins_)
    voice_.detail(
        "accuracy: the study has no scene of this kind; the error with these cells decides which ones it needs{}",
        dry ? " (not with --dry-run)" : "");
  if (begins_ && dry) {
    const Stopwatch watch(seconds_of_forecasts_);
    const AccuracyLevel next = finest_at_once(*chosen_);
    voice_.say("accuracy: a next level, where these cells are not enough, takes up to {}",
               in_words(level_cost(with(next), material_, where_)));
  }
}

// where they have not fallen, or by chance to nearly nothing, an order says little
OrdersSeen Accuracy::orders_since_before(const std::vector<ErrorEstimate>& estimates) {
  OrdersSeen orders;
  std::map<std::string, double> now;
  for (const ErrorEstimate& e : estimates)
    now[e.of.name] = e.percent() - e.in_percent(std::abs(e.increments));
  const double shorter = edge_before_ / chosen_->level.edge;
  for (const auto& [name, percent] : cells_before_)
    if (shorter > 1.1 && now.contains(name))
      orders[name] =
          std::clamp(std::log(percent / std::max(now[name], 1e-300)) / std::log(shorter), 1.0, 2.5);
  edge_before_ = chosen_->level.edge;
  cells_before_ = std::move(now);
  return orders;
}

SolveConfig Accuracy::with(const AccuracyLevel& level) const {
  ChosenLevel other = *chosen_;
  other.level = level;
  SolveConfig config = config_;
  put(other, config);
  return config;
}

std::string Accuracy::reason_too_expensive(const std::string& level, double cells,
                                           const std::function<LevelCost()>& cost) const {
  const double left = seconds_left();
  if (std::isinf(left) && cells < worth_a_forecast) return "";
  const LevelCost forecast = cost();
  voice_.detail("accuracy: {}: {}, by the forecast", level, in_words(forecast));
  const std::string why = limit_exceeded(forecast, left);
  if (why.empty()) return "";
  return fmt::format("a next level, {}, {}", level, why);
}

std::string Accuracy::reason_too_expensive(const AccuracyLevel& level) const {
  const SolveConfig config = with(level);
  return reason_too_expensive(in_words(level), n_cells(*chosen_, level),
                              [&] { return level_cost(config, material_, where_); });
}

std::string Accuracy::reason_too_expensive(const Mesh& mesh) const {
  return reason_too_expensive(fmt::format("{} cells", mesh.n_cells()), mesh.n_cells(),
                              [&] { return level_cost(config_, mesh, material_, where_); });
}

bool Accuracy::retry_after(const Failure& failure) {
  if (!begins_ || failure.code() != Exit::not_converged) return false;
  voice_.say("accuracy: {}", failure.what());
  return shorter_cells();
}

// once, where no error is known that would say which
bool Accuracy::shorter_cells() {
  if (++without_estimate_ > 1) return false;
  const std::optional<AccuracyLevel> shorter = with_shorter_cells(*chosen_);
  if (!shorter) return false;
  take(*shorter);
  voice_.say("accuracy: {}", in_words(*shorter));
  return true;
}

void Accuracy::take(const AccuracyLevel& level) {
  config_ = with(level);
  chosen_->level = level;
  chosen_->level.error = 0;
  chosen_->met = chosen_->shown = false;  // no study stands for it
}

void Accuracy::solves_part(double share) {
  if (!chosen_ || chosen_->level.in_contact_radii || share == share_) return;
  std::ptrdiff_t axes = 3;
  if (config_.mesh && has_numbers_of_cells(config_.mesh->geometry))
    axes = axes_with_cells(config_.mesh->geometry);
  const double longer = std::pow(share / share_, 1.0 / static_cast<double>(axes));
  chosen_->finest = std::min(1.0, chosen_->finest * longer);
  share_ = share;
}

void Accuracy::name_answers(std::vector<ErrorEstimate>& estimates) const {
  if (!chosen_) return;
  const std::vector<ErrorEstimate> judged = forces_judged(estimates);
  for (ErrorEstimate& e : estimates) {
    const bool is_judged = std::ranges::any_of(
        judged, [&](const ErrorEstimate& other) { return other.of.name == e.of.name; });
    const bool on_mesh = e.in_percent(e.total()) <= chosen_->wanted;
    e.limit_answers = is_judged && !on_mesh && e.percent() <= chosen_->wanted;
  }
  // The sum over several indenters goes with its parts.
  const auto is_limit = [](const ErrorEstimate& e) {
    return e.limit_answers && e.of.name.starts_with("force_");
  };
  if (std::ranges::none_of(estimates, is_limit)) return;
  for (ErrorEstimate& e : estimates)
    if (e.of.name == "force" && e.limit_has_bar) e.limit_answers = true;
}

// The last decision on a level: accept it if it meets the request, stop otherwise.
Decision Accuracy::final_decision(const std::vector<ErrorEstimate>& estimates) const {
  if (!chosen_ || reached(*chosen_, estimates).met) return {Decision::Action::accept};
  return {Decision::Action::stop, stop_reason_};
}

Decision Accuracy::decide(const std::vector<ErrorEstimate>& estimates) {
  if (!chosen_ || config_.estimate != EstimateBy::refinement) return final_decision(estimates);
  if (estimates.empty()) {
    if (shorter_cells()) return {Decision::Action::refine};
    return final_decision(estimates);
  }
  begins_ = false;
  const ReachedAccuracy found = reached(*chosen_, estimates);
  const OrdersSeen orders = orders_since_before(estimates);
  if (found.met) return {Decision::Action::accept};
  const auto finer = finer_level(*chosen_, estimates, orders);
  if (!finer) {
    const AccuracyLevel finest = finest_level(*chosen_);
    if (finest.edge < 0.99 * chosen_->level.edge) {
      stop_reason_ = fmt::format("the finest level that was tried, {}, would have about {:.2g} %",
                                 in_words(finest), percent_at(*chosen_, estimates, finest));
    } else {
      stop_reason_ = fmt::format("no finer cells are tried than {}", in_words(chosen_->level));
    }
    return final_decision(estimates);
  }
  stop_reason_ = reason_too_expensive(*finer);
  if (!stop_reason_.empty()) {
    stop_reason_ +=
        fmt::format("; its error would be about {:.2g} %", percent_at(*chosen_, estimates, *finer));
    return final_decision(estimates);
  }
  take(*finer);
  voice_.say("accuracy: {}; again with {}", found.words, in_words(*finer));
  return {Decision::Action::refine};
}

std::optional<double> Accuracy::wanted_share(const std::vector<ErrorEstimate>& estimates) const {
  if (!chosen_) return std::nullopt;
  if (forces_judged(estimates).empty()) return 0.0;
  const ReachedAccuracy found = reached(*chosen_, estimates);
  if (found.met) return std::nullopt;
  return std::optional(chosen_->wanted / found.percent);
}

std::optional<double> Accuracy::missed_percent(const std::vector<ErrorEstimate>& estimates) const {
  if (!chosen_ || forces_judged(estimates).empty()) return std::nullopt;
  const ReachedAccuracy found = reached(*chosen_, estimates);
  if (found.met) return std::nullopt;
  return found.percent;
}

std::vector<Summary> Accuracy::summary(const std::vector<ErrorEstimate>& estimates) const {
  if (!chosen_) return {};
  const ReachedAccuracy found = reached(*chosen_, estimates);
  const auto judged = forces_judged(estimates);
  const bool none = std::all_of(judged.begin(), judged.end(),
                                [](const ErrorEstimate& e) { return e.none_yet(); });
  if (none && (!judged.empty() || !chosen_->shown)) return {};  // not known
  return {{"accuracy", found.percent, "percent"}};
}

void Accuracy::require(const std::vector<ErrorEstimate>& estimates, const std::string& output,
                       const std::string& cheaper) const {
  if (!chosen_) return;
  const ReachedAccuracy found = reached(*chosen_, estimates);
  if (found.met) return;
  if (estimates.empty() && config_.estimate == EstimateBy::none)
    return voice_.warn("accuracy: " + found.words);
  const char* key = config_.accuracy ? "accuracy" : "fidelity";
  std::string found_text = found.words;
  if (!stop_reason_.empty()) found_text += "; " + stop_reason_;
  throw Failure(
      Exit::not_accurate,
      Error{
          where_(key), key, found_text, fmt::format("at most {:g} %", chosen_->wanted),
          fmt::format(
              "kept: {}, solved with {}; {}ask for what was reached, or say where cells are to be short: "
              "mesh.geometry with estimate, instead of {}",
              output, in_words(chosen_->level), cheaper, key)});
}

}  // namespace langer

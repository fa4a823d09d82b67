#include "report/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/base/text.hpp"
#include "core/config/tree.hpp"
#include "core/config/writer.hpp"
#include "scene/run/post_files.hpp"

namespace langer::report {

namespace {

// a number with as many digits as mean something to a reader; words as they are
std::string short_number(const std::string& word) {
  double x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (error != std::errc{} || end != word.data() + word.size() || word.size() <= 7) return word;
  return fmt::format("{:.5g}", x);
}

// "yeoh: a1 0.012, a2 0.3; hgo: ..." of a part of a config
std::string flat(const Tree& tree) {
  if (tree.kind == Tree::Kind::scalar) return short_number(tree.scalar);
  std::string text;
  for (const Tree& item : tree.list)
    text += (text.empty() ? "" : tree.list[0].kind == Tree::Kind::map ? "; " : ", ") + flat(item);
  for (const auto& [key, value] : tree.map) {
    if (value.kind == Tree::Kind::null) continue;
    const bool deep = value.kind == Tree::Kind::map;
    append(text, ", ", key + (deep ? ": " : " ") + flat(value));
  }
  return text;
}

// "along −y", "along x", "(2, -0.3, 0) mm"
std::string along(const Vec3& u) {
  const double size = u.norm();
  for (int k = 0; k < 3; ++k)
    if (std::abs(std::abs(u[k]) - size) <= 1e-9 * size)
      return fmt::format("along {}{}", u[k] < 0 ? "−" : "", "xyz"[k]);
  return fmt::format("along ({:.3g}, {:.3g}, {:.3g})", u[0] / size, u[1] / size, u[2] / size);
}

std::string size_of(const Mesh& mesh) {
  Vec3 low = mesh.X[0];
  Vec3 high = mesh.X[0];
  for (const Vec3& x : mesh.X) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Vec3 size = high - low;
  if (mesh.section && mesh.section->of == SectionOf::axisymmetric) {
    if (low[0] > 0) {
      return fmt::format("revolution, {:.4g} to {:.4g} mm from its axis and {:.4g} mm high", low[0],
                         high[0], size[1]);
    }
    return fmt::format("revolution, {:.4g} mm in radius and {:.4g} mm high", high[0], size[1]);
  }
  return fmt::format("{:.4g} × {:.4g} × {:.4g} mm", size[0], size[1], size[2]);
}

std::string shape_words(const Tree* rigid) {
  if (!rigid || rigid->map.empty()) return "an indenter";
  const auto& [shape, keys] = rigid->map[0];
  const Tree* radius = keys.find("radius");
  return (shape == "ellipsoid" ? "an " : "a ") + shape +
         (radius ? fmt::format(" of radius {} mm", radius->scalar) : "");
}

struct Reached {
  StepRecord step;  // of the greatest travel of the indenter
  bool last = false;
};

Reached deepest(const SolutionReader& solution) {
  Reached best{solution.step(solution.n_steps() - 1), true};
  for (int i = 0; i + 1 < solution.n_steps(); ++i)
    if (StepRecord step = solution.step(i); step.u_ind.norm() > (1 + 1e-9) * best.step.u_ind.norm())
      best = {std::move(step), false};
  return best;
}

// with its sign: positive where the body resists the travel
double resisting(const StepRecord& step) {
  const double travel = step.u_ind.norm();
  if (travel > 0) return -step.force_ind.dot(step.u_ind) / travel;
  return step.force_ind.norm();
}

std::string with_error(double force, const KnownError& error) {
  if (std::isfinite(error.percent)) {
    return fmt::format("{:.4g}\u00a0N ± {:.2g}\u00a0%", force, error.percent);
  }
  return fmt::format("{:.4g}\u00a0N", force);
}

void tell_contact(Answer& answer, const SolutionReader& solution, const Tree& config) {
  const auto [step, last] = deepest(solution);
  const Tree* contacts = config.find("contacts");
  const Tree* first = contacts && !contacts->map.empty() ? &contacts->map[0].value : nullptr;
  const double force = resisting(step);
  const bool alone = !contacts || contacts->map.size() == 1;
  const KnownError error = last && alone
                               ? known_error(solution.summary(), "force", force)
                               : KnownError{force, std::numeric_limits<double>::quiet_NaN()};
  const bool pushed =
      first && first->find("control") && first->find("control")->kind == Tree::Kind::map;
  std::string who = shape_words(first ? first->find("rigid") : nullptr);
  who[0] = 'A';
  answer.sentence =
      fmt::format("{} {} {:.4g} mm {} into a body of {}{}: {}", who,
                  pushed       ? "pushed by a given force goes"
                  : force >= 0 ? "pressed"
                               : "moved",
                  step.u_ind.norm(), along(step.u_ind), size_of(solution.header().mesh),
                  last ? "" : ", at its greatest travel", with_error(force, error));
  if (!alone) answer.sentence += ", the sum over all indenters";
  if (!contacts) return;
  for (const auto& [name, contact] : contacts->map) {
    const Tree* friction = contact.find("friction");
    answer.facts.push_back(
        {name, fmt::format("{}, {}", shape_words(contact.find("rigid")),
                           friction && friction->scalar != "0" ? "friction " + friction->scalar
                                                               : "without friction")});
  }
}

// of "x_max moved by 6 mm along x"; histories are told by their config
std::string load_words(const Tree& load) {
  std::string text;
  for (const auto& [kind, value] : load.map) {
    if (kind == "on" || value.kind == Tree::Kind::null) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", kind, flat(value));
    if (kind == "pressure") text += " MPa";
    if (kind == "displacement") text += " mm";
    if (kind == "force") text += " N";
  }
  return text;
}

void tell_loads(Answer& answer, const SolutionReader& solution, const Tree& config) {
  const StepRecord last = solution.step(solution.n_steps() - 1);
  const Mesh& mesh = solution.header().mesh;
  std::string done;
  if (const Tree* loads = config.find("loads"))
    for (const Tree& load : loads->list) {
      const Tree* on = load.find("on");
      if (!on) continue;
      done += fmt::format("{}{}: {}", done.empty() ? "" : "; ", on->scalar, load_words(load));
      const auto set = mesh.node_sets.find(on->scalar);
      if (!load.find("displacement") || load.find("displacement")->kind == Tree::Kind::null ||
          set == mesh.node_sets.end())
        continue;
      Vec3 sum = Vec3::Zero();
      for (const int node : set->second) sum += last.reaction[static_cast<std::size_t>(node)];
      answer.facts.push_back({"reaction on " + on->scalar,
                              fmt::format("({:.4g}, {:.4g}, {:.4g}) N", sum[0], sum[1], sum[2])});
    }
  double largest = 0;
  for (const Vec3& u : last.u) largest = std::max(largest, u.norm());
  answer.facts.push_back({"largest displacement", fmt::format("{:.4g} mm", largest)});
  answer.sentence = fmt::format("A body of {}{}{}", size_of(mesh), done.empty() ? "" : "; ", done);
}

}  // namespace

KnownError known_error(const std::vector<Summary>& summary, const std::string& name, double of) {
  const auto value = [&](const std::string& wanted) {
    const auto at = std::find_if(summary.begin(), summary.end(),
                                 [&](const Summary& s) { return s.name == wanted; });
    return at == summary.end() ? std::numeric_limits<double>::quiet_NaN() : at->value;
  };
  // what was found is its limit + cells + increments
  const double found =
      value(name + "_limit") + value(name + "_error_cells") + value(name + "_error_increments");
  const double number = std::isnan(found) ? of : found;
  return {number, 100 * value(name + "_error") / std::abs(number)};
}

Answer answer_of(const SolutionReader& solution, const std::string& label) {
  Answer answer;
  const SolutionHeader& header = solution.header();
  Tree config;
  try {
    config = parse_yaml(header.identity.config, "the solution's config");
  } catch (const Failure&) {  // of a version that wrote it otherwise: what the numbers tell is told
  }
  if (solution.n_steps() == 0) return answer;
  if (header.contact_nodes.empty())
    tell_loads(answer, solution, config);
  else
    tell_contact(answer, solution, config);
  if (!label.empty()) answer.sentence = label + ": " + answer.sentence;
  const std::vector<Material> laws = header.laws();
  for (std::size_t i = 0; i < laws.size(); ++i) {
    std::string of;
    if (laws.size() > 1 && i < header.mesh.bodies.size()) {
      of = " of " + header.mesh.bodies[i];
    }
    for (const auto& [part, value] : to_tree(laws[i]).map)
      if (const std::string text = flat(value); !text.empty())
        answer.facts.push_back({part + of, text});
  }
  if (const Tree* angles = config.find("fibre_angles"); angles && !angles->list.empty())
    answer.facts.push_back({"fibre angles", flat(*angles) + "°"});
  if (const Tree* supports = config.find("supports"))
    for (const Tree& support : supports->list)
      if (support.find("on") && support.find("hold"))
        answer.facts.push_back(
            {"held", support.find("on")->scalar + ": " + flat(*support.find("hold"))});
  answer.facts.push_back(
      {"cells", fmt::format("{} with {} nodes, {}, {} increments", header.mesh.n_cells(),
                            header.mesh.n_nodes(), header.formulation, solution.n_steps())});
  return answer;
}

}  // namespace langer::report

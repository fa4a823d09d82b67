// Composes the sentence at the top of a report, such as "A sphere of radius 2.5 mm pressed 1 mm
// along −y into a body of 30 × 4 × 30 mm: 10.8 N ± 0.4 %", and the facts below it.
#include "report/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "core/base/text.hpp"
#include "core/config/tree.hpp"
#include "core/config/writer.hpp"
#include "scene/run/post_files.hpp"

namespace langer::report {

namespace {

// A number in at most five significant digits. Words and short numbers stay as they are written.
std::string short_number(const std::string& word) {
  double x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (error != std::errc{} || end != word.data() + word.size() || word.size() <= 7) return word;
  return fmt::format("{:.5g}", x);
}

// A part of a config on one line, such as "yeoh: a1 0.012, a2 0.3; hgo: ...". Items of a list of
// maps are separated by semicolons, because commas separate the keys inside of an item.
std::string flat(const Tree& tree) {
  if (tree.kind == Tree::Kind::scalar) return short_number(tree.scalar);
  std::string text;
  std::string_view separator = ", ";
  if (!tree.list.empty() && tree.list[0].kind == Tree::Kind::map) separator = "; ";
  for (const Tree& item : tree.list) append(text, separator, flat(item));
  for (const auto& [key, value] : tree.map) {
    if (value.kind == Tree::Kind::null) continue;
    const bool deep = value.kind == Tree::Kind::map;
    append(text, ", ", key + (deep ? ": " : " ") + flat(value));
  }
  return text;
}

// The direction of a displacement: "along −y", "along x", or "along (0.9, -0.3, 0)" as a unit
// vector where it is not parallel to an axis.
std::string along(const Vec3& u) {
  const double size = u.norm();
  for (int k = 0; k < 3; ++k)
    if (std::abs(std::abs(u[k]) - size) <= 1e-9 * size)
      return fmt::format("along {}{}", u[k] < 0 ? "−" : "", "xyz"[k]);
  return fmt::format("along ({:.3g}, {:.3g}, {:.3g})", u[0] / size, u[1] / size, u[2] / size);
}

// The size of the body's bounding box; of a section, the size of the body of revolution.
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

// The shape of an indenter in words, from the key `rigid` of its contact.
std::string shape_words(const Tree* rigid) {
  if (!rigid || rigid->map.empty()) return "an indenter";
  const auto& [shape, keys] = rigid->map[0];
  std::string text = "a " + shape;
  if (shape == "ellipsoid" || shape == "aperture") text = "an " + shape;
  if (const Tree* radius = keys.find("radius"))
    text += fmt::format(" of radius {} mm", radius->scalar);
  return text;
}

struct Reached {
  StepRecord step;  // of the greatest travel of the indenter
  bool last = false;
};

// The step at which the indenter has travelled furthest. The last step counts unless an earlier
// one is clearly deeper, because the error estimate belongs to the last step.
Reached deepest(const SolutionReader& solution) {
  Reached best{solution.step(solution.n_steps() - 1), true};
  for (int i = 0; i + 1 < solution.n_steps(); ++i)
    if (StepRecord step = solution.step(i); step.u_ind.norm() > (1 + 1e-9) * best.step.u_ind.norm())
      best = {std::move(step), false};
  return best;
}

// The indenter force along its travel [N], positive where the body resists the motion.
double resisting(const StepRecord& step) {
  const double travel = step.u_ind.norm();
  if (travel > 0) return -step.force_ind.dot(step.u_ind / travel);
  return step.force_ind.norm();
}

// A force or torque with its error bar, if an estimate is available.
std::string with_error(double value, const std::string& unit, const KnownError& error) {
  std::string text = rounded(error.share * value, error.percent);
  if (!unit.empty()) text += "\u00a0" + unit;
  if (!std::isfinite(error.percent)) return text;
  return fmt::format("{} ± {:.2g}\u00a0%", text, error.percent);
}

// The verb of an indentation: a force-controlled indenter, one that is pushed back by the body, or
// one that adheres or is withdrawn (the force then acts along the travel).
std::string motion_words(const Tree* contact, double force) {
  const Tree* control = nullptr;
  if (contact) control = contact->find("control");
  if (control && control->kind == Tree::Kind::map) return "under a given force moves";
  if (force >= 0) return "pressed";
  return "moved";
}

// Shape and friction of one indenter.
std::string contact_words(const Tree& contact) {
  const Tree* friction = contact.find("friction");
  std::string text = shape_words(contact.find("rigid")) + ", ";
  if (friction && friction->scalar != "0") return text + "friction " + friction->scalar;
  return text + "without friction";
}

// The shape and friction of all indenters, as facts.
void add_contact_facts(Answer& answer, const Tree* contacts) {
  if (!contacts) return;
  for (const auto& [name, contact] : contacts->map)
    answer.facts.push_back({name, contact_words(contact)});
}

// The nodes on which the load with the largest pressure acts.
std::vector<int> nodes_under_pressure(const Mesh& mesh, const Tree& config) {
  const Tree* loads = config.find("loads");
  if (!loads) return {};
  for (const Tree& load : loads->list) {
    const Tree* on = load.find("on");
    const Tree* pressure = load.find("pressure");
    if (!on || !pressure || pressure->kind == Tree::Kind::null) continue;
    const auto set = mesh.node_sets.find(on->scalar);
    if (set != mesh.node_sets.end()) return set->second;
  }
  return {};
}

// The node in the middle of a surface; of an axisymmetric section that on the axis.
std::optional<std::size_t> apex_of(const Mesh& mesh, const std::vector<int>& nodes) {
  Vec3 middle = Vec3::Zero();
  for (const int node : nodes)
    middle += mesh.X[static_cast<std::size_t>(node)] / static_cast<double>(nodes.size());
  if (mesh.section && mesh.section->of == SectionOf::axisymmetric) middle[0] = 0;
  std::optional<std::size_t> apex;
  for (const int node : nodes) {
    const auto i = static_cast<std::size_t>(node);
    if (!apex || (mesh.X[i] - middle).norm() < (mesh.X[*apex] - middle).norm()) apex = i;
  }
  return apex;
}

// Describes a suction: its pressure, and how far the apex of the dome has come since it began. The
// plate of a probe may have been pressed on before.
void describe_suction(Answer& answer, const SolutionReader& solution, const Tree& config,
                      const std::function<double(double)>& pressure) {
  const Mesh& mesh = solution.header().mesh;
  StepRecord sucked = solution.step(0);  // the last one under the strongest suction
  std::optional<StepRecord> before;      // the last one before it
  bool begun = false;
  for (int i = 0; i < solution.n_steps(); ++i) {
    StepRecord step = solution.step(i);
    const double now = pressure(step.t);
    begun = begun || now < 0;
    if (!begun) {
      before = std::move(step);
    } else if (now <= (1 - 1e-9) * pressure(sucked.t)) {
      sucked = std::move(step);
    }
  }
  std::vector<Vec3> from(sucked.u.size(), Vec3::Zero());
  if (before) from = before->u;
  double height = 0;
  if (const auto apex = apex_of(mesh, nodes_under_pressure(mesh, config)))
    height = (sucked.u[*apex] - from[*apex]).norm();
  const Tree* contacts = config.find("contacts");
  std::string through;
  if (contacts && !contacts->map.empty())
    if (const Tree* rigid = contacts->map[0].value.find("rigid"))
      if (const Tree* aperture = rigid->find("aperture"))
        if (const Tree* radius = aperture->find("radius"))
          through = fmt::format(" through a hole of radius {} mm", radius->scalar);
  const double suction = -pressure(sucked.t);
  answer.sentence = fmt::format(
      "Suction of {:.4g} MPa ({:.4g} mbar){} on a body of {}: the apex rises by {:.3g}\u00a0mm",
      suction, 1e4 * suction, through, size_of(mesh), height);
  if (before) answer.facts.push_back({"apex", "height since the suction began"});
  if (contacts && !contacts->map.empty())
    answer.facts.push_back({"force on the plate", fmt::format("{:.4g} N", resisting(sucked))});
  add_contact_facts(answer, contacts);
}

// The name of what is turned, "disc" of the history torque_disc; empty if nothing is.
std::string turned_name(const StepRecord& step) {
  for (const auto& [name, value] : step.scalars) {
    if (!name.starts_with("torque_") || name.ends_with("_error")) continue;
    if (step.scalars.contains("angle_" + name.substr(7))) return name.substr(7);
  }
  return "";
}

// Describes a twist: the angle and the torque that it takes.
void describe_twist(Answer& answer, const SolutionReader& solution, const Tree& config,
                    const std::string& name) {
  const StepRecord last = solution.step(solution.n_steps() - 1);
  const double torque = last.scalars.at("torque_" + name);
  const KnownError error = known_error(solution.summary(), "torque_" + name, torque);
  answer.sentence = fmt::format("A body of {}, turned by {:.4g}° at {}: torque {}",
                                size_of(solution.header().mesh), last.scalars.at("angle_" + name),
                                name, with_error(torque, "N\u00a0mm", error));
  add_contact_facts(answer, config.find("contacts"));
}

// A result of an impact with its error bar, such as "restitution 0.98 ± 3.2 %"; empty if the path
// ended before the result was known.
std::string impact_words(const std::vector<Summary>& summary, const std::string& name,
                         const std::string& words) {
  const auto found = std::ranges::find(summary, name, &Summary::name);
  if (found == summary.end()) return "";
  const KnownError error = known_error(summary, name, found->value);
  double value = found->value;
  std::string unit = found->unit;
  if (unit == "-") unit = "";
  if (unit == "s") {
    value *= 1000;
    unit = "ms";
  }
  return words + " " + with_error(value, unit, error);
}

// What hits, and what is hit: an indenter with a mass hits the body, or the body hits an indenter
// at rest, or bodies hit each other. Empty for an indenter that is moved.
std::string impact_of(const Mesh& mesh, const Tree& contact) {
  const std::string body = size_of(mesh);
  const Tree* against = contact.find("against");
  if (against && !against->scalar.empty()) return "Bodies within " + body + " that meet";
  const std::string indenter = shape_words(contact.find("rigid"));
  const Tree* free = contact.find("free");
  if (free && free->kind == Tree::Kind::map) {
    const Tree* mass = free->find("mass_g");
    std::string text = indenter + " hits a body of " + body;
    if (mass) text = indenter + " and " + flat(*mass) + " g hits a body of " + body;
    text[0] = 'A';
    return text;
  }
  if (const Tree* motion = contact.find("motion"))
    for (const Tree& point : motion->list)
      if (const Tree* to = point.find("to"))
        for (const Tree& component : to->list)
          if (flat(component) != "0") return "";
  return fmt::format("A body of {} hits {}", body, indenter);
}

// The sentence of an impact, from its results. Empty if the solution is none.
std::string impact_sentence(const SolutionReader& solution, const Tree& config) {
  const Tree* dynamics = config.find("dynamics");
  const Tree* contacts = config.find("contacts");
  if (!dynamics || dynamics->kind != Tree::Kind::map) return "";
  if (!contacts || contacts->map.size() != 1) return "";
  const std::vector<Summary> summary = solution.summary();
  std::string text = impact_of(solution.header().mesh, contacts->map[0].value);
  const std::string force = impact_words(summary, "peak_force", "peak force");
  if (text.empty() || force.empty()) return "";
  text += ": " + force;
  for (const auto& [name, words] :
       {std::pair{"contact_time", "in contact for"}, std::pair{"restitution", "restitution"}}) {
    const std::string result = impact_words(summary, name, words);
    if (!result.empty()) text += ", " + result;
  }
  return text;
}

void describe_impact(Answer& answer, const std::string& sentence, const Tree& config) {
  answer.sentence = sentence;
  add_contact_facts(answer, config.find("contacts"));
}

// Describes an indentation. The error of the force is estimated at the last step and for a single
// indenter, so an error bar is shown only there.
void describe_contact(Answer& answer, const SolutionReader& solution, const Tree& config) {
  const auto [step, last] = deepest(solution);
  const Tree* contacts = config.find("contacts");
  const Tree* first = nullptr;
  if (contacts && !contacts->map.empty()) first = &contacts->map[0].value;
  const Tree* rigid = nullptr;
  if (first) rigid = first->find("rigid");
  const double force = resisting(step);
  const bool alone = !contacts || contacts->map.size() == 1;
  KnownError error{force, std::numeric_limits<double>::quiet_NaN()};
  if (last && alone) error = known_error(solution.summary(), "force", force);
  std::string indenter = shape_words(rigid);
  indenter[0] = 'A';
  std::string moment = ", at its greatest travel";
  if (last) moment = "";
  answer.sentence =
      fmt::format("{} {} {:.4g} mm {} into a body of {}{}: {}", indenter,
                  motion_words(first, force), step.u_ind.norm(), along(step.u_ind),
                  size_of(solution.header().mesh), moment, with_error(force, "N", error));
  if (!alone) answer.sentence += ", the sum over all indenters";
  add_contact_facts(answer, contacts);
}

// A number, or the values of a history one after the other: "0.3 → -0.5". Empty where all are 0.
std::string course_of(const Tree& value) {
  if (value.kind != Tree::Kind::list) return flat(value);
  std::string text, last;
  bool moves = false;
  for (const Tree& point : value.list) {
    const Tree* to = point.find("to");
    if (!to) return flat(value);
    const std::string one = flat(*to);
    moves = moves || one != "0";
    if (one != last) append(text, " → ", one);
    last = one;
  }
  return moves ? text : "";
}

// The same of a load, or of its components: "x 0.3 → -0.5, z 1".
std::string size_of_load(const Tree& value) {
  if (value.kind != Tree::Kind::map) return course_of(value);
  std::string text;
  for (const auto& [axis, component] : value.map) {
    if (component.kind == Tree::Kind::null) continue;
    if (const std::string course = course_of(component); !course.empty())
      append(text, ", ", axis + " " + course);
  }
  return text;
}

// One load in words, as "displacement x 6 mm". Empty where it moves nothing.
std::string load_words(const Tree& load) {
  std::string text;
  for (const auto& [kind, value] : load.map) {
    if (kind == "on" || value.kind == Tree::Kind::null) continue;
    const std::string size = size_of_load(value);
    if (size.empty()) continue;
    append(text, ", ", kind + " " + size);
    if (kind == "pressure" || kind == "traction") text += " MPa";
    if (kind == "displacement") text += " mm";
    if (kind == "force") text += " N";
    if (kind == "volume") text += " mm³";
  }
  return text;
}

// Sum of the reactions of a node set [N].
Vec3 total_reaction(const StepRecord& step, const std::vector<int>& nodes) {
  Vec3 sum = Vec3::Zero();
  for (const int node : nodes) sum += step.reaction[static_cast<std::size_t>(node)];
  for (double& component : sum)  // rounding is no reaction
    if (std::abs(component) < 1e-12 * sum.norm()) component = 0;
  return sum;
}

// Describes a body without an indenter: its loads, the reaction on each moved node set, and its
// largest displacement.
void describe_loads(Answer& answer, const SolutionReader& solution, const Tree& config) {
  const StepRecord last = solution.step(solution.n_steps() - 1);
  const Mesh& mesh = solution.header().mesh;
  std::string done;
  if (const Tree* loads = config.find("loads"))
    for (const Tree& load : loads->list) {
      const Tree* on = load.find("on");
      if (!on) continue;
      if (const std::string words = load_words(load); !words.empty())
        append(done, "; ", on->scalar + ": " + words);
      const auto set = mesh.node_sets.find(on->scalar);
      const Tree* displacement = load.find("displacement");
      if (!displacement || displacement->kind == Tree::Kind::null) continue;
      if (set == mesh.node_sets.end()) continue;
      const Vec3 sum = total_reaction(last, set->second);
      answer.facts.push_back({"reaction on " + on->scalar,
                              fmt::format("({:.4g}, {:.4g}, {:.4g}) N", sum[0], sum[1], sum[2])});
    }
  double largest = 0;
  for (const Vec3& u : last.u) largest = std::max(largest, u.norm());
  answer.facts.push_back({"largest displacement", fmt::format("{:.4g} mm", largest)});
  answer.sentence = "A body of " + size_of(mesh);
  if (!done.empty()) answer.sentence += "; " + done;
}

// Materials, fibre angles, supports and size of the model.
void add_model_facts(Answer& answer, const SolutionReader& solution, const Tree& config) {
  const SolutionHeader& header = solution.header();
  const std::vector<Material> materials = header.laws();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    std::string body;
    if (materials.size() > 1 && i < header.mesh.bodies.size())
      body = " of " + header.mesh.bodies[i];
    for (const auto& [part, value] : to_tree(materials[i]).map)
      if (const std::string text = flat(value); !text.empty())
        answer.facts.push_back({part + body, text});
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
}

}  // namespace

// The numbers of a summary are named force_limit, force_error_cells, ...
KnownError known_error(const std::vector<Summary>& summary, const std::string& name,
                       double fallback) {
  const auto value = [&](const std::string& wanted) {
    const auto at = std::ranges::find(summary, wanted, &Summary::name);
    if (at == summary.end()) return std::numeric_limits<double>::quiet_NaN();
    return at->value;
  };
  // The computed number is the extrapolated limit plus the errors of the mesh and the increments.
  double number =
      value(name + "_limit") + value(name + "_error_cells") + value(name + "_error_increments");
  double share = 1;
  if (const double on_mesh = value(name + "_of_mesh"); !std::isnan(on_mesh)) {
    number = value(name + "_limit");
    const bool at_last_step = std::isnan(value(name + "_judged_at"));
    if (at_last_step) share = number / on_mesh;
  }
  if (std::isnan(number)) number = fallback;
  return {number, 100 * value(name + "_error") / std::abs(number), share};
}

// Two digits of the error if it begins with 1, otherwise one.
std::string rounded(double value, double percent) {
  const double error = 0.01 * percent * std::abs(value);
  if (!std::isgreater(error, 0) || !std::isfinite(error)) return fmt::format("{:.4g}", value);
  const int power = static_cast<int>(std::floor(std::log10(error)));
  const bool begins_with_1 = error < 2 * std::pow(10.0, power);
  int last = power;  // of the last digit shown
  if (begins_with_1) --last;
  // An error larger than the number leaves its first digit; one of rounding, twelve digits.
  const int first = static_cast<int>(std::floor(std::log10(std::abs(value))));
  last = std::clamp(last, first - 5, first);
  const double digit = std::pow(10.0, last);
  return fmt::format("{:.{}f}", std::round(value / digit) * digit, std::max(0, -last));
}

// A solution without contact nodes is described by its loads.
Answer answer_of(const SolutionReader& solution, const std::string& label) {
  Answer answer;
  const SolutionHeader& header = solution.header();
  Tree config;
  try {
    config = parse_yaml(header.identity.config, "the solution's config");
  } catch (const Failure&) {
    // Another version wrote the config in a form that this one cannot read. The sentence then
    // contains only what the results themselves show.
  }
  if (solution.n_steps() == 0) return answer;
  const StepRecord last = solution.step(solution.n_steps() - 1);
  const std::function<double(double)> pressure = applied_pressure(header);
  // A history has few corners: a hundred places find a suction without reading the steps.
  bool sucked = false;
  for (int k = 1; k <= 100; ++k) sucked = sucked || pressure(0.01 * k) < 0;
  if (sucked)
    describe_suction(answer, solution, config, pressure);
  else if (const std::string turned = turned_name(last); !turned.empty())
    describe_twist(answer, solution, config, turned);
  else if (const std::string impact = impact_sentence(solution, config); !impact.empty())
    describe_impact(answer, impact, config);
  else if (header.contact_nodes.empty())
    describe_loads(answer, solution, config);
  else
    describe_contact(answer, solution, config);
  if (!label.empty()) answer.sentence = label + ": " + answer.sentence;
  add_model_facts(answer, solution, config);
  return answer;
}

}  // namespace langer::report

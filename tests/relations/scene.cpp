#include "relations/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "relations/mesh_text.hpp"

namespace langer::relations {

bool Scene::viscous() const {
  return std::any_of(body.layers.begin(), body.layers.end(),
                     [](const Layer& layer) { return !layer.law.viscous.empty(); });
}

bool Scene::frictionless() const {
  return std::all_of(contacts.begin(), contacts.end(),
                     [](const Contact& contact) { return contact.friction == 0; });
}

bool Scene::adheres() const {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const Contact& contact) { return contact.bonds.has_value(); });
}

namespace {

constexpr const char* axis_names = "xyz";

History scaled(History history, double factor) {
  for (HistoryPoint& point : history) {
    point.value *= factor;
  }
  return history;
}

Term scaled(Term term, double stress) {
  for (Parameter& parameter : term.parameters) {
    parameter.value *= std::pow(stress, parameter.stress_power);
  }
  return term;
}

// the box that holds the image of a box
BoxSet mapped(const BoxSet& box, const Change& change) {
  const Vec3 a = change.length * (change.Q * box.from);
  const Vec3 b = change.length * (change.Q * box.to);
  return {box.name, a.cwiseMin(b), a.cwiseMax(b)};
}

// angle of the image of the direction at `alpha`, which has to stay in the plane of x and z
double mapped_angle(double alpha, const Mat3& Q) {
  const double radians = alpha * std::numbers::pi / 180;
  const Vec3 image = Q * Vec3(std::cos(radians), 0, std::sin(radians));
  return std::atan2(image[2], image[0]) * 180 / std::numbers::pi;
}

Law mapped(Law law, const Change& change, bool turn_fibres) {
  law.matrix = scaled(law.matrix, change.stress);
  law.volume = scaled(law.volume, change.stress);
  for (FibreFamily& family : law.fibres) {
    family.law = scaled(family.law, change.stress);
    if (turn_fibres) {
      family.alpha = mapped_angle(family.alpha, change.Q);
    }
  }
  return law;
}

Body mapped(Body body, const Change& change) {
  // The tetrahedra of a block that is laid out along other axes would not be the images of the
  // first ones, so a mesh of theirs is turned as it is.
  const bool in_file = body.from_file || !permutes_axes(change.Q);
  const bool frames_turn = in_file && body.along_edges;
  for (Layer& layer : body.layers) {
    layer.law = mapped(layer.law, change, !frames_turn);
    layer.thickness *= change.length;
  }
  // what a file holds is turned when it is written
  const Change of_boxes{in_file ? Mat3(Mat3::Identity()) : change.Q, change.length, 1};
  const BoxSet spans = mapped({"", body.origin, body.origin + body.size}, of_boxes);
  const Eigen::Vector3d divisions(body.divisions[0], body.divisions[1], body.divisions[2]);
  const Eigen::Vector3d mapped_divisions = of_boxes.Q.cwiseAbs() * divisions;
  for (int axis = 0; axis < 3; ++axis) {
    body.divisions[axis] = static_cast<int>(std::lround(mapped_divisions[axis]));
  }
  body.origin = spans.from;
  body.size = spans.to - spans.from;
  for (BoxSet& set : body.sets) {
    set = mapped(set, of_boxes);
  }
  if (body.cut) {
    body.cut = mapped(*body.cut, of_boxes);
  }
  if (in_file) {
    body.from_file = true;
    body.turn = change.Q * body.turn;
  }
  return body;
}

// Components of Q h. Where Q has more than one number in a row, all components are given at the
// same times.
std::array<std::optional<History>, 3> mapped(const std::array<std::optional<History>, 3>& along,
                                             const Mat3& Q, double factor) {
  std::array<std::optional<History>, 3> image;
  for (int to = 0; to < 3; ++to) {
    for (int from = 0; from < 3; ++from) {
      if (Q(to, from) == 0 || !along[from]) {
        continue;
      }
      const History part = scaled(*along[from], factor * Q(to, from));
      if (!image[to]) {
        image[to] = part;
        continue;
      }
      for (std::size_t i = 0; i < part.size(); ++i) {
        (*image[to])[i].value += part[i].value;
      }
    }
  }
  return image;
}

Load mapped(Load load, const Change& change) {
  const double L = change.length;
  const double S = change.stress;
  switch (load.kind) {
    case LoadKind::displacement:
      load.along = mapped(load.along, change.Q, L);
      break;
    case LoadKind::force:
      load.along = mapped(load.along, change.Q, S * L * L);
      break;
    case LoadKind::traction:
      load.along = mapped(load.along, change.Q, S);
      break;
    case LoadKind::pressure:
      load.history = scaled(load.history, S);
      break;
    case LoadKind::rotation:
      // an axis of rotation is an axial vector: a mirror turns it around
      load.axis = change.Q.determinant() * (change.Q * load.axis);
      load.through = L * (change.Q * load.through);
      break;
  }
  return load;
}

Contact mapped(Contact contact, const Change& change) {
  const double L = change.length;
  const double S = change.stress;
  const Mat3& Q = change.Q;
  if (contact.rotation) {
    // the angle counts by the right hand about the axis: a sphere's is always y
    double sense = Q.determinant();
    if (contact.shape == ShapeKind::sphere) {
      sense *= Q(1, 1);
    }
    contact.rotation = scaled(*contact.rotation, sense);
  }
  contact.place = L * (Q * contact.place);
  contact.axis = Q * contact.axis;
  contact.radius *= L;
  contact.edge *= L;
  contact.half_axes = L * (Q.cwiseAbs() * contact.half_axes);
  for (Waypoint& point : contact.motion) {
    point.to = L * (Q * point.to);
  }
  if (contact.push) {
    contact.push->force = scaled(contact.push->force, S * L * L);
    contact.push->along = Q * contact.push->along;
  }
  if (contact.bonds) {
    contact.bonds->work *= S * L;
    contact.bonds->stiffness *= S / L;
    contact.bonds->tangential *= S / L;
    contact.bonds->viscosity *= S * L;
  }
  return contact;
}

std::string text(const History& history) {
  std::vector<std::string> points;
  for (const HistoryPoint& point : history) {
    points.push_back(fmt::format("{{t: {:.17g}, to: {:.17g}}}", point.t, point.value));
  }
  return fmt::format("[{}]", fmt::join(points, ", "));
}

std::string text(const Term& term) {
  std::vector<std::string> parameters;
  for (const Parameter& parameter : term.parameters) {
    parameters.push_back(fmt::format("{}: {:.17g}", parameter.key, parameter.value));
  }
  return fmt::format("{}: {{{}}}", term.key, fmt::join(parameters, ", "));
}

std::string text(const Law& law) {
  std::string all =
      fmt::format("matrix: {{{}}}, volume: {{{}}}", text(law.matrix), text(law.volume));
  std::vector<std::string> families;
  for (const FibreFamily& family : law.fibres) {
    families.push_back(fmt::format("{{{}, alpha: {:.17g}, kappa: {:.17g}}}", text(family.law),
                                   family.alpha, family.kappa));
  }
  if (!families.empty()) {
    all += fmt::format(", fibres: [{}]", fmt::join(families, ", "));
  }
  std::vector<std::string> branches;
  for (const Branch& branch : law.viscous) {
    branches.push_back(fmt::format("{{tau: {:.17g}, gamma: {:.17g}}}", branch.tau, branch.gamma));
  }
  if (!branches.empty()) {
    all += fmt::format(", viscous: [{}]", fmt::join(branches, ", "));
  }
  return "{" + all + "}";
}

std::string text(const Support& support) {
  std::vector<std::string> axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (support.hold[axis]) {
      axes.emplace_back(1, axis_names[axis]);
    }
  }
  return fmt::format("  - {{on: {}, hold: [{}]}}\n", support.on, fmt::join(axes, ", "));
}

std::string text(const Load& load) {
  const std::string on = fmt::format("  - {{on: {}, ", load.on);
  if (load.kind == LoadKind::pressure) {
    return on + fmt::format("pressure: {}}}\n", text(load.history));
  }
  if (load.kind == LoadKind::rotation) {
    return on + fmt::format("rotation: {{angle: {}, axis: {}, through: {}}}}}\n",
                            text(load.history), vector_text(load.axis), vector_text(load.through));
  }
  std::vector<std::string> components;
  for (int axis = 0; axis < 3; ++axis) {
    if (load.along[axis]) {
      components.push_back(fmt::format("{}: {}", axis_names[axis], text(*load.along[axis])));
    }
  }
  const char* kind = "displacement";
  if (load.kind == LoadKind::force) {
    kind = "force";
  }
  if (load.kind == LoadKind::traction) {
    kind = "traction";
  }
  return on + fmt::format("{}: {{{}}}}}\n", kind, fmt::join(components, ", "));
}

std::string shape_text(const Contact& contact) {
  const std::string place = vector_text(contact.place);
  const std::string axis = vector_text(contact.axis);
  switch (contact.shape) {
    case ShapeKind::sphere:
      return fmt::format("sphere: {{radius: {:.17g}, centre: {}}}", contact.radius, place);
    case ShapeKind::plane:
      return fmt::format("plane: {{point: {}, normal: {}}}", place, axis);
    case ShapeKind::cylinder:
      return fmt::format("cylinder: {{radius: {:.17g}, edge: {:.17g}, face: {}, axis: {}}}",
                         contact.radius, contact.edge, place, axis);
    case ShapeKind::aperture:
      return fmt::format("aperture: {{radius: {:.17g}, edge: {:.17g}, face: {}, axis: {}}}",
                         contact.radius, contact.edge, place, axis);
    case ShapeKind::ellipsoid:
      break;
  }
  return fmt::format("ellipsoid: {{half_axes: {}, centre: {}}}", vector_text(contact.half_axes),
                     place);
}

std::string text(const Contact& contact) {
  std::string all = fmt::format("  {}:\n", contact.name);
  if (!contact.on.empty()) {
    all += fmt::format("    on: {}\n", contact.on);
  }
  all += fmt::format("    rigid: {{{}}}\n    friction: {:.17g}\n", shape_text(contact),
                     contact.friction);
  std::vector<std::string> motion;
  for (const Waypoint& point : contact.motion) {
    motion.push_back(fmt::format("{{t: {:.17g}, to: {}}}", point.t, vector_text(point.to)));
  }
  if (!motion.empty()) {
    all += fmt::format("    motion: [{}]\n", fmt::join(motion, ", "));
  }
  if (contact.push) {
    all += fmt::format("    control: {{force: {}, along: {}}}\n", text(contact.push->force),
                       vector_text(contact.push->along));
  }
  if (contact.rotation) {
    all += fmt::format("    rotation: {}\n", text(*contact.rotation));
  }
  if (contact.bonds) {
    const Bonds& bonds = *contact.bonds;
    all += fmt::format(
        "    adhesion: {{work: {:.17g}, stiffness: {:.17g}, tangential: {:.17g}, "
        "viscosity: {:.17g}, healing: {}}}\n",
        bonds.work, bonds.stiffness, bonds.tangential, bonds.viscosity, bonds.healing);
  }
  return all;
}

}  // namespace

bool permutes_axes(const Mat3& Q) {
  const Mat3 whole_numbers = Q.array().round();
  return Q == whole_numbers;
}

Scene changed(const Scene& scene, const Change& change) {
  Scene image = scene;
  image.body = mapped(scene.body, change);
  for (Support& support : image.supports) {
    const std::array<bool, 3> hold = support.hold;
    support.hold = {false, false, false};
    for (int to = 0; to < 3; ++to) {
      for (int from = 0; from < 3; ++from) {
        support.hold[to] = support.hold[to] || (hold[from] && change.Q(to, from) != 0);
      }
    }
  }
  for (Load& load : image.loads) {
    load = mapped(load, change);
  }
  for (Contact& contact : image.contacts) {
    contact = mapped(contact, change);
  }
  image.absolute *= change.stress * change.length * change.length;
  return image;
}

std::filesystem::path write_scene(const Scene& scene, const std::filesystem::path& folder,
                                  const std::string& name) {
  const Body& body = scene.body;
  std::string yaml;
  if (body.from_file) {
    std::ofstream(folder / (name + ".inp")) << inp_text(body);
    yaml += fmt::format("mesh:\n  geometry: {{file: {{path: {}.inp}}}}\n", name);
    yaml += fmt::format("  cells: {}\n", body.cells);
  } else {
    yaml += mesh_yaml(body);
  }
  if (body.along_edges) {
    yaml += "  frames: element_edges\n";
  }
  if (body.layers.size() == 1) {
    yaml += fmt::format("material: {}\n", text(body.layers[0].law));
  } else {
    yaml += "materials:\n";
    for (const Layer& layer : body.layers) {
      yaml += fmt::format("  {}: {{material: {}}}\n", layer.name, text(layer.law));
    }
  }
  if (!scene.formulation.empty()) {
    yaml += fmt::format("formulation: {}\n", scene.formulation);
  }
  yaml += "supports:\n";
  for (const Support& support : scene.supports) {
    yaml += text(support);
  }
  if (!scene.loads.empty()) {
    yaml += "loads:\n";
    for (const Load& load : scene.loads) {
      yaml += text(load);
    }
  }
  if (!scene.contacts.empty()) {
    yaml += "contacts:\n";
    for (const Contact& contact : scene.contacts) {
      yaml += text(contact);
    }
  }
  std::string path;
  if (scene.equal_steps) {
    path = fmt::format("steps: {}", scene.increments);
  } else {
    path = fmt::format("first: {0:.17g}, largest: {0:.17g}", 1.0 / scene.increments);
  }
  if (scene.seconds) {
    path += fmt::format(", seconds: {:.17g}", *scene.seconds);
  }
  yaml += fmt::format("path: {{{}}}\n", path);
  // Twins agree as closely as both are converged: far below the tolerance of the comparison.
  yaml += fmt::format("solver: {{{}: {{relative: 1.0e-12, absolute: {:.17g}}}}}\n", scene.solver,
                      scene.absolute);
  if (scene.whole) {
    yaml += "symmetry: none\nreduce: none\nhomogeneous: off\n";
  }
  yaml += "estimate: none\nstability: off\n";
  const std::filesystem::path file = folder / (name + ".yaml");
  std::ofstream(file) << yaml;
  return file;
}

}  // namespace langer::relations

#include "relations/draw.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace langer::relations {

namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  // three digits, so that the YAML of a scene can be read
  double uniform(double low, double high) {
    const double share = std::generate_canonical<double, 53>(random_);
    return std::stod(fmt::format("{:.3g}", low + (high - low) * share));
  }
  bool coin(double chance = 0.5) { return std::generate_canonical<double, 53>(random_) < chance; }
  int below(int n) {
    const double share = std::generate_canonical<double, 53>(random_);
    return std::min(n - 1, static_cast<int>(share * n));
  }
  double sign() { return coin() ? 1 : -1; }

 private:
  std::mt19937_64 random_;
};

// Laws

Term drawn_matrix(Draw& draw, double a1) {
  switch (draw.below(6)) {
    case 0:
      return {"neo_hooke", {{"a1", a1, 1}}};
    case 1:
      return {"yeoh", {{"a1", a1, 1}, {"a2", 0.5 * a1, 1}, {"a3", 0.2 * a1, 1}}};
    case 2:
      return {"gent", {{"mu", 2 * a1, 1}, {"Jm", draw.uniform(8, 30), 0}}};
    case 3:
      return {"ogden", {{"mu1", a1, 1}, {"alpha1", draw.uniform(2, 5), 0}}};
    case 4:
      return {"mooney_rivlin", {{"c10", 0.7 * a1, 1}, {"c01", 0.3 * a1, 1}}};
    default:
      break;
  }
  return {"arruda_boyce", {{"mu", 2 * a1, 1}, {"locking_stretch", draw.uniform(2, 4), 0}}};
}

Term drawn_volume(Draw& draw, double a1) {
  // bulk modulus over shear modulus
  const double ratio = draw.uniform(10, 500);
  const double bulk = 2 * a1 * ratio;
  switch (draw.below(3)) {
    case 0:
      return {"quadratic", {{"d", 2 / bulk, -1}}};
    case 1:
      return {"logarithmic", {{"bulk_modulus", bulk, 1}}};
    default:
      break;
  }
  return {"simo_taylor", {{"bulk_modulus", bulk, 1}}};
}

FibreFamily drawn_family(Draw& draw, double a1) {
  FibreFamily family;
  const double modulus = a1 * draw.uniform(0.2, 2);
  if (draw.coin()) {
    family.law = {"hgo", {{"c1", modulus, 1}, {"c2", draw.uniform(0.2, 2), 0}}};
  } else {
    family.law = {"exp_pow",
                  {{"ksi", modulus, 1}, {"alpha", draw.uniform(0.2, 1), 0}, {"beta", 2, 0}}};
  }
  const std::array<double, 4> symmetric{0, 90, 0, 90};
  family.alpha = draw.coin() ? symmetric[draw.below(4)] : draw.uniform(-90, 90);
  family.kappa = draw.coin() ? 0 : draw.uniform(0.02, 0.3);
  return family;
}

Law drawn_law(Draw& draw, double a1, bool isotropic, bool viscous) {
  Law law;
  law.matrix = drawn_matrix(draw, a1);
  law.volume = drawn_volume(draw, a1);
  const int families = isotropic ? 0 : draw.below(3);
  for (int i = 0; i < families; ++i) {
    law.fibres.push_back(drawn_family(draw, a1));
  }
  if (viscous) {
    law.viscous.push_back({draw.uniform(0.05, 0.5), draw.uniform(0.1, 0.4)});
    if (draw.coin()) {
      law.viscous.push_back({draw.uniform(1, 5), draw.uniform(0.1, 0.4)});
    }
  }
  return law;
}

// Bodies

constexpr double a1_typical = 0.02;  // [MPa]

// the nodes of one side of the body, in a box as thin as rounding allows
BoxSet side(const Body& body, const std::string& name, int axis, bool upper) {
  const double margin = 1e-6 * body.size.maxCoeff();
  BoxSet set{name, body.origin, body.origin + body.size};
  if (upper) {
    set.from[axis] = set.to[axis];
  } else {
    set.to[axis] = set.from[axis];
  }
  set.from.array() -= margin;
  set.to.array() += margin;
  return set;
}

void name_sets(Body& body) {
  body.sets = {side(body, "left", 0, false), side(body, "right", 0, true),
               side(body, "low", 1, false), side(body, "high", 1, true)};
  if (body.kind == BodyKind::block) {
    body.sets.push_back(side(body, "back", 2, false));
    body.sets.push_back(side(body, "front", 2, true));
  } else {
    // a section is thin along z: its sets hold all of its thickness
    for (BoxSet& set : body.sets) {
      set.from[2] = -1e3;
      set.to[2] = 1e3;
    }
  }
}

// Nodes of the top not farther from its middle than a quarter of its sides. Grid lines of four
// cells go there; a block of two hex27 has to have more.
void add_patch(Body& body, const std::string& name) {
  if (body.cells == "hex27") {
    body.divisions = {4, body.divisions[1], 4};
  }
  BoxSet set = side(body, name, 1, true);
  const Vec3 middle = body.origin + 0.5 * body.size;
  const double margin = 1e-6 * body.size.maxCoeff();
  for (const int axis : {0, 2}) {
    const double half = 0.25 * body.size[axis] + margin;
    set.from[axis] = middle[axis] - half;
    set.to[axis] = middle[axis] + half;
  }
  body.sets.push_back(set);
}

Body drawn_block(Draw& draw) {
  Body body;
  body.size = Vec3(draw.uniform(3, 5), draw.uniform(1.5, 2.5), draw.uniform(3, 5));
  if (draw.coin()) {
    body.size[2] = body.size[0];
  }
  body.origin = Vec3(-0.5 * body.size[0], 0, -0.5 * body.size[2]);
  if (draw.coin(0.2)) {
    body.cells = "hex27";
    body.divisions = {2, 1 + draw.below(2), 2};
  } else {
    body.divisions = {4, 2, 4};
  }
  name_sets(body);
  return body;
}

Body drawn_section(Draw& draw, BodyKind kind) {
  Body body;
  body.kind = kind;
  body.size = Vec3(draw.uniform(3, 5), draw.uniform(1.5, 2.5), draw.uniform(0.5, 2));
  body.divisions = {8, 4, 1};
  if (kind == BodyKind::plane_strain) {
    body.origin[0] = -0.5 * body.size[0];
  }
  if (draw.coin(0.2)) {
    body.cells = "hex27";
    body.divisions = {4, 2, 1};
  }
  name_sets(body);
  return body;
}

void add_laws(Draw& draw, Scene& scene, bool isotropic, double chance_of_viscous = 0.3) {
  const bool viscous = draw.coin(chance_of_viscous);
  Body& body = scene.body;
  const bool layered = body.cells != "tet15" && body.divisions[1] > 1 && draw.coin(0.3);
  if (layered) {
    // half the cells each, so that the border between them is a grid line
    const double thickness = 0.5 * body.size[1];
    const double contrast = draw.uniform(0.3, 3);
    body.layers = {
        {"below", thickness, drawn_law(draw, a1_typical * contrast, isotropic, viscous)},
        {"above", body.size[1] - thickness, drawn_law(draw, a1_typical, isotropic, viscous)}};
  } else {
    body.layers = {{"skin", body.size[1], drawn_law(draw, a1_typical, isotropic, viscous)}};
  }
  if (viscous) {
    scene.seconds = draw.uniform(0.5, 5);
  }
  scene.equal_steps = viscous || draw.coin(0.3);
  if (draw.coin(0.15) && body.cells == "hex8") {
    scene.formulation = "displacement";
  }
}

void hold_bottom(Draw& draw, Scene& scene) {
  Support support{"low"};
  if (scene.body.kind != BodyKind::block) {
    support.hold[2] = false;
  }
  scene.supports = {support};
  // a second support on a side, which holds it along its normal
  if (scene.body.kind == BodyKind::block && draw.coin(0.2)) {
    scene.supports.push_back({"back", {false, false, true}});
  }
}

// to `value` at the end; sometimes it gets there earlier and stays, or comes back
History drawn_history(Draw& draw, double value) {
  switch (draw.below(4)) {
    case 0:
      return {{0.5, value}, {1, value}};
    case 1:
      return {{0.5, value}, {1, 0.4 * value}};
    default:
      break;
  }
  return {{1, value}};
}

// A block of one or several materials that is held at its bottom; nothing loads it yet.
Scene block_on_its_bottom(Draw& draw) {
  Scene scene;
  scene.body = drawn_block(draw);
  add_laws(draw, scene, false);
  hold_bottom(draw, scene);
  return scene;
}

// Loads

Scene pulled(Draw& draw) {
  Scene scene;
  scene.body = drawn_block(draw);
  add_laws(draw, scene, false);
  scene.supports = {{"left"}};
  Load load{"right"};
  const bool straight = draw.coin();
  const double u = draw.uniform(0.1, 0.4);
  load.along[0] = History{{0.5, 0.6 * u}, {1, u}};
  load.along[1] = History{{0.5, 0}, {1, straight ? 0 : draw.uniform(-0.2, 0.2)}};
  load.along[2] = History{{0.5, 0}, {1, straight ? 0 : draw.uniform(-0.2, 0.2)}};
  scene.loads = {load};
  return scene;
}

Scene loaded_by_force(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  add_patch(scene.body, "patch");
  const std::array<std::string, 4> where{"high", "patch", "right", "left"};
  const int n = 1 + draw.below(2);
  for (int i = 0; i < n; ++i) {
    Load load{where[draw.below(4)]};
    const bool traction = draw.coin();
    load.kind = traction ? LoadKind::traction : LoadKind::force;
    const double size = traction ? 0.1 * a1_typical : 0.4 * a1_typical;
    const History history = drawn_history(draw, size);
    for (int axis = 0; axis < 3; ++axis) {
      const double share = draw.uniform(-1, 1);
      load.along[axis] = history;
      for (HistoryPoint& point : *load.along[axis]) {
        point.value *= share;
      }
    }
    scene.loads.push_back(load);
  }
  return scene;
}

Scene under_pressure(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  add_patch(scene.body, "patch");
  const std::array<std::string, 3> where{"high", "patch", "right"};
  Load load{where[draw.below(3)], LoadKind::pressure};
  // negative: suction
  load.history = drawn_history(draw, draw.sign() * draw.uniform(0.1, 0.5) * a1_typical);
  scene.loads = {load};
  if (draw.coin(0.3)) {
    Load opposite{"left", LoadKind::pressure};
    opposite.history = drawn_history(draw, draw.uniform(0.1, 0.3) * a1_typical);
    scene.loads.push_back(opposite);
  }
  return scene;
}

Scene twisted(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  add_patch(scene.body, "disc");
  // nodes that a side holds cannot turn
  const bool all = scene.supports.size() == 1 && draw.coin();
  Load load{all ? "high" : "disc", LoadKind::rotation};
  load.history = drawn_history(draw, draw.sign() * draw.uniform(5, 25));
  load.through = Vec3(0, scene.body.size[1], 0);
  scene.loads = {load};
  return scene;
}

// Contacts

Contact drawn_sphere(Draw& draw, const Body& body, double x, double z) {
  Contact contact{"sphere"};
  contact.radius = draw.uniform(1.5, 4);
  contact.place = Vec3(x, body.size[1] + contact.radius, z);
  return contact;
}

double drawn_depth(Draw& draw, const Body& body) { return draw.uniform(0.08, 0.2) * body.size[1]; }

Scene indented(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  const bool centred = draw.coin();
  const double x = centred ? 0 : draw.uniform(-0.5, 0.5);
  const double z = centred ? 0 : draw.uniform(-0.5, 0.5);
  Contact contact = drawn_sphere(draw, scene.body, x, z);
  contact.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.8);
  const double depth = drawn_depth(draw, scene.body);
  contact.motion = {{1, Vec3(0, -depth, 0)}};
  if (draw.coin(0.4)) {
    // pressed, then drawn aside
    contact.motion = {{0.5, Vec3(0, -depth, 0)},
                      {1, Vec3(draw.uniform(-0.2, 0.2), -depth, draw.uniform(-0.2, 0.2))}};
  }
  if (draw.coin()) {
    contact.on = "high";
  }
  scene.contacts = {contact};
  if (scene.body.cells == "hex8" && scene.body.layers.size() == 1 && draw.coin(0.3)) {
    const Vec3 half = 0.3 * scene.body.size;
    scene.body.cut = BoxSet{"", Vec3(-half[0], 0.6 * scene.body.size[1], -half[2]),
                            Vec3(half[0], scene.body.size[1], half[2])};
  }
  return scene;
}

Scene several_indenters(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  const double apart = 0.25 * scene.body.size[0];
  const bool alike = draw.coin();
  const double depth = drawn_depth(draw, scene.body);
  Contact first = drawn_sphere(draw, scene.body, -apart, 0);
  first.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.8);
  first.motion = {{1, Vec3(0, -depth, 0)}};
  Contact second = first;
  second.name = "second";
  second.place[0] = apart;
  if (!alike) {
    second.motion = {{1, Vec3(0, -0.7 * depth, 0)}};
    second.friction = 0.2;
  }
  scene.contacts = {first, second};
  return scene;
}

Scene other_shape(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  Contact contact{"tool", "high"};
  contact.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.8);
  const double depth = 0.7 * drawn_depth(draw, scene.body);
  contact.motion = {{1, Vec3(0, -depth, 0)}};
  contact.place = Vec3(0, scene.body.size[1], 0);
  switch (draw.below(3)) {
    case 0:
      contact.shape = ShapeKind::plane;
      contact.axis = -Vec3::UnitY();
      break;
    case 1:
      contact.shape = ShapeKind::cylinder;
      contact.radius = 0.35 * scene.body.size[0];
      contact.edge = 0.4 * contact.radius;
      break;
    default:
      contact.shape = ShapeKind::ellipsoid;
      contact.half_axes = Vec3(draw.uniform(1.5, 3), draw.uniform(1.5, 3), draw.uniform(1.5, 3));
      contact.place[1] += contact.half_axes[1];
      break;
  }
  scene.contacts = {contact};
  return scene;
}

Scene pushed(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  Contact contact = drawn_sphere(draw, scene.body, draw.coin() ? 0 : 0.3, 0);
  contact.on = "high";
  contact.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.8);
  Push push;
  push.force = drawn_history(draw, draw.uniform(2, 6) * a1_typical);
  contact.push = push;
  if (draw.coin(0.3) && contact.friction > 0) {
    contact.motion = {{0.5, Vec3::Zero()}, {1, Vec3(draw.uniform(-0.1, 0.1), 0, 0)}};
  }
  scene.contacts = {contact};
  return scene;
}

Scene turned_indenter(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  Contact contact = drawn_sphere(draw, scene.body, 0, 0);
  contact.on = "high";
  contact.friction = draw.uniform(0.1, 0.8);
  const double depth = drawn_depth(draw, scene.body);
  contact.motion = {{0.5, Vec3(0, -depth, 0)}, {1, Vec3(0, -depth, 0)}};
  contact.rotation = History{{0.5, 0}, {1, draw.sign() * draw.uniform(5, 40)}};
  if (draw.coin()) {
    contact.shape = ShapeKind::cylinder;
    contact.place[1] = scene.body.size[1];
    contact.radius = 0.35 * scene.body.size[0];
    contact.edge = 0.4 * contact.radius;
  }
  scene.contacts = {contact};
  return scene;
}

Scene adhesive(Draw& draw) {
  Scene scene = block_on_its_bottom(draw);
  Contact contact = drawn_sphere(draw, scene.body, 0, 0);
  contact.on = "high";
  contact.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.5);
  Bonds bonds;
  bonds.work = draw.uniform(2e-4, 8e-4);
  bonds.stiffness = draw.uniform(0.02, 0.1);
  bonds.tangential = draw.coin() ? 0 : draw.uniform(0.01, 0.1);
  bonds.healing = draw.coin();
  if (draw.coin()) {
    bonds.viscosity = draw.uniform(1e-4, 1e-3);
    if (!scene.seconds) {
      scene.seconds = draw.uniform(0.5, 5);
    }
  }
  contact.bonds = bonds;
  const double depth = 0.6 * drawn_depth(draw, scene.body);
  contact.motion = {{0.5, Vec3(0, -depth, 0)}, {1, Vec3(0, 0.3 * depth, 0)}};
  scene.contacts = {contact};
  scene.increments = 8;
  return scene;
}

Scene indented_section(Draw& draw) {
  Scene scene;
  const bool round = draw.coin(0.7);
  scene.body = drawn_section(draw, round ? BodyKind::axisymmetric : BodyKind::plane_strain);
  add_laws(draw, scene, true);
  hold_bottom(draw, scene);
  Contact contact{"tool", "high"};
  contact.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.8);
  const double depth = drawn_depth(draw, scene.body);
  contact.motion = {{1, Vec3(0, -depth, 0)}};
  contact.place = Vec3(0, scene.body.size[1], 0);
  if (round) {
    contact.radius = draw.uniform(1.5, 4);
    contact.place[1] += contact.radius;
  } else {
    contact.shape = ShapeKind::plane;
    contact.axis = -Vec3::UnitY();
  }
  scene.contacts = {contact};
  return scene;
}

Scene sucked_section(Draw& draw) {
  Scene scene;
  scene.body = drawn_section(draw, BodyKind::axisymmetric);
  add_laws(draw, scene, true);
  hold_bottom(draw, scene);
  const Body& body = scene.body;
  const double hole = 0.25 * body.size[0];
  BoxSet set = side(body, "hole", 1, true);
  set.to[0] = hole * (1 + 1e-6);
  set.from[2] = -1e3;
  set.to[2] = 1e3;
  scene.body.sets.push_back(set);
  Contact plate{"plate", "high", ShapeKind::aperture};
  plate.radius = hole;
  plate.edge = 0.5 * hole;
  plate.place = Vec3(0, body.size[1], 0);
  plate.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.8);
  const double depth = 0.02 * body.size[1];
  plate.motion = {{0.25, Vec3(0, -depth, 0)}, {1, Vec3(0, -depth, 0)}};
  scene.contacts = {plate};
  Load load{"hole", LoadKind::pressure};
  load.history = {{0.25, 0}, {1, -draw.uniform(0.1, 0.5) * a1_typical}};
  scene.loads = {load};
  return scene;
}

Scene of_tetrahedra(Draw& draw) {
  Scene scene;
  const bool pressed = draw.coin();
  scene.body = drawn_block(draw);
  scene.body.cells = "tet15";
  scene.body.divisions = {2, 1, 2};
  scene.body.from_file = true;
  add_laws(draw, scene, draw.coin());
  hold_bottom(draw, scene);
  if (pressed) {
    Contact contact = drawn_sphere(draw, scene.body, 0.1, -0.2);
    contact.on = "high";
    contact.friction = draw.coin() ? 0 : draw.uniform(0.05, 0.8);
    contact.motion = {{1, Vec3(0, -drawn_depth(draw, scene.body), 0)}};
    scene.contacts = {contact};
  } else {
    Load load{"high", LoadKind::pressure};
    load.history = drawn_history(draw, draw.sign() * draw.uniform(0.1, 0.4) * a1_typical);
    scene.loads = {load};
  }
  return scene;
}

struct Kind {
  const char* name;
  Scene (*make)(Draw& draw);
};
constexpr std::array kinds{Kind{"pulled", pulled},
                           Kind{"force", loaded_by_force},
                           Kind{"pressure", under_pressure},
                           Kind{"twisted", twisted},
                           Kind{"indented", indented},
                           Kind{"several", several_indenters},
                           Kind{"shape", other_shape},
                           Kind{"pushed", pushed},
                           Kind{"turned", turned_indenter},
                           Kind{"adhesive", adhesive},
                           Kind{"section", indented_section},
                           Kind{"suction", sucked_section},
                           Kind{"tetrahedra", of_tetrahedra}};

}  // namespace

DrawnScene drawn_scene(std::uint64_t seed, int number) {
  const Kind& kind = kinds[static_cast<std::size_t>(number) % kinds.size()];
  Draw draw(seed * 1000003 + static_cast<std::uint64_t>(number));
  DrawnScene drawn;
  drawn.name = fmt::format("{}_{}", number, kind.name);
  drawn.scene = kind.make(draw);
  Body& body = drawn.scene.body;
  // measured in the frames of the cells, fibres turn with a mesh from a file
  body.along_edges = body.kind == BodyKind::block && body.cells == "hex8";
  if (drawn.scene.contacts.empty() && draw.coin(0.3)) {
    drawn.scene.increments = 3;
  }
  return drawn;
}

}  // namespace langer::relations

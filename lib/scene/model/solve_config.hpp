// What the solve stage's YAML may say. A part that is not named does not exist in the scene.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/former.hpp"
#include "core/base/history.hpp"
#include "core/base/percent.hpp"
#include "mechanics/contact/adhesion.hpp"
#include "mechanics/contact/rigid.hpp"
#include "mechanics/element/formulation.hpp"
#include "mechanics/material/at_rest.hpp"
#include "mechanics/nonlinear/kinsol.hpp"
#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/nonlinear/newton.hpp"
#include "scene/model/dynamics_config.hpp"
#include "scene/model/fibre_field.hpp"
#include "scene/model/instability_config.hpp"
#include "scene/model/load_config.hpp"
#include "scene/model/mesh_config.hpp"
#include "scene/model/vibration_config.hpp"

namespace langer {

enum class Axis { x, y, z };
constexpr auto names(Axis) { return std::array{"x", "y", "z"}; }

struct SupportConfig {
  std::string on;
  std::vector<Axis> hold;
  static void fields(auto& v) {
    v(&SupportConfig::on, "on", unit::none, "node set of the mesh", required);
    v(&SupportConfig::hold, "hold", unit::none, "directions that cannot move", required);
  }
  std::vector<Complaint> complaints() const {
    if (!hold.empty()) return {};
    return {{"hold", "found an empty list", "one or more of x, y, z", ""}};
  }
};

struct WaypointConfig {
  std::optional<double> t;
  std::array<double, 3> to{};
  std::optional<double> s;
  static void fields(auto& v) {
    list_place<WaypointConfig>(v);
    v(&WaypointConfig::to, "to", unit::mm, "displacement of the indenter from its start", required);
  }
};

struct ControlConfig {
  HistoryConfig force;
  std::array<double, 3> along{0, -1, 0};
  static void fields(auto& v) {
    v(&ControlConfig::force, "force", unit::N,
      "with which the indenter is pushed against the body, at the end of the path, in proportion to t; or a history",
      required);
    v(&ControlConfig::along, "along", unit::none, "direction in which it is pushed; any length");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    bool pulls = force.points.empty() && force.value < 0;
    for (const HistoryPointConfig& point : force.points) pulls = pulls || point.to < 0;
    if (pulls)
      found.push_back({"force", "found a pull", "a force of at least 0 N",
                       "nothing holds an indenter that is pulled"});
    if (!force.moves())
      found.push_back({"force", "found no force", "a force above 0 N somewhere on the path", ""});
    if (along == std::array<double, 3>{})
      found.push_back({"along", "found [0, 0, 0]", "a direction", ""});
    return found;
  }
};

struct ContactConfig {
  std::string on;
  std::optional<Indenter> rigid;
  double friction = 0;
  std::vector<WaypointConfig> motion;
  std::optional<ControlConfig> control = {};
  std::optional<FreeConfig> free = {};
  std::optional<HistoryConfig> rotation = {};
  std::optional<Adhesion> adhesion = {};
  std::optional<std::string> against = {};
  static void fields(auto& v) {
    v(&ContactConfig::on, "on", unit::none,
      "node set that may touch the indenter; none: nodes of the boundary that it can reach. With `against`: the surface at whose "
      "nodes the contact law holds, the finer or softer one of the two");
    v(&ContactConfig::rigid, "rigid", unit::none,
      "shape and place of the indenter; or `against` instead");
    v(&ContactConfig::against, "against", unit::none,
      "the set of facets that `on` touches, instead of `rigid`: two deformable surfaces of hex8; the "
      "set of `on` itself: a surface that may fold and touch itself");
    v(&ContactConfig::friction, "friction", unit::none, "Coulomb coefficient", between(0, 10),
      Hint{
          "Coulomb coefficient without unit, no percentage and no angle: 34 % is 0.34, an angle of friction of 34 degrees is "
          "tan 34 = 0.67; at 10 everything sticks; leave the key out for frictionless contact"});
    v(&ContactConfig::motion, "motion", unit::none,
      "where the indenter goes, straight from point to point; with control only across its direction");
    v(&ContactConfig::control, "control", unit::none,
      "the indenter is pushed with a given force, and its travel is found");
    v(&ContactConfig::free, "free", unit::none,
      "with dynamics: the indenter has a mass and flies by itself along a direction");
    v(&ContactConfig::rotation, "rotation", unit::deg,
      "angle by which the indenter turns about its axis of revolution (of a sphere about y) by the right hand, in proportion to t; or a "
      "history, as a displacement");
    v(&ContactConfig::adhesion, "adhesion", unit::none,
      "bonds that hold what has touched the indenter or the other surface, until they come loose");
  }
  bool deformable() const { return against.has_value(); }
  std::vector<Complaint> complaints() const {
    if (deformable()) return of_surfaces();
    if (!rigid)
      return {{"rigid", "missing", "a shape and place of the indenter, or `against: <set>`", ""}};
    std::vector<Complaint> found = of_rotation();
    if (control && adhesion)
      found.push_back({"control", "found together with adhesion", "one of the two",
                       "a pull of given force jumps off without an end: move the indenter"});
    if (rotation && adhesion)
      found.push_back({"rotation", "found together with adhesion", "one of the two",
                       "bonds follow the place of an indenter, not its rotation"});
    if (free && control)
      found.push_back({"free", "found together with control", "one of the two", ""});
    if (free && adhesion)
      found.push_back({"free", "found together with adhesion", "one of the two", ""});
    if (free && !motion.empty())
      found.push_back({"motion", "found together with free", "one of the two",
                       "an indenter with mass goes where its inertia takes it"});
    if (free || (control && motion.empty())) return found;
    for (Complaint& complaint :
         place_complaints(motion, "motion", "{t: 1, to: [x, y, z]}, or control in its place"))
      found.push_back(std::move(complaint));
    for (std::size_t i = 0; control && i < motion.size(); ++i) {
      double dot = 0, size = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        dot += motion[i].to[k] * control->along[k];
        size += std::abs(motion[i].to[k] * control->along[k]);
      }
      if (std::abs(dot) > 1e-12 * size)
        found.push_back({"motion", "moves the indenter along the direction of its force",
                         "movements across it",
                         "how far it goes there follows from control.force"});
    }
    return found;
  }

 private:
  // two deformable surfaces
  std::vector<Complaint> of_surfaces() const {
    std::vector<Complaint> found;
    const auto refuse = [&](bool given, const char* key, const char* hint) {
      if (given)
        found.push_back(
            {key, "found together with against", "a rigid indenter, or none of it", hint});
    };
    refuse(rigid.has_value(), "rigid", "a contact has either a rigid shape or a second surface");
    refuse(!motion.empty(), "motion", "`loads` and `supports` move the bodies");
    refuse(control.has_value(), "control", "a load {force: ...} pushes a body");
    refuse(rotation.has_value(), "rotation", "a load {rotation: ...} turns a set");
    if (on.empty()) found.push_back({"on", "missing", "the set that touches `against`", ""});
    return found;
  }
  std::vector<Complaint> of_rotation() const {
    if (!rotation) return {};
    if (!axis_of(*rigid))
      return {{"rotation", "found with a shape that has no axis of revolution",
               "a sphere, a plane, a cylinder, an ellipsoid with two equal half axes",
               "another shape is another one once it has turned"}};
    if (friction == 0)
      return {{"rotation", "found without friction", "friction above 0",
               "what turns without it does not reach the body"}};
    return {};
  }
};

// When the stability of what was found is checked, and what happens then.
//   auto       at each step; movements that break the symmetry by which the body is reduced at each
//              step where no indenter is, else at the end of the path (one factorization for each kind)
//   each_step  all of it at each step
enum class StabilityCheck { automatic, each_step, last, off };
constexpr auto names(StabilityCheck) { return std::array{"auto", "each_step", "last", "off"}; }
enum class OnUnstable { warn, stop };
constexpr auto names(OnUnstable) { return std::array{"warn", "stop"}; }

// Symmetry by which the body is reduced before it is solved (scene/model/scene_symmetry.hpp).
enum class SymmetryChoice { none, automatic, mirror_x, mirror_z, quarter, half_turn };
constexpr auto names(SymmetryChoice) {
  return std::array{"none", "auto", "mirror_x", "mirror_z", "quarter", "half_turn"};
}

// Whether a block that is the same around an axis, but for its far sides, is solved as a section
// (accuracy/refinement/section_in_place.hpp).
enum class Reduce { none, automatic };
constexpr auto names(Reduce) { return std::array{"none", "auto"}; }

// Whether a body that deforms alike everywhere is solved at a point (run/homogeneous.hpp).
enum class Homogeneous { automatic, off };
constexpr auto names(Homogeneous) { return std::array{"auto", "off"}; }

struct BodyConfig {
  std::optional<Material> material;
  std::vector<double> fibre_angles;
  std::optional<FibreField> fibre_field;
  static void fields(auto& v) {
    v(&BodyConfig::material, "material", unit::none,
      "its material; none: that of the bodies not named");
    v(&BodyConfig::fibre_angles, "fibre_angles", unit::deg,
      "angle of each fibre family; none: those of the bodies not named", between(-360, 360));
    v(&BodyConfig::fibre_field, "fibre_field", unit::none,
      "directions that vary from cell to cell");
  }
};

// One of several bodies: its mesh, and what belongs to it alone. Names of its sets, points and
// layers begin with its own: <body>_<set>.
struct SceneBodyConfig {
  MeshConfig mesh;
  std::optional<Material> material;
  std::vector<double> fibre_angles;
  std::optional<FibreField> fibre_field;
  std::vector<SupportConfig> supports;
  std::vector<LoadConfig> loads;
  std::optional<std::array<double, 3>> velocity, spin;
  static void fields(auto& v) {
    v(&SceneBodyConfig::mesh, "mesh", unit::none, "its mesh", required);
    v(&SceneBodyConfig::material, "material", unit::none,
      "its material; none: that of the scene. Of a mesh with layers: `materials` by <body>_<layer>");
    v(&SceneBodyConfig::fibre_angles, "fibre_angles", unit::deg,
      "angle of each fibre family, instead of the material's own", between(-360, 360));
    v(&SceneBodyConfig::fibre_field, "fibre_field", unit::none,
      "directions that vary from cell to cell");
    v(&SceneBodyConfig::supports, "supports", unit::none, "sets of this mesh that are held");
    v(&SceneBodyConfig::loads, "loads", unit::none, "loads on sets of this mesh");
    v(&SceneBodyConfig::velocity, "velocity", "mm/s",
      "with dynamics: of this body at the beginning; none: that of dynamics");
    v(&SceneBodyConfig::spin, "spin", "1/s",
      "with dynamics: angular velocity of this body at the beginning, about the middle of its box; "
      "none: it moves as dynamics says");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (mesh.cells != CellType::hex8)
      found.push_back({"mesh.cells", "found other cells than hex8 in one of several bodies",
                       "cells: hex8", "contact of two deformable surfaces knows hex8 only"});
    if (is_section(mesh.geometry))
      found.push_back({"mesh.geometry", "found a section", "a body with all of its sides",
                       "sections are of one body"});
    if (!mesh.cuts.empty())
      found.push_back({"mesh.cuts", "found in one of several bodies", "none", ""});
    if (!mesh.exports.empty())
      found.push_back({"mesh.export", "found in a solve", "langer-mesh: it is what exports", ""});
    const bool own = material || !fibre_angles.empty() || fibre_field;
    if (own && !mesh.bodies.empty())
      found.push_back({"material", "found with a mesh of several layers",
                       "`materials` of the scene, by <body>_<layer>", ""});
    return found;
  }
};

// The place on the path where an accuracy is judged.
enum class AccuracyAt { end, maximum, every_step };
constexpr auto names(AccuracyAt) { return std::array{"end", "maximum", "every_step"}; }

// What has to be as accurate as asked for: the value on the mesh, or its limit on ever finer
// meshes.
enum class AccuracyOf { limit, mesh };
constexpr auto names(AccuracyOf) { return std::array{"limit", "mesh"}; }

// A wanted error of one quantity; "1%" is short for {within: 1%}.
struct AccuracyConfig {
  static constexpr const char* short_key = "within";
  std::optional<std::string> of;
  std::optional<AccuracyAt> at;
  std::string within;
  AccuracyOf answer = AccuracyOf::limit;
  AccuracyConfig() = default;
  AccuracyConfig(std::string wanted) : within(std::move(wanted)) {}
  AccuracyConfig(const char* wanted) : within(wanted) {}
  static void fields(auto& v) {
    v(&AccuracyConfig::of, "of", unit::none,
      "the quantity: force, force_<contact>, reaction_<set>, torque_<name>, travel_<contact>, displacement_<point> (or "
      "displacement@<point>), apex_height, pull_off, von_mises_max; or the kind alone, "
      "such as reaction, for all of that kind. None: the force of indenters that move as given and the pull-off of those that adhere, "
      "the travel of one under force control, else the reactions of moved sets, else the displacements of points");
    v(&AccuracyConfig::at, "at", unit::none,
      "where on the path: at its end, where the quantity is largest, or at every step, relative to the largest value. None: at the "
      "end, or at the largest value where the path ends below half of it");
    v(&AccuracyConfig::within, "within", unit::none, "wanted error, such as 1%", required);
    v(&AccuracyConfig::answer, "answer", unit::none,
      "what has to be as accurate as that. limit: the value on the mesh, or the limit that it and coarser meshes show, whichever is "
      "known first; mesh: the value on the mesh");
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    if (!percent_of(within))
      found.push_back(
          {"within", "found \"" + within + "\"", "a percentage above 0, such as 1%", ""});
    const auto known = std::array{"force", "reaction", "torque", "travel", "displacement"};
    const auto alone = std::array{"apex_height", "pull_off", "von_mises_max"};
    const auto is_of = [&](const char* kind) {
      return *quantity() == kind || quantity()->starts_with(std::string(kind) + "_");
    };
    if (of && std::none_of(known.begin(), known.end(), is_of) &&
        std::find(alone.begin(), alone.end(), *of) == alone.end())
      found.push_back(
          {"of", "found \"" + *of + "\"",
           "force, reaction, torque, travel or displacement, or one of them with _ and a name; or apex_height, pull_off or von_mises_max",
           ""});
    return found;
  }
  // `of` as results name it: displacement@P is displacement_P.
  std::optional<std::string> quantity() const {
    constexpr std::string_view at_point = "displacement@";
    if (!of || !of->starts_with(at_point)) return of;
    return "displacement_" + of->substr(at_point.size());
  }
};

// Named points of the measured front of accuracy against cost (accuracy/refinement/accuracy.hpp).
enum class Fidelity { draft, standard, reference };
constexpr auto names(Fidelity) { return std::array{"draft", "standard", "reference"}; }

// How the errors of a result are estimated (accuracy/estimate/error_estimate.hpp).
enum class EstimateBy { none, recovery, refinement, automatic, dual };
constexpr auto names(EstimateBy) {
  return std::array{"none", "recovery", "refinement", "auto", "dual"};
}
constexpr auto former_names(EstimateBy) {
  return std::array{FormerWord{"second_rung", "refinement"}};
}

// What a block or disc leaves out that stands for a larger body (accuracy/estimate/truncation.hpp).
enum class Truncation { sides, bottom };
constexpr auto names(Truncation) { return std::array{"sides", "bottom"}; }

// Whether what a fit does not know of its parameters is carried into the forces
// (inverse/uncertainty.hpp).
enum class UncertaintyBy { none, linear };
constexpr auto names(UncertaintyBy) { return std::array{"none", "linear"}; }

// What of the stress of cells stands in the solution beside pressure and von Mises stress
// (run/cell_stress.hpp).
enum class CellStress { tensor, principal };
constexpr auto names(CellStress) { return std::array{"tensor", "principal"}; }

struct SolveConfig {
  std::optional<MeshConfig> mesh;
  std::optional<AccuracyConfig> accuracy;
  std::optional<Fidelity> fidelity;
  std::optional<EstimateBy> estimate;
  std::vector<Truncation> truncation;
  std::optional<Material> material;
  std::vector<double> fibre_angles;
  std::optional<FibreField> fibre_field;
  std::map<std::string, BodyConfig> materials;
  std::map<std::string, SceneBodyConfig> bodies;
  std::optional<Formulation> formulation;
  std::vector<SupportConfig> supports;
  std::vector<LoadConfig> loads;
  std::map<std::string, ContactConfig> contacts;
  // Set by expanded() (scene/model/scene_bodies.hpp), not by the config: contacts of deformable
  // surfaces, which then are no longer among `contacts`.
  std::map<std::string, ContactConfig> touching = {};
  std::optional<DynamicsConfig> dynamics;
  LoadPathOptions path;
  std::variant<NewtonOptions, KinsolOptions> solver;
  StabilityCheck stability = StabilityCheck::automatic;
  OnUnstable on_unstable = OnUnstable::warn;
  LocateCritical critical = LocateCritical::automatic;
  std::optional<BranchConfig> branch;
  std::optional<ImperfectionConfig> imperfection;
  SymmetryChoice symmetry = SymmetryChoice::automatic;
  Reduce reduce = Reduce::none;
  Homogeneous homogeneous = Homogeneous::automatic;
  std::vector<std::string> sensitivity;
  std::optional<UncertaintyBy> uncertainty;
  std::optional<CellStress> cell_stress;
  std::optional<ModesConfig> modes;
  std::optional<HarmonicConfig> harmonic;
  int threads = 1, blas_threads = 1;
  static void fields(auto& v) {
    v(&SolveConfig::mesh, "mesh", unit::none,
      "the mesh, as langer-mesh reads it; may come from --mesh instead");
    v(&SolveConfig::accuracy, "accuracy", unit::none,
      "wanted error, such as 1%, or {of: travel, at: maximum, within: 1%}: chooses the cells of mesh.geometry, the "
      "increments and the symmetry, from what was measured (pipelines/refinement_study.yaml) or from a coarse solution, and refines until the "
      "estimate is within it; exit code 5 where it is not");
    v(&SolveConfig::fidelity, "fidelity", unit::none,
      "instead of accuracy, by name: draft 5%, standard 1%, reference 0.2%");
    v(&SolveConfig::estimate, "estimate", unit::none,
      "errors of forces, reactions, greatest von Mises stress and displacements at points: refinement solves the scene again on cells "
      "longer by 1.25 and by 1.5 (where they are too coarse for that, on finer ones), and with friction once more in other increments; wants "
      "a mesh whose cells follow from numbers of the config (block, section, indented_block, indented_disc), and is taken where accuracy or "
      "fidelity is asked for; auto does so where it takes less than a third of the solve by the forecast, else as recovery. dual, on any mesh of an elastic "
      "body, without friction: forces, reactions and displacements by the dual solution of each, at about the cost of one iteration; together with "
      "accuracy hex8 are cut where the error comes from. recovery, on any mesh and at once: what the stress lacks to be smooth; of force and "
      "stress, in an indentation some times too large; the default for elastic bodies of one material whose indenters follow `motion`. none. Of a body in motion refinement alone: "
      "peak force, contact time and restitution, on cells and increments longer by 1.4 and by 2");
    v(&SolveConfig::truncation, "truncation", unit::none,
      "of an indented_block or indented_disc that stands for a larger body: sides, bottom, or both; an estimate by refinement reports what "
      "each leaves out of the forces, from two coarse solves of wider or thicker bodies");
    v(&SolveConfig::material, "material", unit::none,
      "the material; may come from --material instead");
    v(&SolveConfig::fibre_angles, "fibre_angles", unit::deg,
      "angle of each fibre family, instead of the material's own", between(-360, 360));
    v(&SolveConfig::fibre_field, "fibre_field", unit::none,
      "fibre directions that vary from cell to cell: those of the first family; further ones keep their angle to it");
    v(&SolveConfig::materials, "materials", unit::none,
      "bodies of the mesh by name, each with its own material and fibres; the keys above stand for those not named");
    v(&SolveConfig::bodies, "bodies", unit::none,
      "several bodies by name, each with its own mesh, instead of `mesh`; their sets are called <body>_<set>, such as skin_top");
    v(&SolveConfig::formulation, "formulation", unit::none,
      "how the dilatation enters an element; none: mean_dilatation in hex8, linear_dilatation in hex27 and tet15");
    v(&SolveConfig::supports, "supports", unit::none, "node sets that are held", required);
    v(&SolveConfig::loads, "loads", unit::none,
      "imposed displacements, forces, tractions and pressures");
    v(&SolveConfig::contacts, "contacts", unit::none,
      "rigid indenters, and pairs of deformable surfaces, by name");
    v(&SolveConfig::dynamics, "dynamics", unit::none,
      "the body has inertia, and moves in time: path.seconds; with modes or harmonic it gives the "
      "density alone; none: equilibrium");
    v(&SolveConfig::path, "path", unit::none, "increments of the load path, t from 0 to 1");
    v(&SolveConfig::solver, "solver", unit::none, "nonlinear solver");
    v(&SolveConfig::stability, "stability", unit::none,
      "when to check the signs of the constrained tangent and strong ellipticity in all Gauss points. auto: at each step; where symmetry "
      "reduces a body with indenters, movements that break the symmetry at the end of the path only. each_step: these at each step, too");
    v(&SolveConfig::on_unstable, "on_unstable", unit::none,
      "what to do where the equilibrium or the material is unstable; stop keeps the steps before");
    v(&SolveConfig::critical, "critical", unit::none,
      "auto: where the equilibrium becomes unstable, the critical point is found to 1e-4 of the path, its kind is named (limit point of "
      "load, limit point of travel, bifurcation) and its mode written; nothing is done where all states are stable");
    v(&SolveConfig::branch, "branch", unit::none,
      "follow: at the first bifurcation the path continues along the mode; solves the whole body, once as far as there and once more");
    v(&SolveConfig::imperfection, "imperfection", unit::none,
      "moves the nodes of the mesh along a mode of the perfect body, which is solved as far as its first critical point before");
    v(&SolveConfig::symmetry, "symmetry", unit::none,
      "solve the part of the body that decides the rest, write the whole of it; auto: the largest symmetry that mesh, fibres, "
      "supports, loads and contacts have. The path stays symmetric where the body becomes unstable, and `stability` says so: none solves "
      "the whole body");
    v(&SolveConfig::reduce, "reduce", unit::none,
      "auto: an indented_block with free sides whose scene is the same around its axis is solved as an axisymmetric section, a disc "
      "of its area, where the discs inside and around the block show that its sides change the force by less than accuracy or "
      "fidelity allow (1% without them); results are those of the section");
    v(&SolveConfig::homogeneous, "homogeneous", unit::none,
      "auto: where one material between plane faces that are held or moved as wholes deforms alike everywhere, one hexahedron is "
      "solved instead of the mesh; every state is put to the mesh, which has to balance, and whose stability is looked at");
    v(&SolveConfig::sensitivity, "sensitivity", unit::none,
      "numbers of the scene, such as matrix.yeoh.a1, viscous[0].tau, materials.dermis.matrix.yeoh.a1, contacts.sphere.friction or loads[0].pressure: at "
      "every increment the derivatives of displacements, reactions and forces with respect to each");
    v(&SolveConfig::uncertainty, "uncertainty", unit::none,
      "linear: what the fit behind --material does not know of its parameters is carried into the forces");
    v(&SolveConfig::cell_stress, "cell_stress", unit::none,
      "writes the Cauchy stress of each cell, its mean over the Gauss points, into the solution: tensor; principal: its principal stresses "
      "and directions as well. Pressure and von Mises stress of cells are always there");
    v(&SolveConfig::modes, "modes", unit::none,
      "natural frequencies and shapes of small vibrations about the state at the end of the path");
    v(&SolveConfig::harmonic, "harmonic", unit::none,
      "complex stiffness of an indenter or a face that oscillates about that state");
    v(&SolveConfig::threads, "threads", unit::none,
      "threads of the assembly; the results do not depend on it", between(1, 256));
    v(&SolveConfig::blas_threads, "blas_threads", unit::none,
      "threads of the factorization; more than one are faster in large scenes and change the last digits (1e-11 of a reaction)",
      between(1, 256));
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found;
    const auto needs_stiffness = [&](const std::optional<Material>& m, const std::string& key) {
      if (m && at_rest(*m) == AtRest::without_stiffness)
        found.push_back({key, at_rest_in_words(*m), stiffness_at_rest_cure(*m),
                         "a body without it has no first step"});
    };
    needs_stiffness(material, "material.matrix");
    complain_of_bodies(found);
    for (const auto& [name, body] : materials)
      needs_stiffness(body.material, "materials." + name + ".material.matrix");
    complain_of_motion(found);
    if (loads.empty() && contacts.empty() && !dynamics && !modes && !(harmonic && harmonic->face))
      found.push_back({"", "nothing moves", "loads or contacts", ""});
    if (mesh && !mesh->exports.empty())
      found.push_back({"mesh.export", "found in a solve", "langer-mesh: it is what exports", ""});
    if (accuracy && fidelity)
      found.push_back({"fidelity", "found together with accuracy", "one of the two", ""});
    const bool numbers = !bodies.empty() || (mesh && has_numbers_of_cells(mesh->geometry));
    if (estimate == EstimateBy::refinement || !key_of_accuracy().empty())
      complain_of_divisions(found);
    std::string other_mesh = "no mesh here";
    if (mesh) other_mesh = "a mesh whose cells follow from no numbers of this config";
    const char* laid_out =
        "the key mesh with geometry: {block: ...}, section, indented_block or indented_disc";
    if (estimate == EstimateBy::refinement && !numbers)
      found.push_back(
          {"estimate", "refinement, and " + other_mesh, laid_out,
           "coarser cells are made from those numbers; estimate: dual is for any mesh"});
    const bool indented = mesh && has_edge_in_contact_radii(mesh->geometry);
    if (!truncation.empty() && !indented)
      found.push_back({"truncation", "a mesh that is no indented_block or indented_disc",
                       "one of the two", "wider and thicker bodies are made from their numbers"});
    else if (!truncation.empty() && !accuracy && !fidelity && estimate != EstimateBy::refinement &&
             estimate != EstimateBy::automatic)
      found.push_back({"truncation", "no estimate by refinement", "estimate: refinement or auto",
                       "it reports what is left out"});
    if (!truncation.empty() && indented && std::ranges::any_of(loads, &LoadConfig::imposes_motion))
      found.push_back({"truncation", "found together with imposed displacements", "none",
                       "a wider or thicker body would need others to be as much deformed"});
    for (std::size_t i = 0; i < truncation.size(); ++i) {
      const std::string key = "truncation[" + std::to_string(i) + "]";
      if (truncation[i] == Truncation::bottom && mesh && !mesh->bodies.empty())
        found.push_back({key, "bottom, of a mesh with bodies", "sides",
                         "which of its layers would go on is not known"});
      if (truncation[i] == Truncation::sides && reduce == Reduce::automatic)
        found.push_back({key, "sides, together with reduce: auto", "one of the two",
                         "reduce reports what the sides change"});
    }
    const bool by_cells = estimate == EstimateBy::dual || estimate == EstimateBy::recovery;
    const std::string asked = key_of_accuracy();
    if (const std::string& key = asked; !key.empty() && !numbers && !by_cells)
      found.push_back(
          {key, other_mesh, laid_out,
           "accuracy chooses their cells; estimate: dual or recovery cuts those of any mesh"});
    complain_of_cuts(found);
    complain_of_seconds(found);
    complain_of_vibration(found);
    const bool estimates = estimate && *estimate != EstimateBy::none;
    const bool refines = estimate == EstimateBy::refinement;
    std::string judged = asked;
    if (judged.empty() && estimates) judged = "estimate";
    if (const std::string& key = judged; !key.empty()) {
      const bool pushed = std::any_of(contacts.begin(), contacts.end(),
                                      [](const auto& c) { return c.second.control; }) &&
                          !accuracy && !fidelity && !refines;  // which judge its travel
      const bool moved = std::any_of(loads.begin(), loads.end(),
                                     [](const LoadConfig& l) { return !l.on_surface(); });
      if (pushed)
        found.push_back({key, "found together with an indenter under force control",
                         "one that follows `motion`",
                         "errors are estimated of its force, which is given here"});
      else if (contacts.empty() && !moved && !(mesh && !mesh->points.empty()) &&
               (accuracy || fidelity || refines) && !(accuracy && accuracy->of))
        found.push_back(
            {key, "found where forces alone load the body",
             "an indenter, an imposed displacement, or points in the mesh",
             "errors are estimated of the force that it needs, or of the displacement of mesh.points; estimate: recovery reports "
             "that of the stress"});
    }
    if (accuracy && estimate == EstimateBy::dual && accuracy->at &&
        *accuracy->at != AccuracyAt::end)
      found.push_back({"accuracy.at", "found together with estimate: dual", "end",
                       "a dual solution is of one state; estimate: refinement judges the path"});
    if (accuracy && estimate == EstimateBy::recovery && accuracy->of == "von_mises_max" &&
        accuracy->at && *accuracy->at != AccuracyAt::end)
      found.push_back(
          {"accuracy.at", "found together with estimate: recovery", "end",
           "the spread of stresses is looked at in the last step; estimate: refinement judges the path"});
    complain_of_instabilities(found);
    if (on_unstable == OnUnstable::stop && stability == StabilityCheck::off)
      found.push_back({"on_unstable", "stop, while stability is off",
                       "stability: auto, each_step or last", ""});
    return found;
  }

  // Whether the body moves in time. With modes or harmonic it rests, and `dynamics` gives the
  // density for small movements about that state.
  bool in_motion() const { return dynamics && !modes && !harmonic; }

 private:
  // What contact of deformable surfaces, or a scene of several bodies, does not go together with.
  void complain_of_bodies(std::vector<Complaint>& found) const {
    for (const auto& [name, body] : bodies)
      if (body.material && at_rest(*body.material) == AtRest::without_stiffness)
        found.push_back({"bodies." + name + ".material.matrix", at_rest_in_words(*body.material),
                         stiffness_at_rest_cure(*body.material),
                         "a body without it has no first step"});
    if (mesh && !bodies.empty())
      found.push_back({"bodies", "found together with mesh", "one of the two",
                       "`mesh: null` takes an included mesh away"});
    std::string cause = "several bodies";
    bool several = !bodies.empty();
    for (const auto& [name, contact] : contacts)
      if (contact.deformable()) {
        cause = "contact of deformable surfaces";
        several = true;
      }
    if (!several) return;
    const auto refuse = [&](bool given, const std::string& key, const char* expected) {
      if (given) found.push_back({key, "found together with " + cause, expected, ""});
    };
    if (mesh && mesh->cells != CellType::hex8)
      found.push_back({"mesh.cells", "found other cells than hex8 with " + cause, "cells: hex8",
                       "mortar contact of hex27 and tet15 is not there yet"});
    refuse(mesh && is_section(mesh->geometry), "mesh.geometry", "a body with all of its sides");
    refuse(mesh && !mesh->cuts.empty(), "mesh.cuts", "a mesh without cuts");
    refuse(accuracy && bodies.empty(), "accuracy", "shorter cells by hand");
    refuse(fidelity && bodies.empty(), "fidelity", "shorter cells by hand");
    const bool by_refinement = estimate == EstimateBy::refinement;
    refuse(by_refinement && in_motion(), "estimate", "none in motion");
    refuse(estimate && !by_refinement && *estimate != EstimateBy::none, "estimate",
           "refinement or none");
    refuse(symmetry == SymmetryChoice::half_turn, "symmetry", "auto, none or mirror planes");
    refuse(reduce == Reduce::automatic, "reduce", "none");
    refuse(!sensitivity.empty() && in_motion(), "sensitivity", "none in motion");
    const bool rigid_as_well = std::ranges::any_of(
        contacts, [](const auto& contact) { return !contact.second.deformable(); });
    refuse(!sensitivity.empty() && rigid_as_well, "sensitivity",
           "deformable surfaces alone, or indenters alone");
    const bool propagates = uncertainty && *uncertainty != UncertaintyBy::none;
    refuse(propagates && rigid_as_well, "uncertainty",
           "deformable surfaces alone, or indenters alone");
    refuse(!truncation.empty(), "truncation", "none");
    refuse(stability == StabilityCheck::each_step || stability == StabilityCheck::last, "stability",
           "auto or off: signs of the tangent are not counted there");
    refuse(on_unstable == OnUnstable::stop, "on_unstable", "warn");
    refuse(std::holds_alternative<KinsolOptions>(solver), "solver.kinsol", "newton");
    if (const auto* newton = std::get_if<NewtonOptions>(&solver))
      refuse(newton->linear == LinearBy::iterative, "solver.newton.linear", "direct");
    for (const auto& [name, contact] : contacts) {
      const bool differentiates = !sensitivity.empty() || propagates;
      refuse(contact.adhesion && differentiates, "contacts." + name + ".adhesion",
             "either adhesion, or sensitivity and uncertainty");
      refuse(contact.control.has_value(), "contacts." + name + ".control", "motion");
      refuse(contact.free.has_value(), "contacts." + name + ".free", "motion");
    }
  }
  // Coarser meshes of several bodies have 3/4 and half of their cells along each axis.
  void complain_of_divisions(std::vector<Complaint>& found) const {
    if (bodies.empty()) return;
    std::string cause = "found together with estimate: refinement";
    if (!key_of_accuracy().empty()) cause = "found together with " + key_of_accuracy();
    const char* const why = "its coarser meshes have 3/4 and half of the cells of every body";
    bool any = false;
    for (const auto& [name, body] : bodies) {
      const std::string key = "bodies." + name + ".mesh.geometry";
      const auto* block = std::get_if<Block>(&body.mesh.geometry);
      if (!block) {
        found.push_back({key, cause, "block", ""});
        return;
      }
      const auto divides = [](int n) {
        return n == 1 || n % 4 == 0;
      };
      if (!std::ranges::all_of(block->divisions, divides))
        found.push_back(
            {key + ".block.divisions", cause, "numbers that are 1 or multiples of 4", why});
      any = any || std::ranges::any_of(block->divisions, [](int n) { return n > 1; });
    }
    if (!any)
      found.push_back({"bodies", "found with one cell along every axis", "4 cells or more", why});
  }
  // Inertia together with what knows equilibria only.
  void complain_of_motion(std::vector<Complaint>& found) const {
    for (const auto& [name, contact] : contacts)
      if (contact.free && !in_motion())
        found.push_back({"contacts." + name + ".free", "found without dynamics",
                         "dynamics: {density_kg_m3: 1100}",
                         "an indenter with mass moves in time, with a body that has inertia"});
    for (const auto& [name, body] : bodies) {
      if (in_motion()) break;
      std::vector<std::string> moves;
      if (body.velocity) moves.push_back("velocity");
      if (body.spin) moves.push_back("spin");
      for (const std::string& key : moves) {
        found.push_back({"bodies." + name + "." + key, "found without dynamics",
                         "dynamics: {density_kg_m3: 1100}", "an equilibrium has no velocity"});
      }
    }
    if (!in_motion()) return;
    const auto refuse = [&](const std::string& key, const std::string& expected) {
      found.push_back({key, "found together with dynamics", expected, "it is for equilibria"});
    };
    if (path.arc_length) refuse("path.arc_length", "path: {seconds: ...}");
    if (branch) refuse("branch", "none");
    if (imperfection) refuse("imperfection", "none");
    for (std::size_t i = 0; i < loads.size(); ++i)
      if (loads[i].volume) refuse("loads[" + std::to_string(i) + "].volume", "pressure");
    if (!path.seconds)
      found.push_back({"dynamics", "found on a path without seconds", "path: {seconds: ...}", ""});
    if (accuracy) refuse("accuracy", "none");
    if (fidelity) refuse("fidelity", "none");
    if (estimate && *estimate != EstimateBy::none && *estimate != EstimateBy::refinement)
      refuse("estimate", "refinement or none");
    if (estimate == EstimateBy::refinement && contacts.empty())
      found.push_back({"estimate", "found together with dynamics and without contacts", "none",
                       "errors are those of an impact: peak force, contact time, restitution"});
    if (!sensitivity.empty() && dynamics->scheme != Scheme::generalised_alpha)
      found.push_back({"sensitivity", "found with another scheme",
                       "dynamics: {scheme: generalised_alpha}", ""});
    if (!sensitivity.empty() && dynamics->damping && dynamics->damping->stiffness_s > 0)
      found.push_back({"sensitivity", "found together with dynamics.damping.stiffness_s",
                       "mass_per_s alone", "that damping changes with the material"});
    if (uncertainty == UncertaintyBy::linear) refuse("uncertainty", "none");
    if (reduce == Reduce::automatic) refuse("reduce", "none");
    if (stability == StabilityCheck::each_step || stability == StabilityCheck::last)
      refuse("stability", "off");
    if (on_unstable == OnUnstable::stop) refuse("on_unstable", "warn");
    if (std::holds_alternative<KinsolOptions>(solver)) refuse("solver.kinsol", "newton");
    if (const auto* newton = std::get_if<NewtonOptions>(&solver);
        newton && newton->linear == LinearBy::iterative)
      refuse("solver.newton.linear", "direct");
    for (const auto& [name, contact] : contacts)
      if (contact.adhesion) refuse("contacts." + name + ".adhesion", "none");
    if (dynamics->scheme != Scheme::energy_momentum) return;
    const auto unlike = [&](const std::string& key, const std::string& hint) {
      found.push_back({key, "found with scheme: energy_momentum", "another scheme", hint});
    };
    for (const auto& [name, contact] : contacts)
      unlike("contacts." + name,
             "its balance is that of the middle of a step, and contact at its end");
    for (std::size_t i = 0; i < loads.size(); ++i)
      if (!loads[i].on_surface())
        unlike("loads[" + std::to_string(i) + "]",
               "the velocity of a set that is moved would alternate from step to step");
    if (material && is_viscous(*material))
      unlike("material", "viscous branches know the end of a step");
  }
  // The key that requests an accuracy; empty if none does.
  std::string key_of_accuracy() const {
    if (accuracy) return "accuracy";
    if (fidelity) return "fidelity";
    return "";
  }
  void complain_of_cuts(std::vector<Complaint>& found) const {
    if (!mesh || mesh->cuts.empty()) return;
    const bool by_numbers = estimate == EstimateBy::refinement || estimate == EstimateBy::automatic;
    std::string key = key_of_accuracy();
    if (key.empty() && by_numbers) key = "estimate";
    if (!key.empty())
      found.push_back(
          {key, "found together with mesh.cuts", "a mesh without cuts",
           "cells of other lengths are made from the mesh's numbers; estimate: dual judges cut cells as they are"});
    if (reduce == Reduce::automatic)
      found.push_back(
          {"reduce", "auto, together with mesh.cuts", "one of the two", "sections have no cuts"});
    if (!truncation.empty())
      found.push_back({"truncation", "found together with mesh.cuts", "none",
                       "wider bodies are made without cuts"});
  }
  void complain_of_vibration(std::vector<Complaint>& found) const {
    const auto look_at = [&](const std::string& key) {
      if (!dynamics)
        found.push_back({key, "found without a density", "dynamics: {density_kg_m3: 1100}", ""});
      if (reduce == Reduce::automatic)
        found.push_back({"reduce", "auto, together with " + key, "reduce: none",
                         "a section vibrates within its plane only"});
      for (const auto& [name, contact] : contacts) {
        if (contact.adhesion)
          found.push_back({key, "found together with contacts." + name + ".adhesion",
                           "one of the two", "small movements of bonds are not linearised"});
      }
    };
    if (modes) look_at("modes");
    if (harmonic) look_at("harmonic");
    if ((modes || harmonic) && !bodies.empty())
      found.push_back({modes ? "modes" : "harmonic", "found together with bodies", "one mesh",
                       "small movements of surfaces that touch are not linearised"});
    for (std::size_t i = 0; (modes || harmonic) && i < loads.size(); ++i)
      if (loads[i].volume)
        found.push_back({"loads[" + std::to_string(i) + "].volume",
                         "found together with modes or harmonic", "pressure",
                         "a given volume is no part of the tangent of small movements"});
    if (!harmonic || harmonic->face) return;
    if (harmonic->indenter) {
      if (!contacts.count(*harmonic->indenter))
        found.push_back({"harmonic.indenter", "no contact is called " + *harmonic->indenter,
                         "a name in contacts", ""});
    } else if (contacts.size() != 1) {
      found.push_back({"harmonic", "found " + std::to_string(contacts.size()) + " contacts",
                       "indenter: the name of one of them, or face: a node set", ""});
    }
  }
  // What does not go together with arc lengths, given volumes, branches and imperfections.
  void complain_of_instabilities(std::vector<Complaint>& found) const {
    std::string volume;
    for (std::size_t i = 0; i < loads.size(); ++i)
      if (loads[i].volume && volume.empty()) volume = "loads[" + std::to_string(i) + "].volume";
    const auto refuse = [&](const std::string& key, const char* with, const char* expected,
                            const char* hint) {
      found.push_back({key, std::string("found together with ") + with, expected, hint});
    };
    std::vector<std::string> keys;  // of what is asked for
    if (!volume.empty()) keys.push_back(volume);
    if (path.arc_length) keys.emplace_back("path.arc_length");
    if (branch) keys.emplace_back("branch");
    if (imperfection) keys.emplace_back("imperfection");
    for (const std::string& key : keys) {
      if (const auto* newton = std::get_if<NewtonOptions>(&solver); !newton)
        refuse(key, "solver.kinsol", "solver: {newton: {}}", "KINSOL has no room for its equation");
      else if (newton->linear == LinearBy::iterative)
        refuse(key, "solver.newton.linear: iterative", "direct or auto", "it needs a factor");
      if (accuracy || fidelity) refuse(key, key_of_accuracy().c_str(), "one of the two", no_levels);
      const bool estimates = estimate && *estimate != EstimateBy::none;
      if (estimates) refuse(key, "estimate", "estimate: none", no_levels);
      if (!sensitivity.empty())
        refuse(key, "sensitivity", "one of the two", "derivatives are those of given loads");
      if (uncertainty)
        refuse(key, "uncertainty", "one of the two", "derivatives are those of given loads");
      if (reduce == Reduce::automatic)
        refuse(key, "reduce: auto", "one of the two",
               "a section of its own: geometry: {section: ...}");
    }
    if (!volume.empty() && !contacts.empty())
      refuse(
          volume, "contacts", "a scene without indenters",
          "its equation cannot be solved together with those of contact yet: hold or move sets of nodes");
    if (!volume.empty() && path.arc_length)
      refuse("path.arc_length", "a given volume", "one of the two",
             "volumes grow where pressures turn back: no arc length is needed");
    for (std::size_t i = 0; path.arc_length && i < loads.size(); ++i)
      for (const auto& [key, history] : loads[i].histories_by_key()) {
        const std::string at = "loads[" + std::to_string(i) + "]." + key;
        if (!history.points.empty())
          refuse(at, "path.arc_length", "a number: a load in proportion to the load factor",
                 "the load factor turns back, and a history has no time to");
        if (key == "rotation.angle")
          refuse(at, "path.arc_length", "displacements and forces",
                 "a turn is not in proportion to the load factor");
      }
    for (const auto& [name, contact] : contacts) {
      if (!path.arc_length) break;
      const std::string at = "contacts." + name;
      if (contact.adhesion)
        refuse(at + ".adhesion", "path.arc_length", "one of the two",
               "bonds that let go shorten an increment by themselves");
      if (contact.rotation)
        refuse(at + ".rotation", "path.arc_length", "motion or control",
               "a turn is not in proportion to the load factor");
      if (contact.control && !contact.control->force.points.empty())
        refuse(at + ".control.force", "path.arc_length",
               "a number: a force in proportion to the load factor",
               "the load factor turns back, and a history has no time to");
      if (contact.motion.size() > 1 || (contact.motion.size() == 1 && contact.motion[0].t != 1))
        refuse(at + ".motion", "path.arc_length",
               "one point, {t: 1, to: [x, y, z]}: a way in proportion to the load factor",
               "the load factor turns back, and a history has no time to");
    }
    std::vector<std::string> of_modes;
    if (branch) of_modes.emplace_back("branch");
    if (imperfection) of_modes.emplace_back("imperfection");
    for (const std::string& key : of_modes) {
      if (stability == StabilityCheck::off)
        refuse(key, "stability: off", "stability: auto", "critical points are where signs change");
      if (path.seconds) refuse(key, "path.seconds", "a path without", "elastic bodies have modes");
      if (!contacts.empty())
        refuse(key, "contacts", "a scene without indenters", "modes with contact are written only");
      if (symmetry != SymmetryChoice::automatic && symmetry != SymmetryChoice::none)
        refuse(key, "symmetry", "symmetry: none or auto",
               "a mode may break it: the whole body is solved");
      if (mesh && !mesh->cuts.empty())
        refuse(key, "mesh.cuts", "a mesh without cuts", "nodes that hang follow no mode");
    }
    if (branch && imperfection)
      refuse("imperfection", "branch", "one of the two",
             "an imperfect body has no bifurcation: its path is the branch");
    if (branch && on_unstable == OnUnstable::stop)
      refuse("branch", "on_unstable: stop", "on_unstable: warn", "a branch may begin unstable");
  }
  static constexpr const char* no_levels =
      "errors are estimated of paths whose loads are given, on meshes of several sizes";
  // histories in seconds go from the beginning of the path to its end
  void complain_of_seconds(std::vector<Complaint>& found) const {
    const auto look_at = [&](const auto& points, const std::string& key) {
      if (points.empty() || !points.back().s) return;
      const double end = *points.back().s;
      const std::string last = key + "[" + std::to_string(points.size() - 1) + "].s";
      if (!path.seconds)
        found.push_back({last, "found seconds, and the path has none",
                         "path: {seconds: ...}, or t instead of s", ""});
      else if (end > *path.seconds * (1 + 1e-9))
        found.push_back(
            {last, "found a time behind the end of the path", "path.seconds at most", ""});
      else if (end < *path.seconds * (1 - 1e-9))
        found.push_back({last, "found a history shorter than the path",
                         "one that ends at path.seconds",
                         "a point more where the value stays to the end"});
    };
    for (const auto& [name, contact] : contacts) {
      if (contact.adhesion && contact.adhesion->viscosity > 0 && !path.seconds)
        found.push_back({"contacts." + name + ".adhesion.viscosity",
                         "found on a path without seconds", "path: {seconds: ...}", ""});
      if (contact.adhesion && std::holds_alternative<KinsolOptions>(solver))
        found.push_back(
            {"contacts." + name + ".adhesion", "found together with solver.kinsol",
             "solver: {newton: {}}",
             "bonds soften as they come loose, and KINSOL's rounds take them as fixed"});
      look_at(contact.motion, "contacts." + name + ".motion");
      if (contact.control)
        look_at(contact.control->force.points, "contacts." + name + ".control.force");
      if (contact.rotation) look_at(contact.rotation->points, "contacts." + name + ".rotation");
    }
    for (std::size_t i = 0; i < loads.size(); ++i)
      for (const auto& [key, history] : loads[i].histories_by_key())
        look_at(history.points, "loads[" + std::to_string(i) + "]." + key);
  }
};

// whether an estimate by refinement may follow the solve
inline bool by_refinement(const SolveConfig& config) {
  return config.estimate == EstimateBy::refinement || config.estimate == EstimateBy::automatic;
}

inline bool has_friction(const SolveConfig& config) {
  for (const auto& [name, contact] : config.contacts)
    if (contact.friction > 0) return true;
  return false;
}

}  // namespace langer

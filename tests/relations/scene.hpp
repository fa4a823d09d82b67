// A scene as values that can be turned, mirrored and rescaled, and the YAML that langer-solve
// reads.
//
// Mechanics knows no axes and no units. If a scene is turned, its displacements and forces have to
// turn with it. If all lengths are multiplied by L and all stresses by S, displacements have to be
// L times as large and forces S L^2 times. The functions below make such twins. A twin exercises
// code that its original does not: other axes, other loops over facets, other branches of a
// formula, another symmetry.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer::relations {

// Linear from 0 at t = 0 from point to point.
struct HistoryPoint {
  double t = 0;
  double value = 0;
};
using History = std::vector<HistoryPoint>;

// A number of a law with the power of stress in its unit.
struct Parameter {
  std::string key;
  double value = 0;
  int stress_power = 0;
};
struct Term {
  std::string key;
  std::vector<Parameter> parameters;
};
struct FibreFamily {
  Term law;
  double alpha = 0;  // [deg] from x towards z
  double kappa = 0;
};
struct Branch {
  double tau = 0;  // [s]
  double gamma = 0;
};
struct Law {
  Term matrix;
  std::vector<FibreFamily> fibres;
  Term volume;
  std::vector<Branch> viscous;
};
struct Layer {
  std::string name;
  double thickness = 0;
  Law law;
};

// Nodes in a box, as a set of this name; the facets of the surface between them belong to it.
struct BoxSet {
  std::string name;
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
};

enum class BodyKind { block, axisymmetric, plane_strain };
struct Body {
  BodyKind kind = BodyKind::block;
  std::string cells = "hex8";  // of a block also tet15: each hexahedron is divided into six
  Vec3 origin = Vec3::Zero();
  Vec3 size = Vec3::Zero();
  std::array<int, 3> divisions{};
  std::vector<Layer> layers;  // one: no layers
  std::vector<BoxSet> sets;
  std::optional<BoxSet> cut;     // a region of smaller hex8
  bool along_edges = false;      // fibre angles are measured in the frames of the cells
  bool from_file = false;        // the mesh is written as .inp and read
  Mat3 turn = Mat3::Identity();  // of the mesh in the file
};

struct Support {
  std::string on;
  std::array<bool, 3> hold{true, true, true};
};

enum class LoadKind { displacement, force, traction, pressure, rotation };
struct Load {
  std::string on;
  LoadKind kind = LoadKind::displacement;
  std::array<std::optional<History>, 3> along;  // of the first three kinds
  History history;                              // of the others: pressure [MPa] or angle [deg]
  Vec3 axis = Vec3::UnitY();                    // of a rotation
  Vec3 through = Vec3::Zero();
};

enum class ShapeKind { sphere, plane, cylinder, ellipsoid, aperture };
struct Waypoint {
  double t = 0;
  Vec3 to = Vec3::Zero();
};
struct Bonds {
  double work = 0;
  double stiffness = 0;
  double tangential = 0;
  double viscosity = 0;
  bool healing = false;
};
struct Push {
  History force;
  Vec3 along = -Vec3::UnitY();
};
struct Contact {
  std::string name;
  std::string on;  // empty: the nodes that it can reach
  ShapeKind shape = ShapeKind::sphere;
  Vec3 place = Vec3::Zero();  // centre, point of a plane, or centre of the face
  Vec3 axis = Vec3::UnitY();  // normal of a plane, or axis
  double radius = 0;
  double edge = 0;
  Vec3 half_axes = Vec3::Zero();
  double friction = 0;
  std::vector<Waypoint> motion;
  std::optional<Push> push;
  std::optional<History> rotation;  // [deg]
  std::optional<Bonds> bonds;
};

struct Scene {
  Body body;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<Contact> contacts;
  std::optional<double> seconds;
  bool equal_steps = false;  // path: steps instead of first and largest
  int increments = 4;
  std::string formulation;  // empty: the usual one
  std::string solver = "newton";
  double absolute = 1e-13;  // residual allowed without reactions [N]
  bool whole = false;       // no symmetry, no section, no homogeneous point

  bool viscous() const;
  bool frictionless() const;
  bool adheres() const;
};

// Multiplies lengths by `length` and stresses by `stress` and maps every vector by Q, orthogonal.
// A Q that is no signed permutation needs a block without layers, and turns its mesh in a file.
struct Change {
  Mat3 Q = Mat3::Identity();
  double length = 1;
  double stress = 1;
};
Scene changed(const Scene& scene, const Change& change);
bool permutes_axes(const Mat3& Q);

// Writes <name>.yaml, and <name>.inp where the mesh comes from a file; returns the path of the
// YAML.
std::filesystem::path write_scene(const Scene& scene, const std::filesystem::path& folder,
                                  const std::string& name);

}  // namespace langer::relations

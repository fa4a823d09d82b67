// One number of a solve config by its path, as `sensitivity` and the parameters of a fit name it:
//   contacts.ball.rigid.sphere.radius    loads[0].displacement.x    mesh.bodies[1].thickness
//
// The thickness of a flat layer is special. Another thickness moves the nodes of the mesh that is
// there, along y and in proportion to their height in the layer, so that what a scene answers is a
// smooth function of it. The side that an indenter touches stays where it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "scene/model/solve_config.hpp"

namespace langer {

// Nothing where the config has no such number.
std::optional<double> config_number(const SolveConfig& config, const std::string& path);

// The config with another value. A sphere of another radius touches where it touched: its centre
// moves back along its way. The mesh stays, but for paths that begin with mesh or bodies. Throws
// Failure(config) for a value that the config cannot have.
SolveConfig with_config_number(const SolveConfig& config, const std::string& path, double value);

// mm, deg, MPa or N by the name of the number; "-" for others
std::string unit_of_config_number(const std::string& path);

// The name of the contact whose shape a path such as contacts.<name>.rigid.sphere.radius means.
std::optional<std::string> contact_of_shape(const std::string& path);

struct LayerThickness {
  double bottom = 0, top = 0;  // y of its faces at rest [mm]
  bool top_stays = true;       // or the bottom

  double value() const { return top - bottom; }
  double rate(double y) const;  // by which a node at that height moves along y, per mm of thickness
  Mesh with(Mesh mesh, double thickness) const;
};

// Whether a path names a thickness: mesh.bodies[k].thickness of layers, or the size along y of a
// body without layers.
bool names_thickness(const std::string& path, const SolveConfig& config);

// Where its layer lies in the mesh. Nothing, and the reason in `why`, where it cannot be moved.
std::optional<LayerThickness> layer_thickness(const std::string& path, const SolveConfig& config,
                                              const Mesh& mesh, std::string& why);

}  // namespace langer

// Scenes of several bodies, and contact of deformable surfaces.
//
//   bodies:   {skin: {mesh: ..., material: ...}, pad: {mesh: ..., material: ...}}
//   contacts: {pad: {on: pad_bottom, against: skin_top, friction: 0.4}}
//
// The meshes become one mesh that shares no node between bodies. Sets, points and layers of a body
// are called <body>_<name>; a body without layers is called by its own name. What a body's config
// says of its material, fibres, supports and loads goes to the same lists as that of the scene.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "scene/model/scene.hpp"

namespace langer {

bool has_deformable_contact(const SolveConfig& config);

// The config as one scene; the tree is extended alike, so that keys keep their places. A scene
// without `bodies` and without `against` stays as it is.
void expand_bodies(SolveConfig& config, Tree& tree);

// one mesh of all bodies. Throws Failure(config) at the key of the body. notes: receives what was
// read otherwise than a geometry's file says.
Mesh mesh_of_bodies(const SolveConfig& config,
                    const std::function<Place(const std::string&)>& where,
                    std::vector<std::string>* notes = nullptr);
Mesh joined(const std::vector<std::pair<std::string, Mesh>>& bodies);

// (3 n) whether a support holds a degree of freedom
std::vector<char> held_by_supports(const SolveConfig& config, const Mesh& mesh);

// Adds scene.surfaces. Errors: a set without facets, surfaces that share nodes, bodies that
// overlap, a body that only frictionless contact holds.
void add_surfaces(Scene& scene, const SolveConfig& config, const Mesh& mesh,
                  const std::vector<Prescribed>& prescribed,
                  const std::function<Place(const std::string&)>& where,
                  std::vector<Error>& errors);

}  // namespace langer

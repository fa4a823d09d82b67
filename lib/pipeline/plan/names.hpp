// Checks of the names by which the configs of a pipeline refer to each other, before any program
// runs.
//
// A solve config names node sets and bodies of the mesh, and has one fibre angle for each fibre
// family of the material; a post config names observation points and quantities. Most of these
// names follow from the configs alone, so a wrong one is found before the mesh is made. A mesh that
// is read from a file may have any names: they are then checked when it has been read.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace langer {

struct Mesh;
struct Material;
struct MeshConfig;
struct SolveConfig;
struct PostConfig;

// The names that a mesh defines.
struct MeshNames {
  std::vector<std::string> sets, points, bodies;  // points are sets, too
};

// A name that a config refers to, with the key that refers to it.
struct NameReference {
  // place: the node set of a column; angles: the number of fibre angles
  enum class What { set, body, point, place, angles, family, contact };
  What what;
  std::string name, key;
  Place place;
  std::size_t number = 0;  // of angles; of the family
  // Number of families of the body's own material, if it has one.
  std::optional<std::size_t> families = {};
};

// The names that a config defines, and those that it refers to. An empty optional: not known from
// the configs alone.
struct SceneNames {
  std::optional<MeshNames> mesh;
  std::optional<std::size_t> families;  // of the material of the scene
  std::size_t more_families = 0;        // largest number of a body with a material of its own
  std::optional<bool> contacts;
  std::vector<NameReference> references;
};

using FindPlace = std::function<Place(const std::string& key)>;
// The names of a mesh, of a config that makes one, of a material, and of the configs that use them.
// `where`: the place of a key, for messages.
MeshNames names_of(const Mesh& mesh);
SceneNames names_in(const MeshConfig& config);
SceneNames names_in(const Material& material);
SceneNames names_in(const SolveConfig& config, const FindPlace& where);
SceneNames names_in(const PostConfig& config, const FindPlace& where);

// The references to names that do not exist, in the order of the config.
std::vector<Error> unknown_names(const SceneNames& names);

}  // namespace langer

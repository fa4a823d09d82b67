// Names that the parts of a scene call each other by, as far as configs alone tell them: what a
// mesh will have, and what a solve or a post asks for. So a name that leads nowhere is found before
// the mesh is made. A mesh from a file may have any: nothing is said then.
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

struct MeshNames {
  std::vector<std::string> sets, points, bodies;  // points are sets, too
};

struct AskedName {
  enum class What {
    set,
    body,
    point,
    place,
    angles,
    family,
    contact
  } what;  // place: set of a column
  std::string name, key;
  Place place;
  std::size_t number = 0;  // of angles; of the family
  std::optional<std::size_t> families =
      {};  // of the law that the angles are of, where it is not the general one
};

struct SceneNames {
  std::optional<MeshNames> mesh;
  std::optional<std::size_t> families;  // of the general law
  std::size_t more_families = 0;        // of bodies with a law of their own, at most
  std::optional<bool> contacts;
  std::vector<AskedName> asked;
};

using FindPlace = std::function<Place(const std::string& key)>;
MeshNames names_of(const Mesh& mesh);
SceneNames names_in(const MeshConfig& config);
SceneNames names_in(const Material& law);
SceneNames names_in(const SolveConfig& config, const FindPlace& where);
SceneNames names_in(const PostConfig& config, const FindPlace& where);

// those of `asked` that are not there, in the order of the config
std::vector<Error> lost_names(const SceneNames& names);

}  // namespace langer

// What a scene as a test refuses, at the place of its key.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "scene/model/scene_bodies.hpp"

namespace langer {

using FindPlace = std::function<Place(const std::string&)>;

[[noreturn]] inline void refuse_scene(const FindPlace& where, const std::string& key,
                                      std::string found, std::string expected,
                                      std::string hint = "") {
  throw Failure(Exit::config,
                Error{where(key), key, std::move(found), std::move(expected), std::move(hint)});
}

// Forces and derivatives of a fit are those of one body and of rigid indenters.
inline void refuse_several_bodies(const SolveConfig& config, const FindPlace& where,
                                  const std::string& key, const std::string& path) {
  if (config.bodies.empty() && !has_deformable_contact(config)) return;
  refuse_scene(where, key, path + " has several bodies or `against`",
               "one body, and rigid indenters",
               "the sweep of a pipeline varies numbers of such a scene");
}

}  // namespace langer

// What a scene as a test refuses, at the place of its key.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "core/base/error.hpp"

namespace langer {

using FindPlace = std::function<Place(const std::string&)>;

[[noreturn]] inline void refuse_scene(const FindPlace& where, const std::string& key,
                                      std::string found, std::string expected,
                                      std::string hint = "") {
  throw Failure(Exit::config,
                Error{where(key), key, std::move(found), std::move(expected), std::move(hint)});
}

}  // namespace langer

// A YAML file as it is written: `include` is a key like any other. For programs that edit the text.
#pragma once

#include "core/config/tree.hpp"

namespace langer {

Tree parse_yaml_as_written(const std::string& text, const std::string& shown_name);

}  // namespace langer

// Shares as users write them.
#pragma once

#include <optional>
#include <string>

namespace langer {

std::optional<double> percent_of(
    const std::string& text);  // "1%" or "1 %": 1; nothing where it is none above 0

}  // namespace langer

// "1 step", "2 steps", "3 bodies": how many of a thing, in words that one reads.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace langer {

inline std::string counted(std::size_t n, std::string_view one) {
  if (n == 1) return fmt::format("1 {}", one);
  if (one.ends_with('y')) {
    return fmt::format("{} {}ies", n, one.substr(0, one.size() - 1));
  }
  return fmt::format("{} {}s", n, one);
}

}  // namespace langer

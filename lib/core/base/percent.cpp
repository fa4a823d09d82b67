#include "core/base/percent.hpp"

#include <charconv>
#include <cmath>

namespace langer {

std::optional<double> percent_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string rest(end, text.data() + text.size());
  std::erase(rest, ' ');
  if (error != std::errc{} || rest != "%" || !std::isfinite(value) || !(value > 0))
    return std::nullopt;
  return value;
}

}  // namespace langer

// Arrays inside of a page: little-endian integers in base64 (RFC 4648). A field has two bytes per
// value, so the page shows it to 1/65535 of its range.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "report/json.hpp"

namespace langer::report {

inline std::string base64(const void* data, std::size_t n) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((n + 2) / 3 * 4);
  for (std::size_t i = 0; i < n; i += 3) {
    // Three bytes are four digits of 6 bits; "=" fills up the last group.
    const bool second = i + 1 < n;
    const bool third = i + 2 < n;
    unsigned b = bytes[i] << 16;
    if (second) b |= bytes[i + 1] << 8;
    if (third) b |= bytes[i + 2];
    text += digits[b >> 18];
    text += digits[b >> 12 & 63];
    text += second ? digits[b >> 6 & 63] : '=';
    text += third ? digits[b & 63] : '=';
  }
  return text;
}

template <class T>
std::string base64(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

// An array as a JSON string in base64, which needs no escapes.
template <class T>
Json packed(const std::vector<T>& values) {
  return {'"' + base64(values) + '"'};
}

// Smallest and largest finite value of a field over all its states.
struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(std::span<const double> values) {
    for (double v : values)
      if (std::isfinite(v)) {
        low = std::min(low, v);
        high = std::max(high, v);
      }
  }
  bool empty() const { return !(low <= high); }
};

// Values as integers from 0 (low) to 65534 (high). 65535 represents a value that is not finite.
inline std::vector<std::uint16_t> quantised(std::span<const double> values, const Span& span) {
  double per = 0;
  if (span.high > span.low) per = 65534 / (span.high - span.low);
  std::vector<std::uint16_t> levels;
  for (double v : values) {
    std::uint16_t level = 65535;
    if (std::isfinite(v)) level = static_cast<std::uint16_t>((v - span.low) * per + 0.5);
    levels.push_back(level);
  }
  return levels;
}

}  // namespace langer::report

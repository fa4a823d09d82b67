// Arrays as they travel in a page: little-endian integers in base64. A quantity takes two bytes per
// value, so that what a page shows is right to 1/65535 of its range.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace langer::report {

inline std::string base64(const void* data, std::size_t n) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::string text;
  text.reserve((n + 2) / 3 * 4);
  for (std::size_t i = 0; i < n; i += 3) {
    const unsigned b =
        bytes[i] << 16 | (i + 1 < n ? bytes[i + 1] << 8 : 0) | (i + 2 < n ? bytes[i + 2] : 0);
    text += digits[b >> 18];
    text += digits[b >> 12 & 63];
    text += i + 1 < n ? digits[b >> 6 & 63] : '=', text += i + 2 < n ? digits[b & 63] : '=';
  }
  return text;
}

template <class T>
std::string base64(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

// Least and largest finite value of a field over all its states.
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

// 0 ... 65534 from low to high; 65535 is not a number
inline std::vector<std::uint16_t> quantised(std::span<const double> values, const Span& span) {
  double per = 0;
  if (span.high > span.low) per = 65534 / (span.high - span.low);
  std::vector<std::uint16_t> packed;
  for (double v : values)
    packed.push_back(std::isfinite(v) ? static_cast<std::uint16_t>((v - span.low) * per + 0.5)
                                      : 65535);
  return packed;
}

}  // namespace langer::report

// Comparison of numbers in tests: CHECK(force == near(0.3, 1e-9)).
//
// doctest's own Approx adds 1 to the size of what it compares. With it a force of 1e-4 N would pass
// as 0 if 1e-3 were allowed, and nobody would notice. Here the tolerance is a share of the larger
// of the two numbers and of nothing else, so 0 is never near a number that is not 0.
//
// Where the exact value is 0, or is the small difference of large terms, no share of it can be
// asked for. Then name an absolute tolerance, in the unit of the numbers, and say in a comment what
// its size follows from: CHECK(torque == near(0, 0, 1e-12 * force * length)).
#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace langer::test {

class Near {
 public:
  Near(double expected, double relative, double absolute)
      : expected_(expected), relative_(relative), absolute_(absolute) {}

  bool is_near(double found) const {
    found_ = found;
    const double allowed =
        std::max(absolute_, relative_ * std::max(std::abs(found), std::abs(expected_)));
    return std::abs(found - expected_) <= allowed;
  }

  // doctest asks for it after a comparison that failed
  friend doctest::String toString(const Near& n) {
    const double difference = n.found_ - n.expected_;
    const double largest = std::max(std::abs(n.found_), std::abs(n.expected_));
    std::string text = fmt::format(
        "near({:.17g}): found {:.17g}, difference {:.3g}, relative {:.3g}; allowed {:g}",
        n.expected_, n.found_, difference, difference / largest, n.relative_);
    if (n.absolute_ > 0) {
      text += fmt::format(" or {:g} absolute", n.absolute_);
    }
    return text.c_str();
  }

 private:
  double expected_;
  double relative_;
  double absolute_;
  mutable double found_ = 0;  // of the last comparison
};

template <class Number>
requires std::is_arithmetic_v<Number>
bool operator==(Number found, const Near& expected) {
  return expected.is_near(static_cast<double>(found));
}

}  // namespace langer::test

namespace langer {

// The default is for a few operations whose result differs from the exact one by rounding alone.
inline test::Near near(double expected, double relative = 1e-12, double absolute = 0) {
  return {expected, relative, absolute};
}

}  // namespace langer

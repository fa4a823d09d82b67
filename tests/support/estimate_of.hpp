// The error estimate of a quantity by its name; the test fails where there is none.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "accuracy/estimate/error_estimate.hpp"

namespace langer::test {

inline const ErrorEstimate& estimate_of(const std::vector<ErrorEstimate>& errors,
                                        const std::string& name) {
  for (const ErrorEstimate& e : errors) {
    if (e.of.name == name) return e;
  }
  FAIL("no estimate of ", name);
  return errors.front();
}

}  // namespace langer::test

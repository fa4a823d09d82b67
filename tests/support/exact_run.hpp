// A path in equal increments whose contacts obey their law at every step.
#pragma once

#include <doctest/doctest.h>

#include <vector>

#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/solve/statics.hpp"

namespace langer::test {

struct ExactPath {
  PathReport path;
  std::vector<int> iterations;
};

inline ExactPath run(Statics& statics, double increment) {
  LoadPathOptions options;
  options.first = options.largest = increment;
  ExactPath result;
  result.path = load_path(
      options, 0, {}, {},
      [&](double t) {
        statics.begin(t);
        return newton(statics.problem(), statics.trial(), {});
      },
      [&](double, double, double, const SolveReport& report) {
        statics.accept();
        for (const ContactDefect& d : statics.defects()) {
          CHECK(d.penetration <= 1e-9);
          CHECK(d.cone <= 1e-8);
          CHECK(d.complementarity <= 1e-8);
        }
        result.iterations.push_back(report.iterations);
        return true;
      });
  return result;
}

}  // namespace langer::test

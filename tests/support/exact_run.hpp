// A path in equal increments whose contacts obey their law at every step.
#pragma once

#include <doctest/doctest.h>

#include <vector>

#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/solve/increment.hpp"

namespace langer::test {

struct ExactPath {
  PathReport path;
  std::vector<int> iterations;
};

inline ExactPath run(Increment& increment, double length) {
  LoadPathOptions options;
  options.first = options.largest = length;
  ExactPath result;
  result.path = load_path(
      options, 0, {}, {},
      [&](double t) {
        increment.begin(t);
        return newton(increment.problem(), increment.trial(), {});
      },
      [&](double, double, double, const SolveReport& report) {
        increment.accept();
        for (const ContactDefect& d : increment.defects()) {
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

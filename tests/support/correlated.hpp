// Biaxial tests of a known law with noise that is correlated along each curve, for what intervals
// hold.
#pragma once

#include <algorithm>

#include "core/base/random.hpp"
#include "identification/fit/fit.hpp"
#include "support/laws.hpp"

namespace langer::test {

// three protocols of n points, stress along both axes; HGO-Yeoh with five free numbers
inline FitProblem protocols(int n) {
  FitProblem q;
  q.law = stable(30, 1e-6);
  std::get<HgoFibre>(q.law.fibres[0].law).c2 = 2;
  q.free = {{"matrix.yeoh.a1", 0.05, -10, 10},
            {"matrix.yeoh.a2", 0.05, -10, 10},
            {"fibres[0].hgo.c1", 0.10, -10, 10},
            {"fibres[0].hgo.c2", 2, 0, 20},
            {"fibres[0].alpha", 30, -90, 90}};
  for (const auto& [rx, rz] : {std::pair{1., 1.}, {1., 0.4}, {0.4, 1.}}) {
    Test t;
    t.kind = TestKind::biaxial, t.measure = StressMeasure::nominal;
    for (int i = 1; i <= n; ++i)
      t.first.push_back(1 + 0.35 * rx * i / n), t.second.push_back(1 + 0.35 * rz * i / n);
    t.stress_x.resize(t.first.size()), t.stress_z.resize(t.first.size());
    std::vector<double> s(t.values());
    if (model_stress(q.law, t, Dilatation::incompressible, s.data())) {
      const auto middle = s.begin() + static_cast<std::ptrdiff_t>(t.points());
      t.stress_x.assign(s.begin(), middle), t.stress_z.assign(middle, s.end());
    }
    q.tests.push_back(t);
  }
  return q;
}

// Pulled to 1.3 in 0.5 s, held for 60 s in points that get sparser, back and held once more;
// branches of 0.1, 1 (of strength `middle`) and 10 s.
inline FitProblem relaxation_record(double middle) {
  FitProblem q;
  q.law = neo_hooke(0.05, 1e-6);
  q.law.viscous = {{0.1, 0.4, BranchOf::all}, {1, middle, BranchOf::all}, {10, 0.2, BranchOf::all}};
  q.free = {{"matrix.neo_hooke.a1", 0.05, 0, 10},
            {"viscous[0].gamma", 0.4, 0, 10},
            {"viscous[1].gamma", 0.3, 0, 10},
            {"viscous[2].gamma", 0.2, 0, 10}};
  Test t;
  t.measure = StressMeasure::nominal;
  const auto point = [&](double seconds, double stretch) {
    t.time.push_back((t.time.empty() ? 0 : t.time.back()) + seconds), t.first.push_back(stretch);
  };
  point(0, 1);
  for (double to : {1.3, 1.15}) {
    const double from = t.first.back();
    for (int i = 1; i <= 10; ++i) point(0.05, from + (to - from) * i / 10);
    double step = 0.05;
    for (double held = 0; held < 60; held += step) point(step = std::min(1.2 * step, 2.), to);
  }
  t.stress_x.resize(t.first.size());
  if (model_stress(q.law, t, Dilatation::incompressible, t.stress_x.data())) q.tests = {t};
  return q;
}

// e_i = rho e_(i-1) + sqrt(1 - rho^2) deviation normal, begun as it goes on
inline void add_noise(std::vector<double>& stress, double deviation, double rho, Random& random) {
  double e = deviation * random.normal();
  for (double& s : stress)
    s += e, e = rho * e + std::sqrt(1 - rho * rho) * deviation * random.normal();
}

inline FitProblem noisy(FitProblem q, double deviation, double rho, std::uint64_t seed) {
  Random random(123, seed);
  for (Test& t : q.tests)
    add_noise(t.stress_x, deviation, rho, random), add_noise(t.stress_z, deviation, rho, random);
  return q;
}

inline double largest_of(const FitProblem& q) {
  double s = 0;
  for (const Test& t : q.tests) s = std::max(s, largest_stress(t));
  return s;
}

}  // namespace langer::test

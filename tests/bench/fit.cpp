// A whole identification: five biaxial protocols of 90 points, HGO-Yeoh with its angle, profiles
// and 200 bootstrap samples.
#include "identification/fit/fit.hpp"

#include <fmt/format.h>

#include <chrono>

#include "core/base/random.hpp"
#include "identification/statistics/study.hpp"
#include "support/laws.hpp"

using namespace langer;

void measure_fit() {
  FitProblem problem;
  problem.law = test::stable(62, 1e-6);
  for (const auto& [name, rx, rz] : {std::tuple{"offx", 0.5, 1.},
                                     {"offy", 1., 0.5},
                                     {"equibiaxial", 1., 1.},
                                     {"stripx", 1., 0.},
                                     {"stripy", 0., 1.}}) {
    Test t;
    t.name = name, t.kind = TestKind::biaxial, t.measure = StressMeasure::nominal;
    for (int i = 1; i <= 90; ++i)
      t.first.push_back(1 + rx * 0.4 * i / 90), t.second.push_back(1 + rz * 0.4 * i / 90);
    std::vector<double> s(180);
    if (!model_stress(problem.law,
                      {name, t.kind, t.measure, t.shear, 0, 1, t.first, t.second,
                       std::vector<double>(90), std::vector<double>(90)},
                      Dilatation::incompressible, s.data()))
      return;
    Random random(3, problem.tests.size());
    for (double& x : s) x += 0.007 * random.normal();
    t.stress_x.assign(s.begin(), s.begin() + 90), t.stress_z.assign(s.begin() + 90, s.end());
    problem.tests.push_back(t);
  }
  problem.free = {{"matrix.yeoh.a1", 0.02, 0, 10}, {"matrix.yeoh.a2", 0.02, 0, 10},
                  {"matrix.yeoh.a3", 0.02, 0, 10}, {"fibres[0].hgo.c1", 0.1, 0, 10},
                  {"fibres[0].hgo.c2", 1, 0, 10},  {"fibres[0].alpha", 45, -90, 90}};
  StudyConfig config;
  config.threads = 2, config.stability = false;
  const auto start = std::chrono::steady_clock::now();
  const FitResult found = fit(problem, {.starts = 10});
  const auto fitted = std::chrono::steady_clock::now();
  const StudyRecord record = study(problem, found, config);
  const auto seconds = [](auto from, auto to) {
    return std::chrono::duration<double>(to - from).count();
  };
  fmt::print(
      "fit: 5 protocols, 450 points, 6 parameters, 10 starts {:.1f} s; profiles, {} bootstrap samples and advice {:.1f} s "
      "on 2 threads (wall); alpha = {:.2f}, KKT {:.0e}\n",
      seconds(start, fitted), record.identifiability->bootstrap.rows(),
      seconds(fitted, std::chrono::steady_clock::now()), found.best.p[5], found.best.kkt);
}

// Contact problems with known solutions: one or two contacts solved by hand, random ones judged by
// the law itself, and the folder named by LANGER_FRICTION_ORACLE (solutions to 1e-14) where it is
// present.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "contact/random_problem.hpp"
#include "mechanics/contact/local_problem.hpp"

using namespace langer;

namespace {

LocalProblem problem_from(const nlohmann::json& j) {
  LocalProblem p;
  const int k = j["n_contacts"];
  p.W.resize(3 * k, 3 * k), p.q.resize(3 * k), p.mu.resize(k);
  for (int i = 0; i < 3 * k; ++i) {
    p.q[i] = j["q"][i];
    for (int c = 0; c < 3 * k; ++c) p.W(i, c) = j["W"][i][c];
  }
  for (int i = 0; i < k; ++i) p.mu[i] = j["mu"][i];
  return p;
}

}  // namespace

TEST_CASE("every reference problem is solved to 1e-10 in the relative position and in W r") {
  const char* named = std::getenv("LANGER_FRICTION_ORACLE");
  const std::filesystem::path folder = named ? named : SOURCE_DIR "/../shared/oracle/friction";
  if (!std::filesystem::is_directory(folder)) {
    MESSAGE("skipped: no folder " << folder.string() << " (set LANGER_FRICTION_ORACLE)");
    return;
  }
  int solved = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".json") continue;
    CAPTURE(file.path().string());
    const auto j = nlohmann::json::parse(std::ifstream(file.path()));
    const LocalProblem p = problem_from(j);
    VecX r = VecX::Zero(p.q.size()), reference(p.q.size()), x_reference(p.q.size());
    for (int i = 0; i < r.size(); ++i) reference[i] = j["r"][i], x_reference[i] = j["u"][i];
    const LocalReport report = solve_local(p, r);
    MESSAGE(file.path().filename().string()
            << ": " << report.sweeps << " sweeps, " << report.newton_steps
            << " Newton steps, residual " << report.residual);
    CHECK(report.converged);
    CHECK((p.W * r + p.q - x_reference).lpNorm<Eigen::Infinity>() <= 1e-10);
    CHECK((p.W * (r - reference)).lpNorm<Eigen::Infinity>() <= 1e-10);
    ++solved;
  }
  CHECK(solved > 0);
}

TEST_CASE("a thousand random problems of up to eight contacts satisfy the law") {
  int failed = 0;
  for (int seed = 0; seed < 1000; ++seed) {
    const int k = 1 + seed % 8;
    const LocalProblem p = test::random_problem(seed, k);
    VecX r = VecX::Zero(3 * k);
    const LocalReport report = solve_local(p, r);
    const double scale = std::max(1.0, r.lpNorm<Eigen::Infinity>());
    if (!(test::law_defect(p, r) <= 1e-9 * scale)) {
      ++failed;
      MESSAGE("seed " << seed << ", " << k << " contacts: defect " << test::law_defect(p, r)
                      << ", residual " << report.residual);
    }
  }
  CHECK(failed == 0);
}

TEST_CASE("however small the budget, what counts as solved satisfies the law to 1e-11") {
  int solved = 0;
  for (int seed = 0; seed < 100; ++seed)
    for (int sweeps : {4, 8, 16, 32, 64, 128}) {
      const LocalProblem p = test::random_problem(seed, 1 + seed % 8);
      LocalOptions few;
      few.sweeps = sweeps, few.newton_steps = 0;
      VecX r = VecX::Zero(p.q.size());
      const LocalReport report = solve_local(p, r, few);
      if (!report.converged) continue;
      ++solved;
      CHECK(report.residual <= 1e-11);
      CHECK(test::law_defect(p, r) <= 1e-9 * std::max(1.0, r.lpNorm<Eigen::Infinity>()));
    }
  CHECK(solved > 100);
}

// Two contacts that push each other down harder than they hold themselves: no forces keep both out,
// and sweeps grow a million times with each contact. Their end does not come from counting sweeps
// that will never be made.
TEST_CASE("forces that run away end the search at once, without convergence and finite") {
  LocalProblem p;
  p.W.setIdentity(6, 6);
  p.W(0, 3) = p.W(3, 0) = -1e6;
  p.q.setZero(6);
  p.q[0] = p.q[3] = -1;
  p.mu = Eigen::Vector2d(0.3, 0);
  for (double start : {0.0, 1.0}) {
    VecX r = VecX::Constant(6, start);
    const LocalReport report = solve_local(p, r);
    CHECK_FALSE(report.converged);
    CHECK(r.allFinite());
    CHECK(report.sweeps < 2000);
  }
}

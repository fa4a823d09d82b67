// Contact problems with known solutions: one or two contacts solved by hand, random ones judged by the law itself,
// and the folder named by LANGER_FRICTION_ORACLE (solutions to 1e-14) where it is present.
#include <doctest/doctest.h>

#include <Eigen/QR>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "contact/local_problem.hpp"

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

// how far r is from the law, without the solver's own measure: gap, cone, dissipation
double law_defect(const LocalProblem& p, const VecX& r) {
  const VecX x = p.W * r + p.q;
  double defect = 0;
  for (int i = 0; i < p.n_contacts(); ++i) {
    const double r_n = r[3 * i], r_t = std::hypot(r[3 * i + 1], r[3 * i + 2]), x_n = x[3 * i];
    const double slip = std::hypot(x[3 * i + 1], x[3 * i + 2]), mu = p.mu[i];
    const double power = r_n * x_n + mu * r_n * slip + (mu > 0 ? r[3 * i + 1] * x[3 * i + 1] + r[3 * i + 2] * x[3 * i + 2] : 0);
    defect = std::max({defect, -r_n, -x_n, r_t - mu * r_n, std::abs(power)});
  }
  return defect;
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
            << ": " << report.sweeps << " sweeps, " << report.newton_steps << " Newton steps, residual " << report.residual);
    CHECK(report.converged);
    CHECK((p.W * r + p.q - x_reference).lpNorm<Eigen::Infinity>() <= 1e-10);
    CHECK((p.W * (r - reference)).lpNorm<Eigen::Infinity>() <= 1e-10);
    ++solved;
  }
  CHECK(solved > 0);
}

TEST_CASE("random problems, ill-conditioned and rank-deficient ones included, satisfy the law") {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  int failed = 0;
  for (int seed = 0; seed < 200; ++seed) {
    const int k = 1 + seed % 8;
    const int rank = seed % 5 == 0 ? std::max(1, 3 * k - 2) : 3 * k;
    MatX A(3 * k, rank);
    for (auto& a : A.reshaped()) a = normal(random);
    if (seed % 3 == 0)
      for (int c = 0; c < rank; ++c) A.col(c) *= std::pow(10, -2.0 * c / rank);
    LocalProblem p{A * A.transpose(), VecX(3 * k), VecX(k)};
    for (auto& q : p.q) q = normal(random);
    for (auto& mu : p.mu) mu = seed % 4 == 0 ? 0 : uniform(random);
    if (rank < 3 * k) p.q = A * VecX::NullaryExpr(rank, [&] { return normal(random); });  // in the range: a solution exists
    VecX r = VecX::Zero(3 * k);
    const LocalReport report = solve_local(p, r);
    const double scale = std::max(1.0, r.lpNorm<Eigen::Infinity>());
    if (!(law_defect(p, r) <= 1e-9 * scale)) {
      ++failed;
      MESSAGE("seed " << seed << ", " << k << " contacts: defect " << law_defect(p, r) << ", residual " << report.residual);
    }
  }
  CHECK(failed == 0);
}

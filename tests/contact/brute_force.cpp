// Random friction problems against a search through every combination of states: open (r = 0),
// stick (x = 0), and slip, whose direction is found by Newton's method from many directions for
// each contact. It shares nothing with the solver under test.
#include <doctest/doctest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "contact/random_problem.hpp"
#include "mechanics/contact/local_problem.hpp"
#include "support/near.hpp"
#include "support/slow_build.hpp"

using namespace langer;

namespace {

enum class State { open, stick, slip };

// of three contacts at most, without the heap
using SmallVec = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 9, 1>;
using SmallMat = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 9, 9>;

// Newton's method for one combination. Unknowns z: three forces for a contact that sticks, normal
// force and direction for one that slips. What must vanish: x where it sticks; where it slips x_n,
// and x_t across the direction of slip.
class Combination {
 public:
  Combination(const LocalProblem& p, std::vector<State> states)
      : p_(p), W_(p.W), q_(p.q), states_(std::move(states)) {
    for (State state : states_) {
      if (state == State::slip) angles.push_back(n_ + 1);
      n_ += state == State::stick ? 3 : state == State::slip ? 2 : 0;
    }
  }

  SmallVec solve(const SmallVec& directions) const {
    SmallVec z = SmallVec::Zero(n_);
    for (std::size_t a = 0; a < angles.size(); ++a)
      z[angles[a]] = directions[static_cast<Eigen::Index>(a)];
    for (int iteration = 0; iteration < 20 && n_ > 0; ++iteration) {
      auto [f, J] = linearised(z);
      if (iteration == 0)  // the forces that these directions ask for; they do not turn yet
        for (int a : angles) J.row(a).setZero(), J.col(a).setZero(), J(a, a) = 1, f[a] = 0;
      const SmallVec step = Eigen::CompleteOrthogonalDecomposition<SmallMat>(J).solve(f);
      z -= step;
      if (iteration > 0 && step.norm() < 1e-14 * (1 + z.norm())) break;
    }
    return reactions(z);
  }

  std::vector<int> angles;  // places of directions among the unknowns

 private:
  SmallVec reactions(const SmallVec& z) const {
    SmallVec r = SmallVec::Zero(p_.q.size());
    for (int i = 0, at = 0; i < p_.n_contacts(); ++i) {
      if (states_[i] == State::stick) r.segment<3>(3 * i) = z.segment<3>(at), at += 3;
      if (states_[i] == State::slip) {
        r.segment<3>(3 * i) =
            z[at] * Vec3(1, -p_.mu[i] * std::cos(z[at + 1]), -p_.mu[i] * std::sin(z[at + 1]));
        at += 2;
      }
    }
    return r;
  }

  std::pair<SmallVec, SmallMat> linearised(const SmallVec& z) const {
    SmallMat dr = SmallMat::Zero(p_.q.size(), n_);  // of r by z
    for (int i = 0, at = 0; i < p_.n_contacts(); ++i) {
      if (states_[i] == State::stick) dr.block<3, 3>(3 * i, at).setIdentity(), at += 3;
      if (states_[i] == State::slip) {
        const double c = std::cos(z[at + 1]), s = std::sin(z[at + 1]);
        dr.block<3, 1>(3 * i, at) = Vec3(1, -p_.mu[i] * c, -p_.mu[i] * s);
        dr.block<3, 1>(3 * i, at + 1) = z[at] * p_.mu[i] * Vec3(0, s, -c);
        at += 2;
      }
    }
    const SmallVec x = W_ * reactions(z) + q_;
    const SmallMat dx = W_ * dr;
    SmallVec f(n_);
    SmallMat J(n_, n_);
    for (int i = 0, at = 0; i < p_.n_contacts(); ++i) {
      if (states_[i] == State::stick)
        f.segment<3>(at) = x.segment<3>(3 * i), J.middleRows<3>(at) = dx.middleRows<3>(3 * i),
        at += 3;
      if (states_[i] == State::slip) {
        const double c = std::cos(z[at + 1]), s = std::sin(z[at + 1]);
        f[at] = x[3 * i], J.row(at) = dx.row(3 * i);
        f[at + 1] = c * x[3 * i + 2] - s * x[3 * i + 1],
               J.row(at + 1) = c * dx.row(3 * i + 2) - s * dx.row(3 * i + 1);
        J(at + 1, at + 1) -= s * x[3 * i + 2] + c * x[3 * i + 1];
        at += 2;
      }
    }
    return {f, J};
  }

  const LocalProblem& p_;
  const SmallMat W_;
  const SmallVec q_;
  std::vector<State> states_;
  int n_ = 0;
};

std::vector<SmallVec> every_solution(const LocalProblem& p) {
  std::vector<SmallVec> found;
  const int k = p.n_contacts();
  for (int code = 0; code < std::pow(3, k); ++code) {
    std::vector<State> states;
    for (int i = 0, c = code; i < k; ++i, c /= 3) states.push_back(static_cast<State>(c % 3));
    const Combination combination(p, states);
    const auto n = static_cast<Eigen::Index>(combination.angles.size());
    const int each = n == 1   ? 200
                     : n == 2 ? 16
                              : 6;  // the basin of a nearly jammed contact is narrow
    for (int start = 0; start < std::pow(each, n); ++start) {
      SmallVec directions(n);
      for (int a = 0, s = start; a < n; ++a, s /= each)
        directions[a] = 2 * M_PI * (s % each + 0.3) / each;
      const SmallVec r = combination.solve(directions);
      if (r.allFinite() &&
          test::law_defect(p, r) <= 1e-9 * std::max(1.0, r.lpNorm<Eigen::Infinity>()))
        found.push_back(r);
    }
  }
  return found;
}

}  // namespace

TEST_CASE("a thousand random problems have the solution that a search through all states finds") {
  int none = 0, wrong = 0, several = 0;
  for (int seed = 0; seed < 1000; seed += test::stride) {
    const LocalProblem p = test::random_problem(seed, 1 + seed % 3);
    VecX r = VecX::Zero(p.q.size());
    CHECK(solve_local(p, r).converged);
    const auto all = every_solution(p);
    if (all.empty()) {
      ++none;
      MESSAGE("seed " << seed << ": the search finds nothing; defect of the solver's answer "
                      << test::law_defect(p, r));
      continue;
    }
    double nearest = 1e300;
    for (const auto& s : all)
      nearest = std::min(nearest, (p.W * (r - s)).lpNorm<Eigen::Infinity>());
    several += std::any_of(all.begin(), all.end(),
                           [&](const auto& s) { return (p.W * (s - all[0])).norm() > 1e-6; });
    const double scale = std::max(1.0, (p.W * r).lpNorm<Eigen::Infinity>());
    if (!(nearest <= 1e-8 * scale)) {
      ++wrong;
      MESSAGE("seed " << seed << ", " << p.n_contacts() << " contacts: W r differs by " << nearest
                      << " from the nearest of " << all.size() << " solutions; defect "
                      << test::law_defect(p, r));
    }
  }
  MESSAGE(several << " with more than one solution, " << none << " where the search finds none");
  CHECK(wrong == 0);
  CHECK(none <= 2);  // where forces are 1e4 times the rest, the search misses; the solver does not
}

TEST_CASE("of several solutions of an indefinite problem the one next to the start is found") {
  // x = 1 - 2 r: both r = 0 with x = 1 and r = 1/2 with x = 0 fulfil the law.
  const LocalProblem problem{Vec3(-2, 1, 1).asDiagonal(), Vec3(1, 0, 0), VecX::Zero(1)};
  const auto found_from = [&](double start, bool next_to_start) {
    VecX r = Vec3(start, 0, 0);
    LocalOptions options;
    options.next_to_start = next_to_start;
    const LocalReport report = solve_local(problem, r, options);
    CHECK(report.converged);
    CHECK(test::law_defect(problem, r) < 1e-12);
    return r[0];
  };
  CHECK(found_from(0.4, true) == near(0.5));
  CHECK(found_from(0.1, true) == 0);
  CHECK(found_from(0.4, false) == 0);
}

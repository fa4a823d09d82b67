// The low-discrepancy sequence: Joe and Kuo's first points, even in one and two dimensions whatever
// the shift.
#include "identification/sensitivity/sobol_sequence.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "identification/sensitivity/sobol.hpp"
#include "support/near.hpp"

using namespace langer;

TEST_CASE(
    "every axis of a shifted Sobol' sequence holds one of its first 2^k points in each of 2^k parts") {
  for (Eigen::Index dimensions : {1, 7, 40, 3667}) {
    CAPTURE(dimensions);
    SobolSequence sequence(dimensions, Random(3, static_cast<std::uint64_t>(dimensions)));
    constexpr int n = 64;
    MatX points(n, dimensions);
    for (int i = 0; i < n; ++i) points.row(i) = sequence.next().transpose();
    CHECK(points.minCoeff() > 0);
    CHECK(points.maxCoeff() < 1);
    bool even = true;
    for (Eigen::Index j = 0; j < dimensions; ++j) {
      std::vector<int> count(n, 0);
      for (int i = 0; i < n; ++i) ++count[static_cast<std::size_t>(points(i, j) * n)];
      for (int c : count) even = even && c == 1;
    }
    CHECK(even);
  }
}

TEST_CASE("a sequence that begins later goes on with the same points") {
  SobolSequence whole(5, Random(4));
  std::vector<VecX> points;
  for (int i = 0; i < 40; ++i) points.push_back(whole.next());
  for (std::uint32_t from : {0u, 1u, 2u, 7u, 32u}) {
    SobolSequence part(5, Random(4), from);
    for (std::size_t i = from; i < 40; ++i) CHECK(part.next() == points[i]);
  }
}

TEST_CASE(
    "the first two axes are even together, and the sequence is Sobol's: its points differ from each other as theirs do") {
  SobolSequence sequence(3, Random(9));
  constexpr int n = 64;
  MatX points(n, 3);
  for (int i = 0; i < n; ++i) points.row(i) = sequence.next().transpose();
  // a (0, 6, 2) net: one point in every elementary box of volume 1/64
  for (int a = 0; a <= 6; ++a) {
    std::map<std::pair<int, int>, int> count;
    for (int i = 0; i < n; ++i)
      ++count[{static_cast<int>(points(i, 0) * (1 << a)),
               static_cast<int>(points(i, 1) * (1 << (6 - a)))}];
    CHECK(count.size() == n);
  }
  // Joe and Kuo's points 0, 1, 2, 3 in three dimensions, in Gray code's order: exclusive ors of the
  // leading bits
  const double first[4][3] = {{0, 0, 0}, {0.5, 0.5, 0.5}, {0.75, 0.25, 0.25}, {0.25, 0.75, 0.75}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 3; ++j) {
      const int ours = static_cast<int>(points(i, j) * 4) ^ static_cast<int>(points(0, j) * 4);
      CHECK(ours == static_cast<int>(first[i][j] * 4));
    }
}

TEST_CASE(
    "Sobol's shares by the sequence are several times nearer to the truth than by random samples") {
  //   product of (|4 x_i - 2| + a_i)/(1 + a_i)
  const VecX a = (VecX(4) << 0, 1, 4.5, 9).finished();
  const CurveMaker maker = [&]() -> ParametricCurve {
    return [&](const VecX& x, VecX& y) {
      y = VecX::Ones(1);
      for (Eigen::Index i = 0; i < 4; ++i) y[0] *= (std::abs(4 * x[i] - 2) + a[i]) / (1 + a[i]);
      return true;
    };
  };
  double V = 1;
  for (double x : a) V *= 1 + 1 / (3 * (1 + x) * (1 + x));
  VecX total(4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double own = 1 / (3 * (1 + a[i]) * (1 + a[i]));
    total[i] = own * V / (1 + own) / (V - 1);
  }
  for (long n : {64L, 512L, 4096L}) {
    CAPTURE(n);
    const auto error = [&](Sequence sequence) {
      double square = 0;
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SamplingOptions options;
        options.seed = seed, options.sequence = sequence, options.resamples = 0;
        square +=
            (sobol(maker, VecX::Zero(4), VecX::Ones(4), n, options).total.value.col(0) - total)
                .squaredNorm();
      }
      return std::sqrt(square);
    };
    CHECK(error(Sequence::sobol) < (n == 64 ? 0.8 : 0.5) * error(Sequence::random));
  }
}

TEST_CASE("random samples stay within reach, as old configs had them") {
  const CurveMaker maker = []() -> ParametricCurve {
    return [](const VecX& x, VecX& y) {
      y = x;
      return true;
    };
  };
  SamplingOptions options;
  options.sequence = Sequence::random, options.seed = 5;
  const Sobol s = sobol(maker, VecX::Zero(1), VecX::Ones(1), 640, options);
  double mean = 0;
  for (std::uint64_t row = 0; row < 640; ++row) {
    Random random(5, row);
    mean += (random.uniform() + random.uniform()) / 1280;
  }
  CHECK(s.mean[0] == near(mean, 1e-12));
}

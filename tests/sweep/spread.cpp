// What a fit leaves open, from a sweep over sets of its parameters: closed form for a linear
// quantity, bands of curves.
#include "pipeline/sweep/spread.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "core/base/random.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

// p ~ N((1, 2), [[0.04, 0.03], [0.03, 0.09]]), F = 3 p1 + p2
struct Sampled {
  std::vector<std::vector<Summary>> sets;
  SweepColumn force{"force", "N", {}};
  Sampled() {
    for (int k = 0; k < 4000; ++k) {
      Random random(3, static_cast<std::uint64_t>(k));
      const double z1 = random.normal(), z2 = random.normal();
      const double p1 = 1 + 0.2 * z1, p2 = 2 + 0.15 * z1 + std::sqrt(0.09 - 0.0225) * z2;
      force.values.push_back(3 * p1 + p2);
      sets.push_back(
          {{"parameter_a1", p1, "MPa"}, {"parameter_c1", p2, "MPa"}, {"parameter_d", 5, "1/MPa"}});
    }
  }
};

}  // namespace

TEST_CASE(
    "the spread of a linear quantity is that of its covariance, and what is left without a parameter its conditional one") {
  const Sampled s;
  const auto parameters = sampled_parameters(s.sets);
  REQUIRE(parameters.size() == 2);  // d does not vary
  const Spread spread = spread_of(s.force, parameters);
  const double variance = 9 * 0.04 + 2 * 3 * 0.03 + 0.09;
  CHECK(spread.mean == near(5, 0.01));
  CHECK(spread.deviation == near(std::sqrt(variance), 0.04));
  CHECK(spread.low == near(5 - 1.96 * std::sqrt(variance), 0.03));
  CHECK(spread.high == near(5 + 1.96 * std::sqrt(variance), 0.03));
  // g^T C g less (C g)_j^2/C_jj
  const double without_a1 = std::sqrt(variance - std::pow(3 * 0.04 + 0.03, 2) / 0.04),
               without_c1 = std::sqrt(variance - std::pow(3 * 0.03 + 0.09, 2) / 0.09);
  REQUIRE(spread.parts.size() == 2);
  CHECK(spread.parts[0].name == "a1");
  CHECK(spread.parts[0].without == near(without_a1, 0.05));
  CHECK(spread.parts[1].without == near(without_c1, 0.05));
  CHECK(in_words(spread).find("if a1 were known") != std::string::npos);
  CHECK(spread_csv({spread}).starts_with(
      "quantity,unit,mean,standard_deviation,lower_95,upper_95,without_a1,without_c1\nforce,N,"));
}

TEST_CASE("members without a value are left out of a spread, and one value has none") {
  const SweepColumn p{"parameter_a1", "MPa", {1, 2, 3, 4}};
  const Spread some = spread_of({"force", "N", {1, std::nan(""), 3, 4}}, {p});
  CHECK(some.mean == near(8.0 / 3));
  // the root of a variance that rounding leaves: sqrt(eps) = 1.5e-8 of the deviation
  CHECK(some.parts.at(0).without == near(0, 0, 1e-7 * some.deviation));
  CHECK(std::isnan(
      spread_of({"force", "N", {1, std::nan(""), std::nan(""), std::nan("")}}, {p}).deviation));
}

TEST_CASE("a band is read between the rows of curves that have other places") {
  const Column x0{"u_ind", "mm", {0, 1, 2}}, x1{"u_ind", "mm", {0, 0.5, 2}},
      y0{"force", "N", {0, 2, 4}}, y1{"force", "N", {0, 2, 8}};
  const Band band = band_of("force", {&x0, &x1}, {&y0, &y1});
  CHECK(band.mean.values[1] == near(3));  // 2 and 4
  CHECK(band.deviation.values[1] == near(std::sqrt(2)));
  CHECK(band.mean.values[2] == near(6));
  CHECK(band.deviation.values[0] == 0);
}

#include "pipeline/sweep/gather.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "core/base/error.hpp"

using namespace langer;

namespace {
const std::vector<GatherInput> members{
    {"code_FER/alpha_000/post/curves.h5",
     {"FER", "0"},
     {{"force", 1.5, "N"}, {"J", 1, "-"}, {"u_y", -0.25, "mm"}}},
    {"code_FER/alpha_030/post/curves.h5", {"FER", "30"}, {{"force", 0.1, "N"}, {"c1", 2, "1/MPa"}}},
};
const std::vector<SweepAxis> axes{{"code", "-", {}}, {"alpha", "deg", {}}};
}  // namespace

TEST_CASE(
    "a row per member: axes first, then all quantities of the first member, what is absent is an empty cell") {
  CHECK(csv(gather({}, axes, members)) ==
        "code,alpha_deg,force_N,J,u_y_mm\nFER,0,1.5,1,-0.25\nFER,30,0.1,,\n");
}

TEST_CASE("columns come in the order asked for, and from whichever member has them") {
  CHECK(csv(gather({"c1", "force"}, axes, members)) ==
        "code,alpha_deg,c1_per_MPa,force_N\nFER,0,,1.5\nFER,30,2,0.1\n");
}

TEST_CASE("NaN in a summary is an empty cell too") {
  auto some = members;
  some[0].summary[0].value = std::numeric_limits<double>::quiet_NaN();
  CHECK(csv(gather({"force"}, {}, some)) == "force_N\n\n0.1\n");
}

TEST_CASE("a quantity that no member has is refused with those there are") {
  CHECK_THROWS_WITH_AS(
      gather({"forse"}, axes, members, {"table.yaml", 3, 1}),
      "table.yaml:3:1: columns: no member has a quantity \"forse\"; expected one of force, J, u_y, c1\n"
      "  hint: did you mean \"force\"?",
      Failure);
}

TEST_CASE("a quantity whose unit differs between members is refused") {
  auto some = members;
  some[1].summary[0].unit = "kN";
  CHECK_THROWS_AS(gather({"force"}, axes, some), Failure);
}

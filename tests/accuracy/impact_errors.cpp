// Error bars of impacts against the same scenes on finer meshes with shorter increments. More of
// them are drawn by langer-bench motion.
#include "accuracy/estimate/impact_errors.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "accuracy/bouncing_ball.hpp"

using namespace langer;
using test::FlyingBall;
using test::Impact;

namespace impact_errors_tests {

namespace {

// Bars that are not as long as their value, and hold what the reference finds.
void check_bars(const std::vector<ErrorEstimate>& errors, const Impact& reference) {
  for (const ErrorEstimate& e : errors) {
    CAPTURE(e.of.name);
    MESSAGE(e.of.name << " " << e.of.value << " +- " << e.total() << ", off by "
                      << e.of.value - reference.of(e.of.name));
    CHECK(std::abs(e.of.value - reference.of(e.of.name)) <= e.total());
    CHECK(e.total() < 0.3 * e.of.value);
  }
}

std::set<std::string> names_of(const std::vector<ErrorEstimate>& errors) {
  std::set<std::string> out;
  for (const ErrorEstimate& e : errors) out.insert(e.of.name);
  return out;
}

const std::set<std::string> all{"contact_time", "peak_force", "restitution"};

}  // namespace

TEST_CASE("bars of an impact hold what finer meshes and shorter increments find") {
  for (const FlyingBall& ball : {FlyingBall{2.5, 300, 2}, FlyingBall{4, 150, 1}}) {
    CAPTURE(ball.radius);
    const SolveConfig config = test::bounce(12, ball, "step: 1.5e-4");
    const auto errors = test::errors_of(config, test::impact_of(config));
    CHECK(names_of(errors) == all);
    check_bars(errors, test::impact_of(test::bounce(30, ball, "step: 0.6e-4")));
  }
}

TEST_CASE("increments that follow from an error have bars of an impact, too") {
  const SolveConfig config = test::bounce(12, {}, "error: 0.2%");
  const auto errors = test::errors_of(config, test::impact_of(config));
  CHECK(names_of(errors) == all);
  check_bars(errors, test::impact_of(test::bounce(20, {}, "error: 0.1%")));
}

TEST_CASE("a path that ends in contact has a bar of its peak force, and no contact time") {
  SolveConfig config = test::bounce(12, {}, "step: 1.5e-4");
  config.path.seconds = 4e-3;
  CHECK(names_of(test::errors_of(config, test::impact_of(config))) ==
        std::set<std::string>{"peak_force"});
}

}  // namespace impact_errors_tests

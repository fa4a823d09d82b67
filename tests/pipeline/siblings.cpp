// Which members of a sweep over fibre angles may be images of another one.
#include "pipeline/plan/siblings.hpp"

#include <doctest/doctest.h>

using namespace langer;
using namespace langer::pipeline;

namespace siblings_tests {

namespace {

Tree no_file(const std::string& path) {
  FAIL("reads " << path);
  return {};
}

// "20 70<20 160<20": each member and of which it may be the image
std::string offered(const std::string& angles, const std::string& config) {
  std::vector<Step> steps =
      expand(read_pipeline(parse_yaml(
                 "pipeline: p\nnodes:\n  solve: {stage: solve, config: {" + config +
                     "}, sweep: {alpha: {key: \"fibre_angles[0]\", values: [" + angles + "]}}}\n",
                 "p.yaml")),
             no_file);
  offer_siblings(steps);
  std::string found;
  for (const Step& step : steps) {
    const auto angle = [](const std::string& path) {
      return path.substr(6, 3);
    };
    found += (found.empty() ? "" : " ") + angle(step.folder);
    for (const StepInput& input : step.inputs)
      if (input.port == "mirror") found += "<" + angle(input.path);
  }
  return found;
}

}  // namespace

TEST_CASE(
    "an earlier member is offered where the angles are those of an image, a mirror before a quarter turn") {
  const std::string one = "fibre_angles: [0]";
  CHECK(offered("20, 70, 110, 160, 180, 0", one) == "020 070<020 110<070 160<020 180 000<180");
  CHECK(offered("10, 30, 45, 55", one) == "010 030 045 055");
  CHECK(offered("0, 90, 45, 135", one) == "000 090<000 045 135<045");
}

TEST_CASE("all families have to fit; what asks for its own solution gets none") {
  const std::string two = "fibre_angles: [0, 10]";
  CHECK(offered("20, 160", two) == "020 160");  // (20, 10) becomes (160, 170)
  CHECK(offered("80, 100", two) == "080 100");
  CHECK(offered("20, 200", two) == "020 200<020");
  CHECK(offered("20, 200", two + ", symmetry: none") == "020 200");
  CHECK(offered("20, 200", two + ", accuracy: 1%") == "020 200");
  CHECK(offered("20, 200", two + ", estimate: recovery") == "020 200");
}

}  // namespace siblings_tests

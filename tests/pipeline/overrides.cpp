#include "pipeline/plan/overrides.hpp"

#include <doctest/doctest.h>

#include <string>

#include "core/base/error.hpp"
#include "core/config/writer.hpp"
#include "pipeline/plan/expand.hpp"

using namespace langer;
using namespace langer::pipeline;

namespace {

const char* const written =
    "pipeline: p\nnodes:\n  mesh: {stage: mesh, config: {geometry: {block: {size: [1, 1, 1], divisions: [1, 1, 1]}}}}\n"
    "  solve: {stage: solve, mesh: mesh, material: law.yaml, config: {threads: 1, fibre_angles: [0]}, set: {threads: 2},\n"
    "          sweep: {alpha: {key: \"fibre_angles[0]\", values: [0, 60]}}}\n";

std::vector<Step> steps_after(const Overrides& overrides) {
  Tree tree = parse_yaml(written, "p.yaml");
  apply(overrides, tree);
  return expand(read_pipeline(tree), [](const std::string&) { return Tree{}; });
}

std::string refused(const Overrides& overrides) {
  try {
    steps_after(overrides);
  } catch (const Failure& f) {
    return f.what();
  }
  return "";
}

std::string at(const Tree& config, const std::string& key) {
  const Tree* found = config.find(key);
  return found ? found->scalar : "missing";
}

}  // namespace

TEST_CASE("a typed value replaces what the pipeline sets, and adds what it does not") {
  const auto steps = steps_after({{"solve.threads=3", "solve.path.first=0.5"}, {}});
  CHECK(steps.size() == 3);
  for (const Step& s : steps)
    if (s.node == "solve") {
      CHECK(at(s.config, "threads") == "3");
      CHECK(at(*s.config.find("path"), "first") == "0.5");
    }
}

TEST_CASE("a typed sweep is one like any other, and may have a name of its own") {
  const auto steps =
      steps_after({{}, {"solve.path.first=[0.1, 0.2, 0.5]", "half:mesh.scale=[1, 2]"}});
  CHECK(steps.size() == 2 + 2 * 2 * 3);  // meshes; meshes, angles, increments
  CHECK(steps.back().folder.find("first_000.5") != std::string::npos);
  CHECK(steps.back().folder.find("half_002") != std::string::npos);
  CHECK(steps_after({{}, {"alpha:solve.fibre_angles[0]=[0, 30, 90]"}}).size() ==
        4);  // the axis that is there with other values
}

TEST_CASE("what is typed wrongly is refused with what would be right") {
  CHECK(refused({{"solv.threads=1"}, {}}).find("did you mean \"solve\"") != std::string::npos);
  for (const char* wrong : {"threads=1", "solve.threads", ".threads=1", "solve.=1", "=1", ""})
    CHECK(refused({{wrong}, {}}).find("node.key=value") != std::string::npos);
  CHECK(refused({{}, {"solve.threads=2"}}).find("a list of values") != std::string::npos);
  CHECK(refused({{"solve.fibre_angles[0]=30"}, {}}).find("varied by the axis \"alpha\"") !=
        std::string::npos);
  CHECK(refused({{}, {"solve.threads=[]"}}).find("at least one") != std::string::npos);
}

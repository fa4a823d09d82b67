#include "pipeline/plan/expand.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "core/config/writer.hpp"
#include "pipeline/plan/makefile.hpp"

using namespace langer;
using namespace langer::pipeline;

namespace {

Tree no_file(const std::string& path) {
  throw Failure(Exit::input, Error{{path, 0, 0}, "", "there is no such file", "", ""});
}

std::vector<Step> steps_of(const std::string& text) {
  return expand(read_pipeline(parse_yaml(text, "p.yaml")), no_file);
}

std::vector<std::string> folders(const std::vector<Step>& steps, const std::string& node) {
  std::vector<std::string> found;
  for (const Step& s : steps)
    if (s.node == node) found.push_back(s.folder);
  return found;
}

const Step& step(const std::vector<Step>& steps, const std::string& folder) {
  const auto it =
      std::find_if(steps.begin(), steps.end(), [&](const Step& s) { return s.folder == folder; });
  REQUIRE(it != steps.end());
  return *it;
}

using Words = std::vector<std::string>;

const std::string two_axes = R"(
pipeline: p
nodes:
  mesh: {stage: mesh, config: {size: 1}}
  solve: {stage: solve, mesh: mesh, config: {angles: [0], d: 1},
          set: {path.steps: 10},
          sweep: {code: {variants: {FER: {d: 2, form: full}, ANSYS: }}, alpha: {key: "angles[0]", values: [0, 30, 7.5], unit: deg}}}
  post: {stage: post, solution: solve, sweep: {code: {variants: {FER: {stress: a}, ANSYS: {stress: b}}}}}
  table: {stage: gather, curves: post, over: [code, alpha]}
  by_code: {stage: gather, curves: post, over: alpha}
)";

}  // namespace

TEST_CASE("a node's axes are its own and those of its inputs, `over` removes them") {
  const auto steps = steps_of(two_axes);
  CHECK(folders(steps, "mesh") == Words{"mesh"});
  const Words members{"code_FER/alpha_000/",   "code_FER/alpha_030/",   "code_FER/alpha_007.5/",
                      "code_ANSYS/alpha_000/", "code_ANSYS/alpha_030/", "code_ANSYS/alpha_007.5/"};
  Words solve, post;
  for (const std::string& m : members) solve.push_back(m + "solve"), post.push_back(m + "post");
  CHECK(folders(steps, "solve") == solve);
  CHECK(folders(steps, "post") == post);
  CHECK(folders(steps, "table") == Words{"table"});
  CHECK(folders(steps, "by_code") == Words{"code_FER/by_code", "code_ANSYS/by_code"});
  CHECK(steps.size() == 1 + 6 + 6 + 1 + 2);
}

TEST_CASE("each member gets its values, `set` comes before them") {
  const auto steps = steps_of(two_axes);
  CHECK(to_text(step(steps, "code_FER/alpha_030/solve").config) ==
        "angles: [30]\nd: 2\npath:\n  steps: 10\nform: full\n");
  CHECK(to_text(step(steps, "code_ANSYS/alpha_007.5/solve").config) ==
        "angles: [7.5]\nd: 1\npath:\n  steps: 10\n");
}

TEST_CASE("an axis that two nodes declare is one axis, with settings for each of them") {
  const auto steps = steps_of(two_axes);
  CHECK(to_text(step(steps, "code_FER/alpha_000/post").config) == "stress: a\n");
  CHECK(to_text(step(steps, "code_ANSYS/alpha_000/post").config) == "stress: b\n");
}

TEST_CASE("inputs are those of the same member, a gathering node gets all of them in order") {
  const auto steps = steps_of(two_axes);
  const Step& post = step(steps, "code_ANSYS/alpha_030/post");
  REQUIRE(post.inputs.size() == 1);
  CHECK(post.inputs[0].path == "code_ANSYS/alpha_030/solve/solution.h5");
  CHECK(step(steps, "code_ANSYS/alpha_030/solve").inputs[0].path == "mesh/mesh.h5");
  const Step& by_code = step(steps, "code_FER/by_code");
  REQUIRE(by_code.inputs.size() == 3);
  CHECK(by_code.inputs[1].path == "code_FER/alpha_030/post/curves.h5");
  const Step& table = step(steps, "table");
  REQUIRE(table.inputs.size() == 6);
  CHECK(table.inputs[3].path == "code_ANSYS/alpha_000/post/curves.h5");
  const std::string text = to_text(table.config);
  CHECK(text.find("axes:\n  - name: code\n    unit: \"-\"\n  - name: alpha\n    unit: deg\n") !=
        std::string::npos);
  CHECK(text.find("  - path: code_FER/alpha_007.5/post/curves.h5\n    at: [FER, \"7.5\"]\n") !=
        std::string::npos);
}

TEST_CASE("steps come after what they read, whatever the order of the nodes") {
  const auto steps = steps_of(
      "pipeline: p\nnodes:\n  post: {stage: post, solution: solve}\n  solve: {stage: solve, mesh: mesh}\n  mesh: {stage: "
      "mesh}\n");
  Words order;
  for (const Step& s : steps) order.push_back(s.node);
  CHECK(order == Words{"mesh", "solve", "post"});
  CHECK_FALSE(steps[0].final);
  CHECK_FALSE(steps[1].final);
  CHECK(steps[2].final);
}

TEST_CASE("one member of a swept node can be picked: its axis ends there") {
  const auto steps = steps_of(R"(
pipeline: p
nodes:
  fit: {stage: fit, config: {a: 1}, sweep: {law: {variants: {Yeoh: {a: 2}, HGO-Yeoh: }}, start: {key: b, values: [1, 2]}}}
  rank: {stage: sensitivity, material: {node: fit, law: HGO-Yeoh}}
)");
  CHECK(folders(steps, "rank") == Words{"start_001/rank", "start_002/rank"});
  CHECK(step(steps, "start_002/rank").inputs[0].path == "law_HGO-Yeoh/start_002/fit/material.h5");
  CHECK_THROWS_WITH_AS(
      steps_of("pipeline: p\nnodes:\n  fit: {stage: fit, sweep: {law: {variants: {Yeoh: }}}}\n"
               "  rank: {stage: sensitivity, material: {node: fit, law: Gent}}\n"),
      "p.yaml:4:30: nodes.rank.material.law: found Gent; expected one of Yeoh", Failure);
  CHECK_THROWS_WITH_AS(
      steps_of(
          "pipeline: p\nnodes:\n  fit: {stage: fit}\n  rank: {stage: sensitivity, material: {node: fit, law: Gent}}\n"),
      "p.yaml:4:30: nodes.rank.material.law: the node fit has no such axis; expected none: it has one member",
      Failure);
}

TEST_CASE("a variant may be another config file") {
  std::vector<std::string> read;
  const auto steps =
      expand(read_pipeline(parse_yaml(
                 "pipeline: p\nnodes:\n  fit: {stage: fit, config: base.yaml, set: {x: 1}, "
                 "sweep: {law: {variants: {A: a.yaml, B: {y: 2}}}}}\n",
                 "p.yaml")),
             [](const std::string& path) { return parse_yaml("from: " + path, path); });
  CHECK(to_text(step(steps, "law_A/fit").config) == "from: a.yaml\nx: 1\n");
  CHECK(to_text(step(steps, "law_B/fit").config) == "from: base.yaml\nx: 1\ny: 2\n");
}

TEST_CASE("folders of numbers sort like the numbers, every folder is safe for make") {
  pipeline::Axis axis{"alpha", "deg", true, {}, {}};
  for (const char* label : {"0", "7.5", "30", "180", "0.25"})
    axis.points.push_back({label, {}, {}});
  Words names;
  for (std::size_t i = 0; i < axis.points.size(); ++i) names.push_back(member_folder(axis, i));
  CHECK(names == Words{"alpha_000", "alpha_007.5", "alpha_030", "alpha_180", "alpha_000.25"});
  for (const std::string& name : names) CHECK(is_safe_path(name));
  axis.points = {{"-5", {}, {}}, {"1000", {}, {}}, {"1e-06", {}, {}}};
  CHECK(member_folder(axis, 0) == "alpha_-0005");
  CHECK(member_folder(axis, 1) == "alpha_1000");
  CHECK(member_folder(axis, 2) == "alpha_1e-06");
  for (const char* unsafe :
       {"a b", "a=b", "a:b", "a$b", "a%b", "a#b", "a;b", "a\nb", "a&b", "a*b", "", "ä"}) {
    CAPTURE(unsafe);
    CHECK_FALSE(is_safe_path(unsafe));
  }
}

TEST_CASE("the way a number is typed does not change its member") {
  const auto steps = steps_of(
      "pipeline: p\nnodes:\n  mesh: {stage: mesh, sweep: {n: {key: a, values: [1.0e+1, +2.50, word]}}}\n");
  CHECK(folders(steps, "mesh") == Words{"n_10/mesh", "n_2.5/mesh", "n_word/mesh"});
}

TEST_CASE("a port of several files takes a list of nodes, each with its members") {
  const auto steps = steps_of(two_axes + R"(
  page: {stage: report, table: [table, by_code], curves: {node: post, code: FER}, over: [code, alpha]}
)");
  const Step& page = step(steps, "page");
  Words paths;
  for (const StepInput& input : page.inputs) paths.push_back(input.port + " " + input.path);
  CHECK(paths == Words{"curves code_FER/alpha_000/post/curves.h5",
                       "curves code_FER/alpha_030/post/curves.h5",
                       "curves code_FER/alpha_007.5/post/curves.h5", "table table/sweep.h5",
                       "table code_FER/by_code/sweep.h5", "table code_ANSYS/by_code/sweep.h5"});
  CHECK_FALSE(page.config.find("members"));
  CHECK_THROWS_AS(steps_of(two_axes + "  other: {stage: post, solution: [solve]}\n"), Failure);
}

TEST_CASE("one axis may set several keys") {
  const auto steps = steps_of(
      "pipeline: p\nnodes:\n  mesh: {stage: mesh, sweep: {n: {keys: [a, b.c], values: [4]}}}\n");
  CHECK(to_text(steps.at(0).config) == "a: 4\nb:\n  c: 4\n");
}

TEST_CASE("a recipe is one plain command with a launcher in front, programs are order-only") {
  const std::string text = makefile_text(
      "p.yaml", "../../build/bin",
      {{"a/mesh.h5", {"a/mesh.yaml"}, "langer-mesh", "a/mesh.yaml"},
       {"b/x.h5", {"b/x.yaml", "a/mesh.h5"}, "langer-x", "b/x.yaml --mesh a/mesh.h5"}},
      {"b/x.h5"});
  CHECK(text.find("\nall: b/x.h5\n") != std::string::npos);
  CHECK(
      text.find(
          "\nb/x.h5: b/x.yaml a/mesh.h5 $(if $(STRICT),$(BIN)/langer-x) | $(BIN)/langer-x\n"
          "\t$(if $(VERBOSE),,$(info making $@)@)$(LAUNCH) $(BIN)/langer-x b/x.yaml --mesh a/mesh.h5 "
          "$(if $(VERBOSE),-v )--log $(basename $@).log -o $@\n") != std::string::npos);
  for (const char* line : {".DELETE_ON_ERROR:", "LAUNCH ?=", "BIN ?= ../../build/bin"}) {
    CAPTURE(line);
    CHECK(text.find(std::string("\n") + line) != std::string::npos);
  }
}

TEST_CASE("a grid is one axis of all combinations, named by their values") {
  const auto steps = steps_of(
      "pipeline: p\nnodes:\n  solve: {stage: solve, config: {path: {steps: 1}}, sweep: {level: {grid: {mesh.edge: [0.3, 0.25], path.steps: "
      "[4, 10, 20]}}}}\n  post: {stage: post, solution: solve}\n  front: {stage: tune, curves: post, over: level}\n");
  CHECK(folders(steps, "solve") == Words{"level_0.3-4/solve", "level_0.3-10/solve",
                                         "level_0.3-20/solve", "level_0.25-4/solve",
                                         "level_0.25-10/solve", "level_0.25-20/solve"});
  const Step& one = step(steps, "level_0.25-10/solve");
  CHECK(one.config.find("mesh")->find("edge")->scalar == "0.25");
  CHECK(one.config.find("path")->find("steps")->scalar == "10");
  CHECK(folders(steps, "front") == Words{"front"});
  CHECK(step(steps, "front").inputs.size() == 6);
}

TEST_CASE(
    "a grid without keys, values or numbers of combinations that end is refused with its place") {
  const auto said = [](const std::string& grid) -> std::string {
    try {
      steps_of("pipeline: p\nnodes:\n  solve: {stage: solve, config: {}, sweep: {level: {grid: " +
               grid + "}}}\n");
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "accepted";
  };
  CHECK(said("{d: [1, 2]}") == "accepted");
  CHECK(said("{}").find("p.yaml:3") != std::string::npos);
  CHECK(said("{d: []}").find("a list of values") != std::string::npos);
  CHECK(said("{d: 1}").find("nodes.solve.sweep.level.grid.d") != std::string::npos);
  CHECK(said("{d: [{a: 1}]}") != "accepted");
  CHECK(said("{d: [a/b]}") != "accepted");
  CHECK(said("{d: [1, 1]}") != "accepted");
  std::string many = "[0";
  for (int i = 1; i < 200; ++i) many += ", " + std::to_string(i);
  CHECK(said("{a: " + many + "], b: " + many + "]}").find("10000") != std::string::npos);
}

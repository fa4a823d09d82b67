// Keys and words by their former names: read as what they are called now, with one notice.
#include <doctest/doctest.h>

#include "core/base/former.hpp"
#include "identification/setup/fit_config_io.hpp"
#include "pipeline/plan/run_files.hpp"
#include "scene/model/solve_config.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/continued.hpp"

using namespace langer;

namespace {

enum class Colour { red, blue };
constexpr auto names(Colour) { return std::array{"red", "blue"}; }
constexpr auto former_names(Colour) { return std::array{FormerWord{"azure", "blue"}}; }

struct Inner {
  int size = 1;
  static void fields(auto& v) {
    v(&Inner::size, "size", unit::none, "a number", Formerly{"length"});
  }
};
struct Outer {
  std::optional<Colour> colour;
  std::vector<Inner> parts;
  static void fields(auto& v) {
    v(&Outer::colour, "colour", unit::none, "a word");
    v(&Outer::parts, "parts", unit::none, "structs");
  }
};

std::string refusal(const std::string& text) {
  try {
    read_config<Outer>(parse_yaml(text, "text"));
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "accepted";
}

template <class Config>
std::string hash(const Loaded<Config>& loaded) {
  return identity_of("stage", config_text(loaded.config), loaded.where, {}, "").config_hash;
}

const std::string solve =
    "mesh: {geometry: {indented_block: {origin: [-15, 0, -15], size: [30, 4, 30], radius: 2.5, depth: 1}}}\n"
    "supports: [{on: y_min, hold: [y]}]\nloads: [{on: y_max, displacement: {y: 1}}]\n";

}  // namespace

TEST_CASE(
    "a former key and a former word give what the new ones give, each with one notice and its place") {
  const auto now =
      read_config<Outer>(parse_yaml("colour: blue\nparts: [{size: 1}, {size: 3}]\n", "text"));
  const auto old =
      read_config<Outer>(parse_yaml("colour: azure\nparts: [{size: 1}, {length: 3}]\n", "text"));
  CHECK(now.notices.empty());
  CHECK(to_yaml(old.config) == to_yaml(now.config));
  CHECK(old.notices == std::vector<std::string>{"text:1:1: colour: azure is now called blue",
                                                "text:2:21: parts[1]: length is now called size"});
}

TEST_CASE(
    "a key beside its former name is refused, and neither former keys nor former words are offered") {
  CHECK(refusal("parts: [{size: 1, length: 3}]\n")
            .find("parts[0].length: found together with size") != std::string::npos);
  const std::string unknown = refusal("colour: gren\nparts: [{lengt: 3}]\n");
  CHECK(unknown.find("expected one of red, blue") != std::string::npos);
  CHECK(unknown.find("known: size") != std::string::npos);
  CHECK(unknown.find("azure") == std::string::npos);
}

TEST_CASE("what is set later, or stands beside an include, holds under either name") {
  const auto with = [](const std::string& text, const std::string& key) {
    Tree tree = parse_yaml(text, "fit.yaml", SOURCE_DIR "/configs/fit");
    if (!key.empty()) set_value(tree, key, parse_yaml("none", "--set"));
    return read_config<FitConfig>(std::move(tree));
  };
  const std::string shipped = "include: biaxial_hgo_yeoh.yaml\n";  // cross_check: nlopt
  CHECK(with(shipped, "").config.cross_check == SecondAnswer::nlopt);
  const auto over = with(shipped + "check: none\n", "");
  CHECK(over.config.cross_check == SecondAnswer::none);
  CHECK(over.notices.size() == 1);
  CHECK(with("include: abdomen.yaml\ncheck: nlopt\n", "cross_check").config.cross_check ==
        SecondAnswer::none);
}

TEST_CASE(
    "what `check` and `second_rung` were called gives the same hash of the config, and keeps steps") {
  const auto fit_of = [](const std::string& key) {
    return read_config<FitConfig>(parse_yaml("include: abdomen.yaml\n" + key + ": nlopt\n",
                                             "fit.yaml", SOURCE_DIR "/configs/fit"));
  };
  const auto old_fit = fit_of("check"), new_fit = fit_of("cross_check");
  CHECK(hash(old_fit) == hash(new_fit));
  CHECK(new_fit.notices.empty());
  CHECK(old_fit.notices ==
        std::vector<std::string>{"fit.yaml:2:1: check is now called cross_check"});

  const auto solve_of = [](const std::string& word) {
    return read_config<SolveConfig>(parse_yaml(solve + "estimate: " + word + "\n", "solve.yaml"));
  };
  const auto old_solve = solve_of("second_rung"), new_solve = solve_of("refinement");
  CHECK(hash(old_solve) == hash(new_solve));
  CHECK(with_steps_hash({}, old_solve.config).steps_hash ==
        with_steps_hash({}, new_solve.config).steps_hash);
  CHECK(new_solve.notices.empty());
  CHECK(old_solve.notices ==
        std::vector<std::string>{"solve.yaml:4:1: estimate: second_rung is now called refinement"});
}

#include "pipeline/plan/run_files.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

using namespace langer;
namespace fs = std::filesystem;

namespace {

struct Small {
  double d = 1;
  InputPath curve;
  static void fields(auto& v) {
    v(&Small::d, "d", unit::none, "a number");
    v(&Small::curve, "curve", unit::none, "a file", required);
  }
};

struct Folder {
  fs::path root = fs::temp_directory_path() / ("langer_run_files_" + std::to_string(getpid()));
  Folder() {
    fs::remove_all(root);
    fs::create_directories(root / "here");
    fs::create_directories(root / "there/deep");
    put("here/c.csv", "1,2\n");
    put("there/deep/c.csv", "1,2\n");
    put("here/a.yaml", "d: 2\ncurve: c.csv\n");
    put("there/a.yaml", "# the same\ncurve: deep/c.csv\nd: 2.0\n");
  }
  ~Folder() { fs::remove_all(root); }
  std::string at(const std::string& name) const { return (root / name).string(); }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(root / name) << text;
  }
};

Identity identity(const std::string& config_file, const InputFiles& inputs = {}) {
  const auto loaded = read_config<Small>(load_yaml(config_file));
  return identity_of("fit", config_text(loaded.config), loaded.where, inputs, "langer-fit");
}

}  // namespace

TEST_CASE("a result's identity is what went into it, not where that lies or how it is typed") {
  Folder folder;
  const Identity here = identity(folder.at("here/a.yaml")),
                 there = identity(folder.at("there/a.yaml"));
  CHECK(here.config_hash == there.config_hash);
  CHECK(here.inputs == there.inputs);
  CHECK(content_id(here, 1) == content_id(there, 1));
  folder.put("here/c.csv", "1,3\n");
  CHECK(identity(folder.at("here/a.yaml")).config_hash == there.config_hash);
  CHECK(content_id(identity(folder.at("here/a.yaml")), 1) != content_id(there, 1));
  folder.put("there/a.yaml", "curve: deep/c.csv\nd: 2.5\n");
  CHECK(identity(folder.at("there/a.yaml")).config_hash != here.config_hash);
}

TEST_CASE("a YAML file at a port counts by its values") {
  Folder folder;
  folder.put("m.yaml", "a: {b: 1}  # one\n");
  const Identity before = identity(folder.at("here/a.yaml"), {{"material", {folder.at("m.yaml")}}});
  folder.put("m.yaml", "# two\na:\n  b: 1\n");
  CHECK(identity(folder.at("here/a.yaml"), {{"material", {folder.at("m.yaml")}}}).inputs ==
        before.inputs);
  folder.put("m.yaml", "a: {b: 2}\n");
  CHECK(identity(folder.at("here/a.yaml"), {{"material", {folder.at("m.yaml")}}}).inputs !=
        before.inputs);
}

TEST_CASE("a file that a config names must be there") {
  Folder folder;
  fs::remove(folder.at("here/c.csv"));
  CHECK_THROWS_WITH_AS(identity(folder.at("here/a.yaml")),
                       (folder.at("here/a.yaml") + ":2:1: curve: " + folder.at("here/c.csv") +
                        ": there is no such file")
                           .c_str(),
                       Failure);
}

TEST_CASE("an output may not be a folder, replace what it is made from, or lie below a file") {
  Folder folder;
  const std::string config = folder.at("here/a.yaml");
  check_output(folder.at("new/deep/out.h5"), config, {});
  CHECK(fs::is_directory(folder.at("new/deep")));
  for (const std::string& bad : {folder.at("there"), config, folder.at("there/../here/a.yaml"),
                                 folder.at("here/c.csv"), folder.at("here/c.csv/out.h5")}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(check_output(bad, config, {{"curve", {folder.at("here/c.csv")}}}), Failure);
  }
  CHECK(fs::is_regular_file(folder.at("here/c.csv")));
  for (const std::string& input :
       {config, folder.at("there/../here/a.yaml"), folder.at("here/c.csv")})  // whatever it holds
    CHECK_THROWS_WITH_AS(check_output(input, config, {{"curve", {folder.at("here/c.csv")}}}),
                         (input + ": the output would replace an input").c_str(), Failure);
}

TEST_CASE("--set replaces a value, and says so where it cannot") {
  Tree tree = parse_yaml("a: {b: [1, 2]}\n", "text");
  apply_setting(tree, "a.b[1]=3");
  apply_setting(tree, "a.c={d: x=y}");
  CHECK(to_text(tree) == "a:\n  b: [1, 3]\n  c:\n    d: x=y\n");
  CHECK_THROWS_WITH_AS(apply_setting(tree, "a.b[2]=3"),
                       "--set: a.b[2]: a.b has 2 items; expected an index below 2", Failure);
  CHECK_THROWS_AS(apply_setting(tree, "=3"), Failure);
  CHECK_THROWS_AS(apply_setting(tree, "a"), Failure);
}

TEST_CASE("results as JSON: one object, numbers that read back, null for what is not finite") {
  Identity id{"post", "", "00ff", {}, ""};
  CHECK(
      json_text(id, {{"force", 0.1, "N"}, {"c2", std::numeric_limits<double>::infinity(), "-"}}) ==
      "{\"stage\": \"post\", \"config_hash\": \"00ff\", \"force_N\": 0.1, \"c2\": null}\n");
}

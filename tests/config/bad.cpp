// Every file in bad/ says in its first lines what must be said about it:
//   # stage: solve                     the stage whose config it is, or: pipeline, material, sample, yaml
//   # expect: :4:3: key: found ...     part of one message; there must be exactly one message per such line
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "config/sample.hpp"
#include "mechanics/material/material.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/expand.hpp"
#include "scene/model/solve_config_io.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

struct Bad {
  std::string stage;
  std::vector<std::string> expected;
};

Bad header(const fs::path& path) {
  Bad bad;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line) && line.rfind("# ", 0) == 0;) {
    if (line.rfind("# stage: ", 0) == 0) bad.stage = line.substr(9);
    if (line.rfind("# expect: ", 0) == 0) bad.expected.push_back(line.substr(10));
  }
  return bad;
}

void read(const std::string& stage, const std::string& path) {
  Tree tree = load_yaml(path);
  if (stage == "yaml") return;
  if (stage == "sample")
    read_config<sample::Sample>(std::move(tree));
  else if (stage == "material")
    read_config<Material>(std::move(tree));
  else if (stage == "pipeline")
    pipeline::expand(pipeline::read_pipeline(tree), load_yaml);
  else {
    REQUIRE(find_stage(stage) != nullptr);
    effective_config(*find_stage(stage), std::move(tree), ".");
  }
}

std::vector<std::string> messages(const std::string& stage, const std::string& path, Exit& code) {
  std::vector<std::string> found;
  try {
    read(stage, path);
  } catch (const Failure& failure) {
    code = failure.code();
    for (const Error& e : failure.errors()) found.push_back(text(e));
  }
  return found;
}

// LANGER_BAD_CONFIG names one of them (tests/CMakeLists.txt makes a test of each); without it they
// follow one another
std::vector<fs::path> bad_configs() {
  if (const char* one = std::getenv("LANGER_BAD_CONFIG")) return {one};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(SOURCE_DIR "/tests/config/bad"))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("a bad config is refused with the right words at the right line and column") {
  for (const fs::path& path : bad_configs()) {
    INFO("file: " << path.filename().string());
    const Bad bad = header(path);
    REQUIRE(!bad.expected.empty());
    Exit code = Exit::ok;
    const std::vector<std::string> found = messages(bad.stage, path.string(), code);
    CHECK(code == Exit::config);
    std::string all;
    for (const std::string& message : found) all += message + "\n";
    INFO("messages:\n" << all);
    CHECK(found.size() == bad.expected.size());
    for (const std::string& expected : bad.expected) {
      INFO("expected: " << expected);
      CHECK(std::any_of(found.begin(), found.end(), [&](const std::string& m) {
        return m.find(expected) != std::string::npos;
      }));
      // the place names this file, or the one it includes
      CHECK(std::all_of(found.begin(), found.end(), [&](const std::string& m) {
        return m.rfind(path.parent_path().string(), 0) == 0;
      }));
    }
  }
}

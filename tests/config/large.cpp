// Files of another kind, or of a runaway script: read or refused in the time of their size, in
// words that can be read.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <ctime>

#include "config/sample.hpp"
#include "core/config/reader.hpp"

using namespace langer;

namespace {

// what it said; CPU seconds
std::pair<std::string, double> read(const std::string& text) {
  const std::clock_t start = std::clock();
  std::string said;
  try {
    read_config<sample::Sample>(parse_yaml(text, "large.yaml"));
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::config);
    said = failure.what();
  }
  return {said, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC};
}

std::string keys(int n, const char* form, const std::string& between) {
  std::string text;
  for (int i = 0; i < n; ++i) text += (i ? between : "") + fmt::format(fmt::runtime(form), i);
  return text;
}

constexpr double seconds =
    10;  // with sanitizers, on a busy machine; a search through all earlier keys takes 25 without

}  // namespace

TEST_CASE(
    "hundreds of thousands of keys, in blocks, in braces, twice the same: refused in seconds") {
  for (const auto& [text, expected] :
       {std::pair{keys(300000, "k{}: 1", "\n"), "more than 100000 parts"},
        {"{" + keys(300000, "k{}: 1", ", ") + "}", "more than 100000 parts"},
        {keys(90000, "k{}: 1", "\n"), "unknown key \"k0\""},
        {keys(45000, "k{}: 1", "\n") + "\n" + keys(45000, "k{}: 2", "\n"),
         "was already given at line 1"},
        {keys(90000, "same: {}", "\n"), "the key \"same\" was already given"}}) {
    const auto [said, took] = read(text);
    const std::string part = expected;
    CAPTURE(part);
    CHECK(said.find(expected) != std::string::npos);
    CHECK(said.size() < 40000);
    CHECK(took < seconds);
  }
}

TEST_CASE("a file with very many mistakes shows the first ones and says how many more") {
  const std::string said = read(keys(1000, "k{}: 1", "\n")).first;
  CHECK(said.find("large.yaml:40:1") !=
        std::string::npos);  // before them a few keys that are missing
  CHECK(said.find("large.yaml:51:1") == std::string::npos);
  CHECK(said.find(" more") != std::string::npos);
}

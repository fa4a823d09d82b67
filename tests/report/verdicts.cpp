// What a report says of a solution: whether an indenter touches, and whether its force is as near
// as the reader asks.
#include <doctest/doctest.h>

#include "report/sources.hpp"
#include "store/solution_example.hpp"

using namespace langer;
using namespace langer::report;

namespace {

// the verdicts on a solution whose force ends at `force`, with what its estimate says
std::vector<Verdict> verdicts(double force, const std::vector<Summary>& estimate,
                              const std::string& accuracy) {
  const std::string path =
      example::folder(force > 1e-6 ? "verdicts_of_errors" : "verdicts_of_touch") + "/solution.h5";
  SolutionWriter writer(path, example::header(true));
  for (int i = 0; i < 3; ++i) {
    StepRecord step = example::step(i, true);
    step.force_ind = {0, force * (i + 1) / 3, 0};
    writer.append(step);
  }
  writer.finish({}, estimate);
  ReportConfig config;
  config.accuracy = accuracy;
  ReportPage page;
  add_solutions(page, {{path, "solve"}}, config);
  return page.verdicts;
}

bool says(const std::vector<Verdict>& all, Level level, const std::string& words) {
  return std::any_of(all.begin(), all.end(), [&](const Verdict& v) {
    return v.level == level && v.text.find(words) != std::string::npos;
  });
}

// of a force of 2 N whose limit is 1.95 N
std::vector<Summary> with_error(double newton) {
  return {{"force_error", newton, "N"},
          {"force_limit", 1.95, "N"},
          {"force_error_cells", 0.05, "N"},
          {"force_error_increments", 0, "N"}};
}

}  // namespace

TEST_CASE(
    "an indenter whose force is 0 in every step never touches the body: a warning, and no good word of contact") {
  const auto none = verdicts(0, {}, "3%"), some = verdicts(1e-7, {}, "3%");
  CHECK(says(none, Level::warning, "indenter never touches the body"));
  CHECK_FALSE(says(none, Level::good, "touches the body"));
  CHECK(says(some, Level::good, "indenter touches the body"));
  CHECK_FALSE(says(some, Level::warning, "never touches"));
}

TEST_CASE(
    "a force is good where its estimated error is within what the reader asks, and a warning where it is not") {
  for (const double percent : {0.5, 2.9, 3.1, 40.}) {
    CAPTURE(percent);
    const auto all = verdicts(2, with_error(2 * percent / 100), "3%");
    CHECK(says(all, Level::warning, "more than the 3 % wanted") == (percent > 3));
    CHECK(says(all, Level::good, "within the 3 % wanted") == (percent <= 3));
  }
  CHECK(says(verdicts(2, with_error(0.02), "0.5%"), Level::warning,
             "force 2.00 N ± 1 % by mesh and increments: more than the 0.5 % wanted"));
  CHECK(says(verdicts(2, {}, "3%"), Level::note, "is not known"));
  // the limit of the meshes as the answer, with its own bar
  std::vector<Summary> by_limit = with_error(0.0193);
  by_limit.push_back({"force_of_mesh", 2, "N"});
  CHECK(says(verdicts(2, by_limit, "1%"), Level::good,
             "force 1.950 N ± 0.99 % by mesh and increments: within the 1 % wanted"));
}

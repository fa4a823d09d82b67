// No setting of the load path makes it endless: all pairs of its keys, on paths whose increments
// fail in several ways.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "mechanics/nonlinear/load_path.hpp"

using namespace langer;

namespace {

struct Setting {
  std::string key, words;
  std::function<void(LoadPathOptions&)> set;
};

std::vector<Setting> settings() {
  std::vector<Setting> all;
  const auto add = [&](const std::string& key, double value, auto member) {
    all.push_back({key, fmt::format("{}: {:g}", key, value), [=](LoadPathOptions& options) {
                     using Value = std::remove_reference_t<decltype(options.*member)>;
                     options.*member = static_cast<Value>(value);
                   }});
  };
  for (int steps : {1, 2, 7})
    all.push_back({"steps", fmt::format("steps: {}", steps), [=](LoadPathOptions& options) {
                     options.steps = steps;
                   }});
  for (double seconds : {1.0, 1e-3, 1e5})
    all.push_back({"seconds", fmt::format("seconds: {:g}", seconds), [=](LoadPathOptions& options) {
                     options.seconds = seconds;
                   }});
  for (double first : {1.0, 0.1, 1e-3}) add("first", first, &LoadPathOptions::first);
  for (double largest : {1.0, 0.02}) add("largest", largest, &LoadPathOptions::largest);
  for (double smallest : {0.4, 1e-3, 1e-9, 1e-300})
    add("smallest", smallest, &LoadPathOptions::smallest);
  for (int easy : {1, 100}) add("easy", easy, &LoadPathOptions::easy);
  for (double error : {1.0, 1e-6}) add("time_error", error, &LoadPathOptions::time_error);
  return all;
}

// How an increment from t0 to t ends.
struct Kind {
  std::string words;
  std::function<SolveReport(double t0, double t)> solve;
  bool has_an_end = false;  // the path can reach t = 1, if increments may be short
};

SolveReport outcome(bool converged, double time_error = 0) {
  SolveReport report;
  report.outcome = converged ? Outcome::converged : Outcome::not_converged;
  report.iterations = 5;
  report.time_error = time_error;
  return report;
}

std::vector<Kind> kinds() {
  return {
      {"always fails",
       [](double, double) {
         return outcome(false);
       }},
      {"fails behind 0.55",
       [](double, double t) {
         return outcome(t <= 0.55);
       }},
      {"fails where it ends behind a stop",
       [](double, double t) {
         return outcome(t <= 0.3);
       }},
      {"fails where it is longer than 0.01",
       [](double t0, double t) { return outcome(t - t0 <= 0.01 * (1 + 1e-9)); }, true},
      {"is never exact enough", [](double t0, double t) { return outcome(true, 1e9 * (t - t0)); },
       true},
      {"is exact enough, or fails, where it is short",
       [](double t0, double t) { return outcome(t - t0 < 0.05, std::pow(3 * (t - t0), 3)); }, true},
  };
}

struct Followed {
  PathReport report;
  int attempts = 0;
  bool advances = true;
};

Followed follow(const LoadPathOptions& options, const Kind& kind, const std::vector<double>& stops,
                double begin = 0, std::optional<double> increment = {}) {
  constexpr int enough = 2000000;
  Followed out;
  double from = begin;
  out.report = load_path(
      options, begin, increment, stops,
      [&](double t) {
        ++out.attempts;
        out.advances = out.advances && t > from;
        SolveReport report = kind.solve(from, t);
        if (out.attempts >= enough) report.outcome = Outcome::stopped;
        return report;
      },
      [&](double t, double, double, const SolveReport&) {
        from = t;
        return true;
      });
  return out;
}

}  // namespace

TEST_CASE("a path ends, whatever two of its keys are, and whatever its increments do") {
  const std::vector<Setting> all = settings();
  int paths = 0, complete = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i; j < all.size(); ++j) {
      if (i != j && all[i].key == all[j].key) continue;
      LoadPathOptions options;
      all[i].set(options);
      all[j].set(options);
      if (!options.complaints().empty()) continue;  // refused
      for (const Kind& kind : kinds())
        for (const std::vector<double>& stops :
             {std::vector<double>{}, {0.3, 0.5}, {1e-6, 0.3, 0.3 + 1e-12}}) {
          CAPTURE(all[i].words);
          CAPTURE(all[j].words);
          CAPTURE(kind.words);
          CAPTURE(stops.size());
          const Followed path = follow(options, kind, stops);
          // each accepted increment has at most 40 halvings and as many shorter ones
          REQUIRE(path.attempts <= 100 * (path.report.steps + 1));
          REQUIRE(path.advances);
          REQUIRE(path.report.complete == (path.report.t >= 1 - 1e-10));
          ++paths;
          if (path.report.complete) ++complete;
        }
    }
  CHECK(paths > 2000);
  CHECK(complete > 400);
  CHECK(complete < paths);
}

TEST_CASE(
    "steps with seconds: a failed increment is halved, and equal ones begin anew in each stage") {
  LoadPathOptions options;
  options.steps = 2;
  options.seconds = 1;
  std::vector<double> reached;
  double from = 0;
  int attempts = 0;
  const PathReport report = load_path(
      options, 0, {}, {0.5},
      [&](double t) {
        ++attempts;
        return outcome(t <= 0.25 || t > 0.5 || t - from < 0.1);
      },
      [&](double t, double, double, const SolveReport&) {
        reached.push_back(t);
        from = t;
        return true;
      });
  REQUIRE(report.complete);
  CHECK(report.cut_backs >= 2);
  CHECK(attempts == report.steps + report.cut_backs);
  CHECK(reached.front() == 0.25);
  CHECK(reached[reached.size() - 2] == 0.75);
  CHECK(std::find(reached.begin(), reached.end(), 0.5) != reached.end());
}

TEST_CASE("steps with seconds: a path continued after any of its increments is the path") {
  LoadPathOptions options;
  options.steps = 4;
  options.seconds = 10;
  const std::vector<double> stops{0.2, 0.7};
  for (double hard : {0.02, 0.004}) {
    std::vector<double> reached, next;
    double from = 0;
    const auto attempt = [&](double t) {
      return outcome(t < 0.3 || t > 0.6 || t - from < hard);
    };
    const auto accepted = [&](double t, double, double increment, const SolveReport&) {
      reached.push_back(t);
      next.push_back(increment);
      from = t;
      return true;
    };
    REQUIRE(load_path(options, 0, {}, stops, attempt, accepted).complete);
    const std::vector<double> whole = reached, increments = next;
    for (std::size_t at = 0; at + 1 < whole.size(); ++at) {
      reached.clear();
      from = whole[at];
      REQUIRE(load_path(options, whole[at], increments[at], stops, attempt, accepted).complete);
      CHECK(reached == std::vector<double>(whole.begin() + static_cast<long>(at) + 1, whole.end()));
    }
  }
}

TEST_CASE("a path ends at once where the user asks for it") {
  LoadPathOptions options;
  int attempts = 0;
  const PathReport report = load_path(
      options, 0, {}, {},
      [&](double t) {
        ++attempts;
        SolveReport solved = outcome(true);
        if (t > 0.35) solved.outcome = Outcome::stopped;
        return solved;
      },
      [](double, double, double, const SolveReport&) { return true; });
  CHECK_FALSE(report.complete);
  CHECK(attempts == 4);
  CHECK(report.steps == 3);
  CHECK(report.cut_backs == 0);
}

TEST_CASE("Newton's method asks before every iteration whether it is to end") {
  for (int allowed : {0, 1, 3}) {
    CAPTURE(allowed);
    int asked = 0, corrections = 0;
    Problem problem;
    problem.assess = [](const VecX&, bool) {
      return Assessment{true, 1, 1, 0, true, ""};
    };
    problem.correction = [&]() -> std::optional<VecX> {
      ++corrections;
      return VecX::Zero(1);
    };
    problem.admissible = [](const VecX&) {
      return true;
    };
    problem.moved = [](const VecX&, double) {
    };
    problem.stopped = [&] {
      return ++asked > allowed;
    };
    VecX x = VecX::Zero(1);
    const SolveReport report = newton(problem, x, {});
    CHECK(report.outcome == Outcome::stopped);
    CHECK(corrections == allowed);
  }
}

TEST_CASE("with seconds the smallest increment is a share of the shortest stage") {
  LoadPathOptions options;
  options.seconds = 10;
  options.smallest = 0.02;
  double shortest = 1;
  const auto never = [&](double t) {
    shortest = std::min(shortest, t);
    return outcome(false);
  };
  const auto accepted = [](double, double, double, const SolveReport&) {
    return true;
  };
  // stages of 0.5, 0.1 and 0.4 of the path
  const PathReport report = load_path(options, 0, {}, {0.5, 0.6}, never, accepted);
  CHECK_FALSE(report.complete);
  CHECK(shortest >= 0.1 * options.smallest);
  CHECK(shortest < 2 * 0.1 * options.smallest);
}

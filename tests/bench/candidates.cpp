// What nodes of a contact's set cost that the indenter never comes near: the same indentation with
// sets of growing radius.
#include <fmt/format.h>

#include <cstdio>

#include "core/base/stopwatch.hpp"
#include "support/indentation.hpp"
#include "support/laws.hpp"

using namespace langer;

void measure_candidates() {
  fmt::print(
      "candidates out of reach: the paper's block, 0.5 mm in five steps; CPU seconds on one thread\n"
      "  radius mm  candidates  friction  CPU s  force N\n");
  for (double mu : {0.0, 0.34})
    for (double reach : {2.6, 4.0, 6.0, 9.0}) {
      test::Indentation scene;
      scene.nx = scene.nz = 22;
      scene.depth = 0.5;
      scene.mu = mu;
      scene.reach = reach;
      std::size_t candidates = 0;
      scene.before = [&](Assembler&, const Increment& increment, const LoadPathOptions&) {
        candidates = increment.contacts()[0].nodes.size();
      };
      const double begun = cpu_seconds();
      const auto result = scene.run(test::table1(60, 1e-6));
      const double seconds = cpu_seconds() - begun;
      fmt::print("  {:>9}  {:>10}  {:>8}  {:>5.2f}  {:.12g}{}\n", reach, candidates, mu, seconds,
                 result.steps.empty() ? 0 : result.steps.back().force,
                 result.path.complete ? "" : " (stopped)");
      std::fflush(stdout);
    }
}

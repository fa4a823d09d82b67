// Struts, films and caps of random size with default keys: does the first unstable increment
// contain the critical load of the reference, and how far off is the place that is found in it?
//   langer-bench instabilities
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "support/drawn_instabilities.hpp"

using namespace langer;

void measure_instabilities() {
  constexpr int members = 120;
  constexpr unsigned seed = 20261128;
  test::InstabilityDraw draw(seed);
  int contain = 0;
  fmt::print(
      "| body | reference t | first unstable increment | contains it | kind | found t | off by % |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  for (int i = 0; i < members; ++i) {
    const test::DrawnInstability drawn = draw.next(i);
    const test::FoundInstability found = test::find_instability(drawn.scene);
    const double unsure = drawn.unsure * drawn.critical_t;
    const bool contains =
        drawn.critical_t >= found.before - unsure && drawn.critical_t <= found.after + unsure;
    contain += contains;
    std::string kind = "none";
    double off = NAN;
    double t = NAN;
    if (found.critical) {
      kind = found.critical->kind;
      t = found.critical->t;
      off = 100 * (t / drawn.critical_t - 1);
    }
    fmt::print("| {} | {:.4f} | {:.4f} to {:.4f} | {} | {} | {:.4f} | {:+.2f} |\n", drawn.kind,
               drawn.critical_t, found.before, found.after, contains ? "yes" : "NO", kind, t, off);
    std::fflush(stdout);
  }
  fmt::print("{} of {} contain it.\n", contain, members);
}

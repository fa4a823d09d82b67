// Text -> CSV -> tests of two kinds, by their columns' names or as told.
#include <cmath>

#include "fuzz.hpp"
#include "identification/fit/test_data.hpp"

namespace {
void finite(const std::vector<double>& values) {
  for (double x : values)
    if (!std::isfinite(x)) std::abort();
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::reads_or_refuses("input.csv", [&] {
    const Test test = parse_tests(text, "input.csv", {}).front();
    finite(test.first), finite(test.stress_x);
    if (test.first.size() != test.stress_x.size() || test.points() < 2) std::abort();
  });
  TestFormat uniaxial, biaxial;
  uniaxial.strain_x = "strain", uniaxial.stress_x = "cauchy_stress_MPa";
  biaxial.like.kind = TestKind::biaxial, biaxial.strain = StrainMeasure::stretch,
  biaxial.stress_unit = StressUnit::kPa;
  biaxial.strain_x = "lx", biaxial.strain_z = "lz", biaxial.stress_x = "sx",
  biaxial.stress_z = "sz", biaxial.split = "test";
  TestFormat sized;
  sized.width = 10, sized.thickness = 2, sized.gauge_length = 40, sized.toe = 0.01;
  TestFormat timed = uniaxial;
  timed.time = "t";
  timed.viscous = true;
  timed.cycles.skip_cycles = 1;
  TestFormat stepped = timed;
  stepped.cycles = {};
  stepped.step_at = 0;
  stepped.ramp = 0.5;
  TestFormat loading = sized;
  loading.toe.reset();
  loading.strain_sign = -1;
  loading.stress_sign = -1;
  loading.cycles = {KeptUntil::peak, KeptBranch::loading, KeptCycle::last, 0};
  TestFormat ratio = biaxial;
  ratio.ratio = 0.5;
  for (const TestFormat& format : {uniaxial, biaxial, sized, timed, stepped, loading, ratio})
    fuzz::reads_or_refuses("input.csv", [&] {
      for (const Test& test : parse_tests(text, "input.csv", format))
        for (const auto* list :
             {&test.first, &test.second, &test.stress_x, &test.stress_z, &test.time,
              &test.before.first, &test.before.second, &test.before.time})
          finite(*list);
    });
  return 0;
}

#include "identification/fit/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

// The range of a test: largest strain and stress.
struct Reach {
  double strain = 0,
         stress = 0;  // largest amounts; strain: of engineering strains, or of the shear
  double secant() const { return stress / strain; }
};

// Engineering strains of both axes count, and the amount of simple shear.
Reach reach(const Test& test) {
  Reach r{0, largest_stress(test)};
  for (double x : test.first) r.strain = std::max(r.strain, std::abs(strain_of(test.kind, x)));
  for (double x : test.second) r.strain = std::max(r.strain, std::abs(x - 1));
  return r;
}

// Warns if strains or stiffnesses are outside the range of soft tissues and rubbers: probably a
// wrong unit.
void add_units(std::vector<std::string>& all, const Test& test, const Reach& r) {
  constexpr double most_strain = 9, least_strain = 0.01;  // rubber breaks at 8 to 10
  if (r.strain > most_strain)
    all.push_back(fmt::format(
        "test {}: strains up to {:.3g}, {:.3g} %: if the file gives percent, say strain_unit: percent (or name the column strain_percent)",
        test.name, r.strain, 100 * r.strain));
  else if (r.strain > 0 && r.strain < least_strain)
    all.push_back(fmt::format(
        "test {}: strains of {:.2g} % at most: if the file gives fractions, its unit is not percent",
        test.name, 100 * r.strain));
  if (!(r.strain > 0) || !(r.stress > 0)) return;
  // tendon and cartilage have up to some 1000 MPa at strains of 0.1, skin and rubber 0.01 to 100,
  // brain and fat some 0.001
  double most = 5000;
  if (r.strain > 0.15) most = 100;
  constexpr double least = 1e-5;
  if (r.strain <= most_strain && r.secant() > most)
    all.push_back(fmt::format(
        "test {}: {:.3g} MPa at a strain of {:.2g}, {:.2g} MPa a unit of strain: more than soft tissue or rubber; is the stress in kPa?",
        test.name, r.stress, r.strain, r.secant()));
  else if (r.secant() < least)
    all.push_back(fmt::format(
        "test {}: {:.2g} MPa at a strain of {:.2g}: less than the softest gel; is the stress in MPa, or kPa?",
        test.name, r.stress, r.strain));
}

// Warns about a stress at rest, and about a deformation that reverses in a test fitted as loading.
void add_shape(std::vector<std::string>& all, const Test& test, const Reach& r) {
  constexpr double at_rest = 0.01, offset = 0.1, back = 0.05;
  const double first = strain_of(test.kind, test.first[0]);
  const double z = test.second_at(0) - 1;
  if (std::abs(first) < at_rest * r.strain && std::abs(z) < at_rest * r.strain &&
      std::abs(test.stress_x[0]) > offset * r.stress)
    all.push_back(fmt::format(
        "test {}: {:.3g} MPa at no strain, {:.2g} % of the largest: an offset of the force, or a preload",
        test.name, test.stress_x[0], 100 * std::abs(test.stress_x[0]) / r.stress));
  // a protocol of several branches and a history go back on purpose, in another uniaxial test it is
  // the way back or a cycle
  if (test.kind == TestKind::biaxial || !test.time.empty()) return;
  // A curve from compression to tension only rises: what counts is a change of direction. The first
  // turn that is more than noise is named.
  const double noise = back * r.strain;
  double highest = first;
  double lowest = first;
  bool rose = false;
  bool fell = false;
  for (std::size_t i = 0; i < test.points(); ++i) {
    const double e = strain_of(test.kind, test.first[i]);
    const bool falls = rose && e < highest - noise;
    const bool rises = fell && e > lowest + noise;
    if (falls || rises) {
      all.push_back(fmt::format(
          "test {}: the strain goes back from {:.3g} to {:.3g} at point {}: unloading or cycles, fitted as if they were loading; until: peak, branch: loading, cycle: last or skip_cycles choose a part",
          test.name, falls ? highest : lowest, e, i + 1));
      return;
    }
    rose = rose || e > lowest + noise;
    fell = fell || e < highest - noise;
    highest = std::max(highest, e);
    lowest = std::min(lowest, e);
  }
}

}  // namespace

// Checks each test alone, then compares the stiffest with the softest one.
std::vector<std::string> doubts(const std::vector<Test>& tests) {
  std::vector<std::string> all;
  const Test *softest = nullptr, *stiffest = nullptr;
  double low = 0, high = 0;
  for (const Test& test : tests) {
    all.insert(all.end(), test.notes.begin(), test.notes.end());
    const Reach r = reach(test);
    add_units(all, test, r);
    add_shape(all, test, r);
    if (!(r.strain > 0) || !(r.stress > 0)) continue;
    if (!softest || r.secant() < low) {
      softest = &test;
      low = r.secant();
    }
    if (!stiffest || r.secant() > high) {
      stiffest = &test;
      high = r.secant();
    }
  }
  // skin along and across its fibres differs by some ten
  constexpr double most_ratio = 300;
  if (softest && high > most_ratio * low)
    all.push_back(
        fmt::format("test {} is {:.0f} times as stiff as {}: is one of them in another unit?",
                    stiffest->name, high / low, softest->name));
  return all;
}

}  // namespace langer

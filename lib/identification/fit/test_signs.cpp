#include "identification/fit/test_signs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "core/base/error.hpp"

namespace langer {

namespace {

// Stress times strain of every point, summed over the axes that work.
std::vector<double> works(const Test& test) {
  std::vector<double> all;
  for (std::size_t i = 0; i < test.points(); ++i) {
    double work = test.stress_x[i] * strain_of(test.kind, test.first[i]);
    if (test.kind == TestKind::biaxial && !test.stress_z.empty()) {
      work += test.stress_z[i] * (test.second[i] - 1);
    }
    all.push_back(work);
  }
  return all;
}

}  // namespace

void check_signs(const Test& test, const std::string& file) {
  // With one of two axes the work of the other one is not known.
  if (test.kind == TestKind::biaxial && test.stress_z.empty()) {
    return;
  }
  const std::vector<double> all = works(test);
  double largest = 0;
  for (const double work : all) largest = std::max(largest, std::abs(work));

  // A tenth of the largest strain with a tenth of the largest stress is a hundredth of the work.
  constexpr double noise = 0.01;
  std::ptrdiff_t counted = 0;
  std::ptrdiff_t negative = 0;
  std::size_t example = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!(std::abs(all[i]) > noise * largest)) continue;
    ++counted;
    if (all[i] > 0) continue;
    ++negative;
    if (all[i] < all[example]) example = i;
  }
  if (2 * negative <= counted) {
    return;
  }
  // More points with negative than with positive work: report the one with the most negative work.
  const bool shear = test.kind == TestKind::simple_shear;
  std::string deformation;
  if (shear) {
    deformation = fmt::format("an amount of shear of {:g}", test.first[example]);
  } else {
    deformation = fmt::format("a stretch of {:g}", test.first[example]);
  }
  throw Failure(
      Exit::input,
      {{file, 0, 0},
       "stress_sign",
       fmt::format("found {} with a stress of {:g} MPa{}", deformation, test.stress_x[example],
                   test.name.empty() ? "" : " in " + test.name),
       "stress and strain of one sign: tension positive, compression negative",
       "stress_sign: -1 in the item of `data` where compression counts positive in the stress only, "
       "strain_sign: -1 where it does in the strain only"});
}

bool names_compression(const std::string& name) {
  std::string word;
  // The name is split into words of letters, in lower case.
  const auto is_compression = [](const std::string& text) {
    return text == "comp" || text == "compr" || text.starts_with("compress") || text == "druck" ||
           text == "druckversuch" || text == "stauchversuch";
  };
  for (const char letter : name) {
    const auto c = static_cast<unsigned char>(letter);
    if (c < 128 && std::isalpha(c) != 0) {
      word += static_cast<char>(std::tolower(c));
      continue;
    }
    if (is_compression(word)) return true;
    word.clear();
  }
  return is_compression(word);
}

bool only_tension(const Test& test) {
  const auto below = [](const std::vector<double>& values, double limit) {
    return std::any_of(values.begin(), values.end(), [limit](double x) { return x < limit; });
  };
  const double largest = largest_stress(test);
  double reach = 0;
  for (const double x : test.first) reach = std::max(reach, std::abs(strain_of(test.kind, x)));
  double rest = 1;
  if (test.kind == TestKind::simple_shear) rest = 0;
  return !below(test.first, rest - 0.05 * reach) && !below(test.stress_x, -0.05 * largest);
}

}  // namespace langer

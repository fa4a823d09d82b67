#include "mechanics/material/at_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/text.hpp"
#include "mechanics/material/parameters.hpp"

namespace langer {

AtRest at_rest(const Material& material) {
  Material copy = material;
  double largest = 0;
  for (const MaterialParameter& p : parameters(copy))
    if (p.unit == std::string(unit::MPa)) largest = std::max(largest, std::abs(*p.value));
  const double mu = shear_modulus(material);
  if (std::isnan(mu)) return AtRest::unstable;  // moduli that are too large to add up
  if (std::abs(mu) <= 1e-12 * largest || mu == 0) return AtRest::without_stiffness;
  if (mu > 0) return AtRest::stiff;
  return AtRest::unstable;
}

std::string at_rest_in_words(const Material& material) {
  const AtRest rest = at_rest(material);
  if (rest == AtRest::stiff) return "";
  std::string terms;
  for (const MatrixTerm& term : material.matrix)
    append(terms, " + ",
           std::visit([](const auto& law) { return std::string_view(law.key); }, term));
  return fmt::format("{} at rest: the shear modulus of {} is {:.3g} MPa there",
                     rest == AtRest::unstable ? "unstable" : "no stiffness",
                     text_or(terms, "its matrix"),
                     rest == AtRest::unstable ? shear_modulus(material) : 0.);
}

std::string stiffness_at_rest_cure(const Material& material) {
  Material copy = material;
  std::string keys;
  for (const MaterialParameter& p : parameters(copy)) {
    if (p.unit != std::string(unit::MPa) || !p.key.starts_with("matrix")) continue;
    const double value = *p.value;
    *p.value = value + 1;
    const double more = shear_modulus(copy);
    *p.value = value;
    if (std::abs(more - shear_modulus(copy)) > 1e-9) append(keys, " or ", p.key);
  }
  return fmt::format(
      "{} other than 0, such that the shear modulus is positive; a fit with bounds: admissible uses "
      "the smallest one that its tests can identify",
      text_or(keys, "a matrix term"));
}

}  // namespace langer

// Fibre laws and laws of volume change as other programs have them: what can be said in their form,
// and the nearest where not.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "mechanics/material/material.hpp"

namespace langer {

using LacksAndNearest = std::pair<std::string, std::string>;  // empty where a program has it

inline std::string fibre_words(const Fibre& family) {
  if (const auto* law = std::get_if<ExpPowFibre>(&family.law))
    return fmt::format("fibres of exp_pow with beta = {:g}", law->beta);
  return std::string("fibres of ") +
         std::visit([](const auto& law) { return law.key; }, family.law);
}

// HGO's energy: hgo, and exp_pow with beta = 2
inline std::optional<HgoFibre> as_hgo(const Fibre& family) {
  if (const auto* law = std::get_if<HgoFibre>(&family.law)) return *law;
  if (const auto* law = std::get_if<ExpPowFibre>(&family.law); law && law->beta == 2)
    return HgoFibre{law->ksi, law->alpha};
  return std::nullopt;
}

// of a program whose fibres have HGO's energy alone
inline LacksAndNearest beyond_hgo(const Material& material) {
  for (const Fibre& family : material.fibres)
    if (!as_hgo(family))
      return {fibre_words(family),
              "hgo, or exp_pow with beta: 2, which is the same energy; or FEBio"};
  return {};
}

// (J - 1)^2/d, or kappa/4 (J^2 - 1 - 2 ln J)
enum class VolumeTerm { quadratic, simo_taylor };

// 2/kappa [1/MPa]: the d or D of other programs
inline double compressibility(const Volume& volume) {
  const auto* quadratic = std::get_if<QuadraticVolume>(&volume);
  if (quadratic) return quadratic->d;
  return 2 / bulk_modulus(volume);
}

// of a program that has this term: a quadratic one is written as either, since its bulk modulus is
// the same and the card says so
inline LacksAndNearest beyond_volume(const Volume& volume, VolumeTerm theirs) {
  if (std::holds_alternative<QuadraticVolume>(volume)) return {};
  if (theirs == VolumeTerm::simo_taylor && std::holds_alternative<SimoTaylorVolume>(volume))
    return {};
  std::string nearest;
  if (theirs == VolumeTerm::quadratic) {
    nearest = fmt::format("volume: {{quadratic: {{d: {:g}}}}}", compressibility(volume));
  } else {
    nearest = fmt::format("volume: {{simo_taylor: {{bulk_modulus: {:g}}}}}", bulk_modulus(volume));
  }
  return {fmt::format("volume: {} with this law",
                      std::visit([](const auto& law) { return law.key; }, volume)),
          nearest + ", of the same bulk modulus; or FEBio"};
}

// whether a program with a term of the second kind says it of a material of the first
inline bool of_other_form(const Volume& volume) {
  return !std::holds_alternative<SimoTaylorVolume>(volume);
}

}  // namespace langer

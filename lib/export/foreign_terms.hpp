// Fibre models and volume terms as other programs have them: whether a program can express them,
// and the closest alternative if it cannot.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "mechanics/material/material.hpp"

namespace langer {

// A part of a material that a program lacks, and the closest alternative; empty if it lacks
// nothing.
struct Lacking {
  std::string what, nearest;

  bool empty() const { return what.empty(); }
};

// The name of a material model in the config.
template <class Model>
std::string key_of(const Model& model) {
  return std::visit([](const auto& m) -> std::string { return m.key; }, model);
}

inline std::string fibre_words(const Fibre& family) {
  if (const auto* law = std::get_if<ExpPowFibre>(&family.law))
    return fmt::format("fibres of exp_pow with beta = {:g}", law->beta);
  return "fibres of " + key_of(family.law);
}

// The fibre as an hgo model, if its energy is the same: hgo itself, and exp_pow with beta = 2.
inline std::optional<HgoFibre> as_hgo(const Fibre& family) {
  if (const auto* law = std::get_if<HgoFibre>(&family.law)) return *law;
  if (const auto* law = std::get_if<ExpPowFibre>(&family.law); law && law->beta == 2)
    return HgoFibre{law->ksi, law->alpha};
  return std::nullopt;
}

// Fibres that a program lacks whose only fibre energy is that of HGO.
inline Lacking beyond_hgo(const Material& material) {
  for (const Fibre& family : material.fibres)
    if (!as_hgo(family))
      return {fibre_words(family),
              "hgo, or exp_pow with beta: 2, which is the same energy; or FEBio"};
  return {};
}

// The volume term of a program: (J - 1)^2/d, or kappa/4 (J^2 - 1 - 2 ln J).
enum class VolumeTerm { quadratic, simo_taylor };

// 2/kappa [1/MPa], which other programs call d or D.
inline double compressibility(const Volume& volume) {
  const auto* quadratic = std::get_if<QuadraticVolume>(&volume);
  if (quadratic) return quadratic->d;
  return 2 / bulk_modulus(volume);
}

// The volume term, if a program with the term `theirs` lacks it. A quadratic term is written as
// either one: its bulk modulus is the same, and the card has a note.
inline Lacking beyond_volume(const Volume& volume, VolumeTerm theirs) {
  if (std::holds_alternative<QuadraticVolume>(volume)) return {};
  if (theirs == VolumeTerm::simo_taylor && std::holds_alternative<SimoTaylorVolume>(volume))
    return {};
  std::string nearest;
  if (theirs == VolumeTerm::quadratic) {
    nearest = fmt::format("volume: {{quadratic: {{d: {:g}}}}}", compressibility(volume));
  } else {
    nearest = fmt::format("volume: {{simo_taylor: {{bulk_modulus: {:g}}}}}", bulk_modulus(volume));
  }
  return {fmt::format("volume: {} with this law", key_of(volume)),
          nearest + ", of the same bulk modulus; or FEBio"};
}

// Whether the volume term differs from that of a program with the Simo-Taylor term, so that the
// card needs a note.
inline bool of_other_form(const Volume& volume) {
  return !std::holds_alternative<SimoTaylorVolume>(volume);
}

}  // namespace langer

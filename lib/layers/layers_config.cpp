#include "layers/layers_config.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "core/config/writer.hpp"
#include "mechanics/material/states.hpp"

namespace langer {

// A prestretch is given by two stretches along the axes or by a tensor, not both. A determinant of
// 0 or below would fold the layer.
std::vector<Complaint> PrestretchConfig::complaints() const {
  if (!tensor) return {};
  if (along != 1 || across != 1) {
    return {{"tensor", "found together with along or across", "one of the two", ""}};
  }
  if (!(deformation().determinant() > 0)) {
    return {{"tensor", "a determinant that is not above 0",
             "a deformation gradient, such as [[1.1, 0], [0, 1]]", ""}};
  }
  return {};
}

// The in-plane deformation gradient; the thickness follows from the law of the layer.
Eigen::Matrix2d PrestretchConfig::deformation() const {
  PlaneDeformation F;
  F << along, 0, 0, across;
  if (tensor) F << (*tensor)[0][0], (*tensor)[0][1], (*tensor)[1][0], (*tensor)[1][1];
  return F;
}

// The limit on directions finds a step that was typed in wrong units before hours are spent on it.
std::vector<Complaint> AngleRange::complaints() const {
  if (!(from <= to)) {
    return {{"to", "found " + number_text(to), "at least from, " + number_text(from), ""}};
  }
  if ((to - from) / step > 10000) {
    return {{"step", "found " + number_text(step), "at most 10000 directions", ""}};
  }
  return {};
}

// In degrees. The list is used as it is; a range includes its end in spite of rounding, for which a
// billionth of a step is allowed. Angles are products, not sums, so that errors do not add up.
std::vector<double> LayersConfig::angles() const {
  if (!directions.empty()) return directions;
  const AngleRange range = direction_range.value_or(AngleRange{});
  std::vector<double> angles;
  for (int i = 0; range.from + i * range.step <= range.to + 1e-9 * range.step; ++i) {
    angles.push_back(range.from + i * range.step);
  }
  return angles;
}

// Layers without a name are counted from 1, as in messages and tables.
std::string LayersConfig::layer_name(std::size_t i) const {
  if (!layers[i].name.empty()) return layers[i].name;
  return fmt::format("layer {}", i + 1);
}

namespace {

// Waves need densities, and at most one of the keys that set the frequency or the wavelength. In a
// single half-space of an elastic law without surface tension there is no length to compare a
// wavelength with: the speed is the same for all, and no frequency is necessary.
void complain_about_waves(const LayersConfig& config, std::vector<Complaint>& all) {
  for (std::size_t i = 0; i < config.layers.size(); ++i) {
    if (!config.layers[i].density_kg_m3) {
      all.push_back({fmt::format("layers[{}].density_kg_m3", i), "missing, and kind is waves",
                     "the density at rest in kg/m3", "density_kg_m3: 1100"});
    }
  }
  if (config.compression) {
    all.push_back({"compression", "found with kind: waves", "kind: wrinkles", ""});
  }
  std::vector<std::string> given;
  if (config.frequency_Hz) given.push_back("frequency_Hz");
  if (!config.frequencies_Hz.empty()) given.push_back("frequencies_Hz");
  if (config.wavelength_mm) given.push_back("wavelength_mm");
  if (!config.wavelengths_mm.empty()) given.push_back("wavelengths_mm");
  if (given.size() > 1) {
    all.push_back({given[1], "found together with " + given[0], "one of the two", ""});
  }
  const auto complain_about_list = [&](const std::vector<double>& list, const char* key) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i] > 0) continue;
      all.push_back(
          {fmt::format("{}[{}]", key, i), "found " + number_text(list[i]), "a number > 0", ""});
    }
  };
  complain_about_list(config.frequencies_Hz, "frequencies_Hz");
  complain_about_list(config.wavelengths_mm, "wavelengths_mm");
  // Without a thickness and without surface tension, nothing makes the speed depend on frequency.
  const bool half_space =
      config.layers.size() == 1 && !config.layers[0].thickness && config.surface_tension_N_m == 0;
  if (given.empty() && !half_space) {
    all.push_back({"frequency_Hz", "missing",
                   "the frequency, or wavelength_mm: the speed in layers depends on it",
                   "frequency_Hz: 500"});
  }
  for (std::size_t i = 0; i < config.layers.size(); ++i) {
    // Viscous branches have complex moduli at a frequency. A wavelength alone does not give one, so
    // viscous layers accept frequencies only. One complaint is enough.
    const auto& material = config.layers[i].material;
    if (!material || !is_viscous(*material)) continue;
    if (config.wavelength_mm || !config.wavelengths_mm.empty()) {
      all.push_back({given[0], "found with the viscous " + config.layer_name(i), "frequency_Hz",
                     "the moduli of viscous branches depend on the frequency"});
    } else if (given.empty() && half_space) {
      all.push_back({"frequency_Hz", "missing, and the material is viscous",
                     "the frequency of the waves", "frequency_Hz: 500"});
    }
    break;
  }
}

// Wrinkles are static: keys of waves have no meaning there and are refused, not ignored.
void complain_about_wrinkles(const LayersConfig& config, std::vector<Complaint>& all) {
  const auto refuse = [&](const char* key, bool found) {
    if (found) all.push_back({key, "found with kind: wrinkles", "kind: waves", ""});
  };
  refuse("frequency_Hz", config.frequency_Hz.has_value());
  refuse("frequencies_Hz", !config.frequencies_Hz.empty());
  refuse("wavelength_mm", config.wavelength_mm.has_value());
  refuse("wavelengths_mm", !config.wavelengths_mm.empty());
  refuse("mode", config.mode != WaveMode::vertical);
  const CompressionConfig load = config.load();
  if (load.load == WrinkleLoad::shear && load.width != WidthUnderCompression::held) {
    all.push_back(
        {"compression.width", "found with load: shear", "none", "a shear holds the width"});
  }
}

}  // namespace

// Checks that involve several keys; those of single numbers are made by the reader. A layer without
// a thickness extends to infinity, so it must be the last, and it has no lower face.
std::vector<Complaint> LayersConfig::complaints() const {
  std::vector<Complaint> all;
  if (layers.empty()) {
    all.push_back({"layers", "an empty list", "a layer at least", ""});
    return all;
  }
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    if (layers[i].thickness) continue;
    all.push_back({fmt::format("layers[{}].thickness", i), "missing",
                   "the thickness at rest in mm: only the last layer may be a half-space", ""});
  }
  if (bottom == BottomFace::free && !layers.back().thickness) {
    all.push_back(
        {"bottom", "free, below a half-space", "a thickness of the last layer, or no bottom", ""});
  }
  if (!directions.empty() && direction_range) {
    all.push_back({"direction_range", "found together with directions", "one of the two", ""});
  }
  for (const auto& [name, one] : compare) {
    const bool taken = name == "group";
    if (taken) all.push_back({"compare." + name, "the name " + name, "another name", ""});
  }
  if (kind == LayersKind::waves) {
    complain_about_waves(*this, all);
  } else {
    complain_about_wrinkles(*this, all);
  }
  return all;
}

// Layers in the units of the solver: mm, MPa and t/mm^3. A layer without a law of its own has the
// law given on the command line; a half-space has an infinite thickness.
std::vector<Layer> layers_at_rest(const LayersConfig& config, const std::optional<Material>& others,
                                  const std::function<Place(const std::string&)>& where) {
  std::vector<Layer> layers;
  for (std::size_t i = 0; i < config.layers.size(); ++i) {
    const StretchedLayerConfig& one = config.layers[i];
    const std::optional<Material>& material = one.material ? one.material : others;
    if (!material) {
      const std::string key = fmt::format("layers[{}].material", i);
      throw Failure(Exit::config,
                    Error{where(key), key, "missing", "the law of this layer, or --material",
                          "material: {include: ../material/dermis.yaml}"});
    }
    Layer layer;
    layer.name = config.layer_name(i);
    layer.material = *material;
    layer.fibres = specimen_fibres(*material, one.fibre_angle);
    layer.thickness = one.thickness.value_or(std::numeric_limits<double>::infinity());
    layer.density = density_in_t_mm3(one.density_kg_m3.value_or(0));
    if (one.prestretch) layer.own = one.prestretch->deformation();
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace langer

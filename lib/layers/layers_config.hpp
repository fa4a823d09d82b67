// Config of layers: waves and wrinkles of stretched layers.
//   kind: waves
//   layers:
//     - {name: dermis, thickness: 1.5, material: {include: dermis.yaml}, density_kg_m3: 1100}
//     - {name: fat, thickness: 10, material: {include: fat.yaml}, density_kg_m3: 950}
//   prestretch: {along: 1.1}
//   frequency_Hz: 500
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/fields.hpp"
#include "layers/prestretch_config.hpp"
#include "layers/wrinkle.hpp"
#include "mechanics/material/material.hpp"
#include "results/plot/figure_style.hpp"

namespace langer {

enum class LayersKind { waves, wrinkles };
constexpr auto names(LayersKind) { return std::array{"waves", "wrinkles"}; }

struct StretchedLayerConfig {
  std::string name;
  std::optional<double> thickness, density_kg_m3;
  std::optional<Material> material;
  double fibre_angle = 0;
  std::optional<PrestretchConfig> prestretch;
  static void fields(auto& v) {
    v(&StretchedLayerConfig::name, "name", unit::none, "of the layer, in messages");
    v(&StretchedLayerConfig::thickness, "thickness", unit::mm,
      "at rest; the last layer may have none: it is a half-space", positive);
    v(&StretchedLayerConfig::material, "material", unit::none,
      "its law, such as {include: dermis.yaml}; without it, that of --material");
    v(&StretchedLayerConfig::fibre_angle, "fibre_angle", unit::deg,
      "added to the fibre angles of its law, from x towards z");
    v(&StretchedLayerConfig::density_kg_m3, "density_kg_m3", unit::none,
      "at rest, in kg/m3, such as 1100; waves need it", positive);
    v(&StretchedLayerConfig::prestretch, "prestretch", unit::none,
      "of this layer before it was joined to the others; the prestretch of all comes on top");
  }
};

// Angles at a constant step.
struct AngleRange {
  double from = 0, to = 180, step = 15;
  static void fields(auto& v) {
    v(&AngleRange::from, "from", unit::deg, "the first");
    v(&AngleRange::to, "to", unit::deg, "the last");
    v(&AngleRange::step, "step", unit::deg, "from one to the next", positive);
  }
  std::vector<Complaint> complaints() const;
};

struct CompressionConfig {
  WrinkleLoad load = WrinkleLoad::compression;
  WidthUnderCompression width = WidthUnderCompression::held;
  double smallest = 0.1;
  static void fields(auto& v) {
    v(&CompressionConfig::load, "load", unit::none,
      "what is increased until the skin wrinkles, from the prestretch on");
    v(&CompressionConfig::width, "width", unit::none,
      "across a compression: held, free of force, or equal to the compression (equibiaxial)");
    v(&CompressionConfig::smallest, "smallest", unit::none,
      "stretch at which the search ends; a shear ends at its inverse", Range{0.01, 1, true, false});
  }
};

struct LayersConfig {
  LayersKind kind = LayersKind::waves;
  std::vector<StretchedLayerConfig> layers;
  BottomFace bottom = BottomFace::fixed;
  Dilatation dilatation = Dilatation::incompressible;
  PrestretchConfig prestretch;
  std::map<std::string, PrestretchConfig> compare;
  std::vector<double> directions;
  std::optional<AngleRange> direction_range;
  std::optional<double> frequency_Hz, wavelength_mm;
  std::vector<double> frequencies_Hz, wavelengths_mm;
  WaveMode mode = WaveMode::vertical;
  std::optional<CompressionConfig> compression;
  double surface_tension_N_m = 0;
  bool figures = true;
  FigureStyle figure_style;
  static void fields(auto& v) {
    v(&LayersConfig::kind, "kind", unit::none,
      "waves: speed over direction; wrinkles: critical stretch and wavelength over direction",
      required);
    v(&LayersConfig::layers, "layers", unit::none, "from the surface down", required);
    v(&LayersConfig::bottom, "bottom", unit::none, "face below the last layer");
    v(&LayersConfig::dilatation, "dilatation", unit::none,
      "incompressible: the volume laws are left out; compressible: they count");
    v(&LayersConfig::prestretch, "prestretch", unit::none,
      "of all layers together, before the wave or the compression");
    v(&LayersConfig::compare, "compare", unit::none,
      "further prestretches by name: each adds a column to the table");
    v(&LayersConfig::directions, "directions", unit::deg,
      "in the stretched plane, from x towards z: of travel, or of the compression");
    v(&LayersConfig::direction_range, "direction_range", unit::none,
      "instead of a list; with neither from 0 to 180 degrees by 15");
    v(&LayersConfig::frequency_Hz, "frequency_Hz", unit::none, "of the waves, in Hz", positive);
    v(&LayersConfig::wavelength_mm, "wavelength_mm", unit::none,
      "instead of the frequency: on the stretched surface, in mm", positive);
    v(&LayersConfig::frequencies_Hz, "frequencies_Hz", unit::none,
      "several frequencies: one row each and direction");
    v(&LayersConfig::wavelengths_mm, "wavelengths_mm", unit::none, "several wavelengths");
    v(&LayersConfig::mode, "mode", unit::none,
      "of the waves: the one that a vertical tap excites most, or the slowest");
    v(&LayersConfig::compression, "compression", unit::none, "of wrinkles: how they are caused");
    v(&LayersConfig::surface_tension_N_m, "surface_tension_N_m", unit::none,
      "of the surface, in N/m", at_least(0));
    v(&LayersConfig::figures, "figures", unit::none, "draw the result over the direction");
    v(&LayersConfig::figure_style, "figure_style", unit::none, "how figures are made");
  }
  std::vector<Complaint> complaints() const;

  std::string layer_name(std::size_t i) const;
  std::vector<double> angles() const;  // [deg]
  CompressionConfig load() const { return compression.value_or(CompressionConfig{}); }
};

constexpr auto names(BottomFace) { return std::array{"fixed", "free"}; }

// The layers at rest in mm, N, s; others: the law of those without one. Throws Failure(config) at
// the key of a layer without a law.
std::vector<Layer> layers_at_rest(const LayersConfig& config, const std::optional<Material>& others,
                                  const std::function<Place(const std::string&)>& where);

}  // namespace langer

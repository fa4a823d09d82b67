#include "accuracy/estimate/pad_edges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/model/supports.hpp"

namespace langer {

namespace {

// A side of one of several bodies that are blocks.
struct Face {
  std::string body;
  const Block* block = nullptr;
  int axis = 0;  // that it is normal to
};

std::optional<Face> face_of(const SolveConfig& config, const std::string& set) {
  for (const auto& [name, body] : config.bodies) {
    const auto* block = std::get_if<Block>(&body.mesh.geometry);
    if (!block || !set.starts_with(name + "_")) continue;
    const int axis = axis_of_side(set.substr(name.size() + 1));
    if (axis >= 0) return Face{name, block, axis};
  }
  return std::nullopt;
}

struct Pad {
  Face pad, on;
};

// Both sides of each contact, as each may end within the other.
std::vector<Pad> pads_of(const SolveConfig& config) {
  std::vector<Pad> pads;
  for (const auto& [name, contact] : config.touching) {
    const std::optional<Face> one = face_of(config, contact.on);
    const std::optional<Face> other = face_of(config, contact.against.value_or(""));
    if (!one || !other || one->axis != other->axis) continue;
    pads.push_back({*one, *other});
    pads.push_back({*other, *one});
  }
  return pads;
}

// Edges of the pad along an axis of its face that lie within the other face.
std::vector<double> edges_along(const Pad& pad, std::size_t i) {
  if (static_cast<int>(i) == pad.on.axis) return {};
  const Block& on = *pad.on.block;
  const double slack = 1e-9 * on.size[i];
  std::vector<double> edges;
  for (const double x :
       {pad.pad.block->origin[i], pad.pad.block->origin[i] + pad.pad.block->size[i]})
    if (x > on.origin[i] + slack && x < on.origin[i] + on.size[i] - slack) edges.push_back(x);
  return edges;
}

// Whether lines of a block lie at x on its own mesh, and on those with 3/4 and half of its cells.
bool meets_lines(const Block& block, std::size_t i, double x) {
  if (block.family) {
    return std::ranges::any_of(block.family->breaks[i],
                               [&](double at) { return std::abs(at - x) < 1e-9 * block.size[i]; });
  }
  const int n = block.numbers()[i];
  return std::ranges::all_of(std::array{1.0, 0.75, 0.5}, [&](double part) {
    const double lines = (x - block.origin[i]) / block.size[i] * n * part;
    return std::abs(lines - std::round(lines)) < 1e-6;
  });
}

// Shear moduli at rest of all materials of a body.
std::vector<double> stiffness_of(const SolveConfig& config, const std::string& body) {
  std::vector<double> found;
  for (const auto& [name, of] : config.materials)
    if (of.material && (name == body || name.starts_with(body + "_")))
      found.push_back(shear_modulus(*of.material));
  if (found.empty() && config.material) found.push_back(shear_modulus(*config.material));
  return found;
}

double factor_of(const SolveConfig& config, const Pad& pad) {
  constexpr double alike = 0.35, rigid = 1.5;
  constexpr double from = 2.5, to = 100;  // times as stiff
  const std::vector<double> of_pad = stiffness_of(config, pad.pad.body);
  const std::vector<double> below = stiffness_of(config, pad.on.body);
  if (of_pad.empty() || below.empty()) return alike;  // one material for all
  const double ratio = *std::ranges::max_element(of_pad) / *std::ranges::min_element(below);
  const double share = std::log(std::clamp(ratio, from, to) / from) / std::log(to / from);
  return alike + share * (rigid - alike);
}

}  // namespace

std::array<std::vector<double>, 3> pad_edges_on(const SolveConfig& config,
                                                const std::string& body) {
  std::array<std::vector<double>, 3> places;
  for (const Pad& pad : pads_of(config)) {
    if (pad.on.body != body) continue;
    for (std::size_t i = 0; i < 3; ++i)
      for (const double x : edges_along(pad, i)) places[i].push_back(x);
  }
  return places;
}

bool has_pads(const SolveConfig& config) {
  return std::ranges::any_of(pads_of(config), [](const Pad& pad) {
    return !edges_along(pad, 0).empty() || !edges_along(pad, 1).empty() ||
           !edges_along(pad, 2).empty();
  });
}

double beside_pads(const SolveConfig& config) {
  double most = 0;
  for (const Pad& pad : pads_of(config)) {
    double width = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i)
      if (static_cast<int>(i) != pad.pad.axis) width = std::min(width, pad.pad.block->size[i]);
    for (std::size_t i = 0; i < 3; ++i)
      for (const double x : edges_along(pad, i)) {
        if (meets_lines(*pad.on.block, i, x)) continue;
        const double h = pad.on.block->size[i] / pad.on.block->numbers()[i];
        most = std::max(most, factor_of(config, pad) * h / width);
      }
  }
  return most;
}

}  // namespace langer

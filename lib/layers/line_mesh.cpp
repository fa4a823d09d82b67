#include "layers/line_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

namespace {

// Lengths from a face to a distance from it: growing up to the largest, then alike.
std::vector<double> graded(double distance, double k, const LineChoice& choice) {
  const double g = choice.growth * k;
  const double to_largest = (choice.largest / choice.size - 1) / g;
  const double grows = std::min(distance, to_largest);
  const double room = std::log1p(g * grows) / (choice.growth * choice.size);
  const int n = std::max(1, static_cast<int>(std::ceil(room))) * choice.refine;
  std::vector<double> lengths;
  double before = 0;
  for (int i = 1; i <= n; ++i) {
    const double here = std::expm1(std::log1p(g * grows) * i / n) / g;
    lengths.push_back(here - before);
    before = here;
  }
  const double left = distance - grows;
  if (left > 0) {
    const int alike = static_cast<int>(std::ceil(left * k / choice.largest)) * choice.refine;
    lengths.insert(lengths.end(), static_cast<std::size_t>(alike), left / alike);
  }
  return lengths;
}

// Equal lengths for solutions that oscillate through the whole thickness: at least two elements,
// each a given phase long. oscillation is the wave number through the depth [1/mm].
std::vector<double> uniform(double thickness, double oscillation, const LineChoice& choice) {
  const double room = thickness * oscillation / choice.size;
  const int n = std::max(2, static_cast<int>(std::ceil(room))) * choice.refine;
  return std::vector<double>(static_cast<std::size_t>(n), thickness / n);
}

}  // namespace

// Lines through the depth for motions of the wave number k [1/mm] along the surface. These decay
// exponentially from the faces that they belong to, so lines are short at faces and grow with the
// distance from them. A half-space, and a layer that reaches deep enough not to matter, is cut at a
// depth of several 1/k. The result is listed from the bottom upwards.
LineMesh line_mesh(const std::vector<double>& thickness, double k,
                   const std::vector<double>& oscillation, bool cuttable,
                   const LineChoice& choice) {
  LineMesh mesh;
  std::vector<DepthLine> from_top;
  double depth = 0;
  for (std::size_t layer = 0; layer < thickness.size() && !mesh.cut; ++layer) {
    const double oscillates = std::max(oscillation[layer], 0.0);
    const bool endless = std::isinf(thickness[layer]);
    std::vector<double> lengths;
    // Only a layer without oscillation may be cut: an oscillating solution does not decay.
    const bool deep = cuttable && oscillates == 0 && depth + thickness[layer] > choice.deep / k;
    mesh.cut = endless || deep;
    double here = thickness[layer];
    if (endless) {
      here = std::max(choice.depth / k - depth, choice.largest / k);
    } else if (deep) {
      here = std::max(choice.deep / k - depth, choice.largest / k);
      here = std::min(here, thickness[layer]);
    }
    if (oscillates > k && !endless) {
      lengths = uniform(here, oscillates, choice);
    } else if (mesh.cut) {
      lengths = graded(here, k, choice);
    } else {
      // A layer between two faces is graded from both, and is symmetric about its middle.
      lengths = graded(here / 2, k, choice);
      std::vector<double> below(lengths.rbegin(), lengths.rend());
      lengths.insert(lengths.end(), below.begin(), below.end());
    }
    for (const double length : lengths) {
      from_top.push_back({length, static_cast<int>(layer)});
    }
    depth += here;
  }
  mesh.lines.assign(from_top.rbegin(), from_top.rend());
  return mesh;
}

}  // namespace langer

#include "results/post/map.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "mechanics/mesh/facets.hpp"

namespace langer {

std::vector<Complaint> MapChoice::complaints() const {
  if (is_field(line_of(field))) return {};
  return {{"field", line_of(field).word, "a quantity of nodes or points, as u_y or von_mises", ""}};
}

// Maps of sections are refused: their facets are lines.
std::vector<Complaint> complaints(const MapChoice& choice, const Body& body) {
  std::vector<Complaint> found;
  const Mesh& mesh = body.mesh();
  std::vector<std::string> facets, points;
  for (const auto& [name, set] : mesh.facet_sets)
    if (!set.empty()) facets.push_back(name);
  for (const auto& [name, nodes] : mesh.node_sets)
    if (nodes.size() == 1) points.push_back(name);
  const auto require = [&](const std::string& key, const std::string& name,
                           const std::vector<std::string>& known, const char* kind) {
    if (std::ranges::find(known, name) != known.end()) return;
    std::string expected = "none at all";
    if (!known.empty()) expected = fmt::format("one of {}", fmt::join(known, ", "));
    found.push_back({key, fmt::format("the mesh has no {} called \"{}\"", kind, name), expected,
                     did_you_mean(nearest(name, known))});
  };
  if (mesh.section)
    return {{"on", "facets of a section, which are lines", "a body in three dimensions",
             "renders show sections"}};
  require("on", choice.on, facets, "facets");
  for (std::size_t i = 0; i < choice.points.size(); ++i)
    require(fmt::format("points[{}]", i), choice.points[i], points, "point");
  if (line_of(choice.field).needs.fibres && choice.family > body.n_families())
    found.push_back({"family", "a fibre family that the material lacks", "another field", ""});
  return found;
}

SurfaceMap surface_map(const Body& body, const MapChoice& choice, const std::string& name,
                       const std::vector<double>& values, double t) {
  const Mesh& mesh = body.mesh();
  const QuantityLine& line = line_of(choice.field);
  SurfaceMap map{name, line.label, line.unit, t, {}, {}, {}, {}, {}};
  // Nodes are numbered in the order in which facets first name them.
  std::vector<int> number(mesh.X.size(), -1);
  for (const Facet& facet : mesh.facet_sets.at(choice.on)) {
    for (std::array<int, 4> quad : facet_quads(mesh, facet)) {
      for (int& node : quad) {
        if (number[node] < 0) {
          number[node] = static_cast<int>(map.places.size());
          map.places.push_back({mesh.X[node][0], mesh.X[node][2]});
          map.values.push_back(values[node]);
        }
        node = number[node];
      }
      map.facets.push_back(quad);
      if (body.n_families() == 0) continue;
      const auto fibres = body.fibres(facet.cell);
      PlanePoint direction{0, 0};  // of an element without fibres
      if (!fibres.empty()) direction = {fibres[0][0], fibres[0][2]};
      map.fibres.push_back(direction);
    }
  }
  for (const std::string& point : choice.points) {
    const Vec3& X = mesh.X[mesh.node_sets.at(point).front()];
    map.points[point] = {X[0], X[2]};
  }
  return map;
}

namespace {

// The bilinear coordinates in [0, 1] of a place in a quadrilateral, by Newton's method; nothing
// outside. The bounding box is checked first, because most quadrilaterals are far away.
std::optional<PlanePoint> within(const std::array<PlanePoint, 4>& corner, const PlanePoint& place) {
  constexpr double slack = 1e-9;
  for (int i = 0; i < 2; ++i) {
    const auto [low, high] = std::minmax({corner[0][i], corner[1][i], corner[2][i], corner[3][i]});
    if (place[i] < low - slack * (high - low) || place[i] > high + slack * (high - low)) return {};
  }
  double p = 0.5, q = 0.5;
  for (int iteration = 0; iteration < 30; ++iteration) {
    // f is the distance of the interpolated point from the place, fp and fq are its derivatives.
    const double N[] = {(1 - p) * (1 - q), p * (1 - q), p * q, (1 - p) * q};
    const double Np[] = {-(1 - q), 1 - q, q, -q};
    const double Nq[] = {-(1 - p), -p, p, 1 - p};
    double f[2] = {-place[0], -place[1]};
    double fp[2] = {0, 0};
    double fq[2] = {0, 0};
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 4; ++k) {
        f[i] += N[k] * corner[k][i];
        fp[i] += Np[k] * corner[k][i];
        fq[i] += Nq[k] * corner[k][i];
      }
    // One Newton step by Cramer's rule. A degenerate quadrilateral has no bilinear coordinates.
    const double det = fp[0] * fq[1] - fp[1] * fq[0];
    if (det == 0) return {};
    const double dp = (f[0] * fq[1] - f[1] * fq[0]) / det;
    const double dq = (fp[0] * f[1] - fp[1] * f[0]) / det;
    p -= dp;
    q -= dq;
    if (std::abs(dp) + std::abs(dq) < 1e-13) break;
  }
  if (!(p >= -slack && p <= 1 + slack && q >= -slack && q <= 1 + slack)) return {};
  return PlanePoint{p, q};
}

}  // namespace

// Facets are searched one by one; a map has some hundred.
std::optional<double> value_at(const SurfaceMap& map, const PlanePoint& place) {
  for (const auto& facet : map.facets) {
    const auto at = within(
        {map.places[facet[0]], map.places[facet[1]], map.places[facet[2]], map.places[facet[3]]},
        place);
    if (!at) continue;
    const auto [p, q] = *at;
    const double N[] = {(1 - p) * (1 - q), p * (1 - q), p * q, (1 - p) * q};
    double value = 0;
    for (int k = 0; k < 4; ++k) value += N[k] * map.values[facet[k]];
    return value;
  }
  return {};
}

// Nodes of b that are outside a are left out of the difference, but count for the size of b.
double difference(const SurfaceMap& a, const SurfaceMap& b, double beyond) {
  constexpr double slack = 1e-9;  // rounding must not split a ring of nodes at that distance
  double most = 0, size = 0;
  for (std::size_t i = 0; i < b.places.size(); ++i) {
    if (std::hypot(b.places[i][0], b.places[i][1]) < (1 - slack) * beyond) continue;
    size = std::max(size, std::abs(b.values[i]));
    if (const auto value = value_at(a, b.places[i]))
      most = std::max(most, std::abs(*value - b.values[i]));
  }
  if (size > 0) return most / size;
  return 0;
}

}  // namespace langer

#include "mechanics/mesh/directions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace langer {

namespace {

// bit by bit: files tell -0 from 0
bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0);
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// from e_x towards e_z, which is about -e_y
Vec3 turned(const Vec3& a, double angle_deg, const Mat3& frame) {
  return Eigen::AngleAxisd(-radians(angle_deg), frame.col(1)) * a;
}

}  // namespace

void Directions::append(std::vector<Vec3> a) {
  if (stored_.empty() || !same_bits(stored_.back(), a)) {
    first_.push_back(n_cells_);
    stored_.push_back(std::move(a));
  }
  ++n_cells_;
}

std::span<const Vec3> Directions::of(int cell) const {
  if (cell >= n_cells_) return {};
  return stored_[static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), cell) -
                                          first_.begin() - 1)];
}

Directions Directions::of_cells(std::span<const int> cells) const {
  Directions part(from_field_);
  for (int e : cells) part.append({of(e).begin(), of(e).end()});
  return part;
}

int Directions::n_families() const {
  std::size_t most = 0;
  for (const std::vector<Vec3>& a : stored_) most = std::max(most, a.size());
  return static_cast<int>(most);
}

Vec3 fibre_direction(double alpha_deg, const Mat3& frame) {
  const double alpha = radians(alpha_deg);
  return std::cos(alpha) * frame.col(0) + std::sin(alpha) * frame.col(2);
}

Directions make_directions(const Mesh& mesh, const std::vector<std::vector<double>>& angles,
                           const std::vector<FirstFamily>& fields) {
  const auto is_there = [](const FirstFamily& field) {
    return !std::holds_alternative<std::monostate>(field);
  };
  Directions directions(std::any_of(fields.begin(), fields.end(), is_there));
  const FirstFamily no_field;
  std::vector<std::size_t> cells_before(angles.size(), 0);  // of the same body
  for (int e = 0; e < mesh.n_cells(); ++e) {
    std::size_t body = 0;
    if (angles.size() > 1) body = static_cast<std::size_t>(mesh.body[e]);
    const std::size_t i = cells_before[body]++;
    Mat3 frame = Mat3::Identity();
    if (!mesh.frames.empty()) frame = mesh.frames[e];
    const FirstFamily& first = fields.empty() ? no_field : fields[body];
    std::vector<Vec3> a;
    for (double alpha : angles[body])
      if (const auto* given = std::get_if<std::vector<double>>(&first))
        a.push_back(fibre_direction((*given)[i] + alpha - angles[body][0], frame));
      else if (const auto* measured = std::get_if<std::vector<Vec3>>(&first))
        a.push_back(turned((*measured)[i], alpha - angles[body][0], frame));
      else
        a.push_back(fibre_direction(alpha, frame));
    directions.append(std::move(a));
  }
  return directions;
}

}  // namespace langer

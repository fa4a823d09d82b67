// What a rigid shape answers for itself. A new one: a struct with these members in a file of its
// own, and its word in the list of contact/rigid.hpp.
//   at(x)             gap: signed distance, > 0 outside [mm]; normal: gradient of the gap, from the shape to the body;
//                     curvature: dn/dx (3,3), symmetric, curvature n = 0, of the surface of constant gap through x [1/mm]
//   becomes(other, op)  `other` is its image; false where it cannot tell
//   outline(shown)    its surface, for pictures
//   half_width()      half the width of a shape that has an end everywhere, infinite without [mm]
//   inside()          a point inside of such a shape
//   axis()            that about which it may turn without becoming another: its axis of revolution; none where it has none
#pragma once

#include <concepts>
#include <optional>

#include "core/tensor/turn.hpp"
#include "core/tensor/types.hpp"
#include "mechanics/contact/outline.hpp"

namespace langer {

struct ShapePoint {
  double gap = 0;
  Vec3 normal = Vec3::UnitY();
  Mat3 curvature = Mat3::Zero();
};

// x -> centre + turn (x - centre), turn orthogonal: a turn or a mirror image
struct Isometry {
  Mat3 turn = Mat3::Identity();
  Vec3 centre = Vec3::Zero();
  Vec3 operator()(const Vec3& x) const;
};
inline constexpr double same_place = 1e-9;  // relative
bool goes_to(const Vec3& x, const Vec3& y, const Isometry& op);
bool turns_to(const Vec3& d, const Vec3& e, const Isometry& op);

template <class S>
concept Shape = requires(const S& shape, const Vec3& x, const Isometry& op, const Shown& shown) {
  { S::key } -> std::convertible_to<const char*>;
  { shape.at(x) } -> std::same_as<ShapePoint>;
  { shape.becomes(shape, op) } -> std::same_as<bool>;
  { shape.outline(shown) } -> std::same_as<Outline>;
  { shape.half_width() } -> std::same_as<double>;
  { shape.inside() } -> std::same_as<std::optional<Vec3>>;
  { shape.axis() } -> std::same_as<std::optional<Line>>;
};

// curvature round the axis a at the distance rho from it, where the normal has the component n_rho
// outwards: n_rho / rho along the circle
Mat3 ring(const Vec3& a, const Vec3& outward, double n_rho, double rho);
// a circular wall round the axis a and the unit vector from the axis through a point at the
// distance rho [mm]
enum class Wall { faces_away = 1, faces_axis = -1 };
struct RoundWall {
  Vec3 a, outward;
  double rho;
  Wall wall;
};
// surface of a core with a flat end (normal -a) and a circular wall, thickened by `edge`, from a
// point that lies `side` in front of the core's wall and `end` in front of its end, both negative
// inside [mm]; rho > 0 or no wall near
ShapePoint round_edged(const RoundWall& at, double side, double end, double edge);
Mat3 tangent_projection(const Vec3& n);
inline Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
// of a vector of any length above 0, one whose square is no number of the machine included
Vec3 direction(const std::array<double, 3>& a);

}  // namespace langer

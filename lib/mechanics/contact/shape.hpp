// The interface of a rigid shape. To add a shape, write a struct with these members in its own file
// and name it in the list of contact/rigid.hpp; no other code distinguishes shapes.
//   at(x)               gap: signed distance, positive outside [mm]
//                       normal: gradient of the gap, from the shape to the body
//                       curvature: dn/dx (3,3), symmetric, curvature n = 0, of the surface of
//                       constant gap through x [1/mm]
//   maps_onto(other, op)  whether op maps the shape onto `other`; false if this is not known
//   outline(shown)      the surface as polygons, for pictures
//   half_width()        half the width of a bounded shape, infinite for an unbounded one [mm]
//   inside()            a point inside a bounded shape
//   axis()              the axis of revolution, if there is one
//   force_order         order in the element size at which the force converges: 2 for a smooth
//                       surface; 1 if an edge or a face presses singular stresses into the body
// Some shapes have these members too; contact/rigid.hpp gives the answer of all others:
//   edge_sharpness()    width of the shape in radii of its rounded edge, else 1
//   hole()              the round hole that the body is drawn into, else none
//   ball()              the shape as a ball, if it is exactly one, else none
//   is_flat             whether its whole surface is one plane, else false
//   surface_file(), set_triangles(), ...   if its surface is read from a file
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

// A round hole with a rounded edge in a plate: the plate is flat from radius + edge on.
struct RoundHole {
  Line axis;          // from the face into the plate
  double radius = 0;  // [mm]
  double edge = 0;    // radius of the rounded edge [mm]
};

struct Ball {
  Vec3 centre;
  double radius = 0;  // [mm]
};

inline constexpr double same_place = 1e-9;  // relative
bool maps_point(const Vec3& x, const Vec3& y, const Isometry& op);
bool maps_direction(const Vec3& d, const Vec3& e, const Isometry& op);

template <class S>
concept Shape = requires(const S& shape, const Vec3& x, const Isometry& op, const Shown& shown) {
  { S::key } -> std::convertible_to<const char*>;
  { shape.at(x) } -> std::same_as<ShapePoint>;
  { shape.maps_onto(shape, op) } -> std::same_as<bool>;
  { shape.outline(shown) } -> std::same_as<Outline>;
  { shape.half_width() } -> std::same_as<double>;
  { shape.inside() } -> std::same_as<std::optional<Vec3>>;
  { shape.axis() } -> std::same_as<std::optional<Line>>;
  { S::force_order } -> std::convertible_to<int>;
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

// The surface of a rigid shape as polygons, for pictures: its corners lie on the surface of gap 0
// (of very many triangles nearly).
#pragma once

#include <array>
#include <vector>

#include "core/tensor/types.hpp"

namespace langer {

struct Outline {
  std::vector<Vec3> points;             // [mm]
  std::vector<std::vector<int>> faces;  // counter-clockwise seen from outside
  std::vector<std::vector<int>> lines;  // drawn from both sides: the grid of a plane
};

void add_face(Outline& out, const std::vector<Vec3>& corners);

// The extent of the picture: unbounded shapes are drawn as far as that.
struct Shown {
  Vec3 middle = Vec3::Zero();
  double size = 1;  // [mm]
  int parts = 48;   // of half a turn
};

// A surface of revolution: along and radius of its profile's corners [mm], from where the axis
// comes from; an end off the axis is closed if `closed`.
Outline revolved(const Vec3& origin, const Vec3& axis,
                 const std::vector<std::array<double, 2>>& profile, int sectors,
                 bool closed = true);

// The profile of a sphere about 0, from along = -radius.
std::vector<std::array<double, 2>> half_circle(double radius, int parts);

// The part of a surface on one side of the plane x[axis] = at (side 1: above, -1: below), and the
// faces in the plane that close it. A surface with an edge, as that of a plate with a hole,
// encloses no volume: there the plane leaves a line.
struct OpenedOutline {
  Outline kept, cap;
};
OpenedOutline cut_open(const Outline& outline, int axis, double at, double side);

}  // namespace langer

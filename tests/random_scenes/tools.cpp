#include "random_scenes/tools.hpp"

#include <fmt/os.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace langer::test {

namespace {

using Point = std::array<double, 3>;
using Triangle = std::array<Point, 3>;  // counterclockwise as seen from outside

// The file has no normals: readers take them from the order of the corners.
void write_stl(const std::string& path, const std::vector<Triangle>& surface) {
  auto file = fmt::output_file(path);
  file.print("solid tool\n");
  for (const Triangle& triangle : surface) {
    file.print("facet normal 0 0 0\nouter loop\n");
    for (const Point& p : triangle) file.print("vertex {:.9g} {:.9g} {:.9g}\n", p[0], p[1], p[2]);
    file.print("endloop\nendfacet\n");
  }
  file.print("endsolid tool\n");
}

// An ellipsoid of half axes a, b, c that is turned about z, its lowest point in the origin.
std::vector<Triangle> ellipsoid(double a, double b, double c, double degrees) {
  const int around = 64, along = 32;
  const double pi = std::numbers::pi, tilt = degrees * pi / 180;
  const double lowest = std::hypot(a * std::sin(tilt), b * std::cos(tilt));
  const double x_of_lowest = -(a * a - b * b) * std::sin(tilt) * std::cos(tilt) / lowest;
  const auto point = [&](int i, int j) -> Point {
    const double polar = pi * i / along, turn = 2 * pi * (j % around) / around;
    const double x = a * std::sin(polar) * std::cos(turn), y = -b * std::cos(polar),
                 z = c * std::sin(polar) * std::sin(turn);
    return {x * std::cos(tilt) - y * std::sin(tilt) - x_of_lowest,
            x * std::sin(tilt) + y * std::cos(tilt) + lowest, z};
  };
  std::vector<Triangle> surface;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      if (i > 0) surface.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
      if (i + 1 < along) surface.push_back({point(i, j + 1), point(i + 1, j), point(i + 1, j + 1)});
    }
  return surface;
}

// Corners 0 to 3 below, 4 to 7 above.
std::vector<Triangle> frustum(double below, double above, double height) {
  const std::array<Point, 8> at{{{-below, 0, -below},
                                 {below, 0, -below},
                                 {below, 0, below},
                                 {-below, 0, below},
                                 {-above, height, -above},
                                 {above, height, -above},
                                 {above, height, above},
                                 {-above, height, above}}};
  std::vector<Triangle> surface;
  const auto quadrilateral = [&](int i, int j, int k, int l) {
    const auto p = [&](int n) {
      return at[static_cast<std::size_t>(n)];
    };
    surface.push_back({p(i), p(j), p(k)});
    surface.push_back({p(i), p(k), p(l)});
  };
  quadrilateral(0, 1, 2, 3);
  quadrilateral(4, 7, 6, 5);
  for (int i = 0; i < 4; ++i) quadrilateral(i, i + 4, (i + 1) % 4 + 4, (i + 1) % 4);
  return surface;
}

}  // namespace

void write_tools(const std::string& folder) {
  for (const int tilt : {10, 25, 40})
    write_stl(folder + "/ellipsoid_" + std::to_string(tilt) + ".stl", ellipsoid(1, 0.6, 0.8, tilt));
  write_stl(folder + "/frustum.stl", frustum(1, 2, 1.5));
}

}  // namespace langer::test

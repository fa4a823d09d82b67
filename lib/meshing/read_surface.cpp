#include "meshing/read_surface.hpp"

#include <Eigen/Geometry>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "core/base/input_file.hpp"
#include "core/base/lower_case.hpp"

namespace langer {

namespace {

constexpr std::size_t header = 80,
                      record = 50;  // of a binary file: bytes before the count, bytes of a triangle

template <class Number>
Number little_endian(const char* at) {
  static_assert(std::endian::native == std::endian::little);
  Number n;
  std::memcpy(&n, at, sizeof n);
  return n;
}

bool is_binary(const std::string& bytes) {
  return bytes.size() >= header + 4 &&
         bytes.size() == header + 4 + record * little_endian<std::uint32_t>(bytes.data() + header);
}

// three corners for each triangle; normals are left out, the order of the corners says the same
std::vector<Vec3> corners_of_binary(const std::string& bytes) {
  std::vector<Vec3> corners;
  for (const char* at = bytes.data() + header + 4; at < bytes.data() + bytes.size(); at += record)
    for (int k = 1; k <= 3; ++k) {
      Vec3 x;
      for (int i = 0; i < 3; ++i)
        x[i] = static_cast<double>(little_endian<float>(at + 4 * (3 * k + i)));
      corners.push_back(x);
    }
  return corners;
}

// "vertex x y z", three in each "outer loop" ... "endloop"
std::vector<Vec3> corners_of_text(const std::string& text, auto refuse) {
  std::vector<Vec3> corners;
  std::istringstream lines(text);
  int n = 0;
  for (std::string line; std::getline(lines, line);) {
    ++n;
    std::istringstream words(line);
    std::string word;
    words >> word;
    word = lower_case(word);
    if (word == "endloop" && corners.size() % 3 != 0) refuse(n, "a facet that is no triangle");
    if (word != "vertex") continue;
    Vec3 x;
    for (int i = 0; i < 3; ++i) {
      std::string number;
      words >> number;
      const char *from = number.data() + number.starts_with('+'),
                 *to = number.data() + number.size();
      if (const auto [end, error] = std::from_chars(from, to, x[i]);
          error != std::errc{} || end != to)
        refuse(n, number.empty() ? "a corner of fewer than three coordinates"
                                 : "found \"" + number + "\" for a coordinate");
    }
    corners.push_back(x);
  }
  if (corners.size() % 3 != 0) refuse(n, "a facet that is no triangle");
  return corners;
}

// Points by their place: any two in a cell of the tolerance's length are one, further apart than
// twice that never.
class MergedPoints {
 public:
  explicit MergedPoints(double tolerance) : tolerance_(tolerance) {}
  int at(const Vec3& x) {
    const Key key{std::floor(x[0] / tolerance_), std::floor(x[1] / tolerance_),
                  std::floor(x[2] / tolerance_)};
    for (double i : {0., -1., 1.})
      for (double j : {0., -1., 1.})
        for (double k : {0., -1., 1.})
          if (const auto found = place_.find({key[0] + i, key[1] + j, key[2] + k});
              found != place_.end() &&
              (points[static_cast<std::size_t>(found->second)] - x).norm() <= 2 * tolerance_)
            return found->second;
    points.push_back(x);
    return place_[key] = static_cast<int>(points.size()) - 1;
  }
  std::vector<Vec3> points;

 private:
  using Key = std::array<double, 3>;
  double tolerance_;
  std::map<Key, int> place_;
};

}  // namespace

Triangles parse_surface(const std::string& bytes, const std::string& shown_name,
                        FlatTriangles flat) {
  const auto refuse = [&](int line, const std::string& found) {
    Place place{shown_name, line, 0};
    if (line > 0) place.column = 1;
    throw Failure(Exit::input,
                  Error{place, "", found, "an STL file with triangles, normals outwards", ""});
  };
  std::vector<Vec3> corners;
  if (is_binary(bytes)) {
    corners = corners_of_binary(bytes);
  } else {
    // No text has a byte 0: binary data that were cut off or lengthened.
    const bool is_text = bytes.find('\0') == std::string::npos;
    if (!is_text && bytes.size() >= header + 4) {
      const double n = little_endian<std::uint32_t>(bytes.data() + header);
      refuse(0, fmt::format("no triangles: binary data of {} bytes, where {} triangles take {}",
                            bytes.size(), n, header + 4 + static_cast<double>(record) * n));
    }
    corners = corners_of_text(bytes, refuse);
  }
  if (corners.empty()) refuse(0, "no triangles");
  Vec3 low = corners[0];
  Vec3 high = low;
  for (const Vec3& x : corners) {
    if (!x.allFinite() || !(x.lpNorm<Eigen::Infinity>() < 1e100))
      refuse(0, "a position that is not finite");
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double size = (high - low).norm();
  if (!(size > 1e-100)) refuse(0, "triangle 1 has no area");
  MergedPoints unique(0.5e-8 * size);
  Triangles surface;
  for (std::size_t t = 0; 3 * t < corners.size(); ++t) {
    std::array<int, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = unique.at(corners[3 * t + k]);
    if (flat == FlatTriangles::allowed) {
      const bool is_triangle = c[0] != c[1] && c[1] != c[2] && c[2] != c[0];
      if (is_triangle) surface.corners.push_back(c);
      continue;
    }
    const Vec3 ab = unique.points[c[1]] - unique.points[c[0]];
    const Vec3 ac = unique.points[c[2]] - unique.points[c[0]];
    if (!(ab.cross(ac).norm() > 1e-14 * ab.norm() * ac.norm()))
      refuse(0, fmt::format("triangle {} has no area", t + 1));
    surface.corners.push_back(c);
  }
  if (surface.corners.empty()) refuse(0, "triangle 1 has no area");
  surface.points = std::move(unique.points);
  return surface;
}

Triangles read_surface(const std::string& path, FlatTriangles flat) {
  return parse_surface(read_file(path, "an STL file with triangles, normals outwards"), path, flat);
}

}  // namespace langer

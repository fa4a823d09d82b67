// A rigid surface of triangles, thickened by a rounding radius so that its normal is continuous
// over edges and corners.
//   gap = distance to the triangles - rounding;  faces are flat, edges and corners are parts of cylinders and spheres
// The triangles come from a file (lib/meshing/read_surface.hpp) and must point outwards.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/input_path.hpp"
#include "mechanics/contact/shape.hpp"
#include "mechanics/mesh/triangles.hpp"

namespace langer {

// Finds the nearest triangle quickly: a tree of boxes.
class TriangleTree {
 public:
  explicit TriangleTree(Triangles triangles);
  struct Nearest {
    Vec3 point;  // on the triangles
    double
        sign;  // +1 outside, -1 inside (by the normals of the triangles around the nearest point)
    int feature;     // 0 face, 1 edge, 2 corner
    Vec3 direction;  // of the edge, or normal of the face
  };
  Nearest nearest(const Vec3& x) const;
  const Triangles& triangles() const { return t_; }

 private:
  struct Box {
    Vec3 low, high;
    int first, last;  // triangles of a leaf
    int left = -1, right = -1;
  };
  int build(int first, int last);
  Triangles t_;
  std::vector<int> order_;
  std::vector<Box> boxes_;
};

struct Facets {
  static constexpr const char* key = "facets";
  InputPath file;
  double rounding = 0, scale = 1;
  std::array<double, 3> move{};
  std::shared_ptr<const TriangleTree> tree;  // filled when the scene is made
  static void fields(auto& v) {
    v(&Facets::file, "file", unit::none, "STL file of the surface, normals outwards", required);
    v(&Facets::rounding, "rounding", unit::mm,
      "what the surface is thickened by; radius of its edges", required, positive);
    v(&Facets::scale, "scale", unit::none, "factor that makes the file's lengths millimetres",
      positive);
    v(&Facets::move, "move", unit::mm, "added to the file's positions after scaling");
  }
  ShapePoint at(const Vec3& x) const;
  bool maps_onto(const Facets&, const Isometry&) const {
    return false;
  }  // triangles are not compared
  Outline outline(const Shown& shown)
      const;  // of many triangles a coarser picture: as many as one of a sphere has, about
  double half_width() const;
  std::optional<Vec3> inside() const { return tree->nearest(Vec3::Zero()).point; }
  std::optional<Line> axis() const { return std::nullopt; }
  static constexpr int force_order = 2;

  std::string surface_file() const { return file.path; }
  void set_file_triangles(Triangles in_file);  // scales and moves them
  void set_triangles(Triangles in_place);
  const Triangles* triangles() const { return &tree->triangles(); }
};

}  // namespace langer

// Solids of CAD, and those that triangles enclose, meshed by gmsh.
#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/reference.hpp"
#include "meshing/closed_surface.hpp"
#include "meshing/exchange.hpp"
#include "meshing/gmsh/gmsh_load.hpp"
#include "meshing/msh_mesh.hpp"
#include "meshing/read_surface.hpp"
#include "meshing/seal_holes.hpp"
#include "meshing/split_tetrahedra.hpp"

namespace langer {

namespace {

using gmsh_module::SolidOrder;

// A mesh and what was noted on the way to it.
struct Attempt {
  Mesh mesh;
  std::vector<std::string> notes;
  Quality quality;

  bool is_sound() const {
    return quality.least_jacobian > 0 && std::isfinite(quality.volume) && quality.volume > 0;
  }
};

class SolidMesher {
 public:
  SolidMesher(const std::string& path, const SolidOptions& options)
      : path_(path),
        is_surface_(options.is_surface),
        edge_(options.edge),
        seal_(options.seal),
        scale_(options.scale) {
    hexahedra_ = reference(options.cells).hexahedron();
    if (is_surface_)
      read_closed_surface();
    else
      read_step();
  }

  Mesh mesh(std::vector<std::string>& notes) {
    Attempt best = best_attempt();
    if (is_surface_) add_volume_note(best);
    notes.insert(notes.end(), sealed_.begin(), sealed_.end());
    notes.insert(notes.end(), best.notes.begin(), best.notes.end());
    return std::move(best.mesh);
  }

 private:
  std::string path_;
  bool is_surface_;
  double edge_;
  double seal_;
  double scale_;                     // mm per unit of the file
  std::vector<std::string> sealed_;  // notes
  bool hexahedra_ = true;
  std::string step_;
  gmsh_module::Surface surface_;
  double enclosed_ = 0;  // volume of the surface

  [[noreturn]] void refuse(const std::string& found, const std::string& expected,
                           const std::string& hint = "") const {
    throw Failure(Exit::input, Error{{path_}, "", found, expected, hint});
  }

  void read_closed_surface() {
    Triangles triangles = read_surface(path_, FlatTriangles::allowed);
    for (const Hole& hole : holes_of(triangles)) {
      if (hole.width > seal_ || !fill(hole, triangles)) continue;
      sealed_.push_back(
          fmt::format("filled a hole of {} edges, {:.3g} mm wide, at ({:.4g}, {:.4g}, {:.4g}) mm",
                      hole.points.size(), scale_ * hole.width, scale_ * hole.middle[0],
                      scale_ * hole.middle[1], scale_ * hole.middle[2]));
    }
    require_closed(triangles, path_);
    enclosed_ = enclosed_volume(triangles);
    require_edge_within(triangles);
    for (const Vec3& point : triangles.points)
      for (int i = 0; i < 3; ++i) surface_.X.push_back(point[i]);
    for (const std::array<int, 3>& corners : triangles.corners)
      for (const int corner : corners)
        surface_.corners.push_back(static_cast<std::size_t>(corner) + 1);
  }

  // Elements longer than half of the surface cannot follow it: mostly the file is in other units.
  void require_edge_within(const Triangles& triangles) const {
    Eigen::AlignedBox3d box;
    for (const Vec3& point : triangles.points) box.extend(point);
    const double longest = box.sizes().maxCoeff();
    if (edge_ <= 0.5 * longest) return;
    refuse(fmt::format("edge: {:.3g} mm for a surface that is {:.3g} mm long", scale_ * edge_,
                       scale_ * longest),
           fmt::format("at most half of it, {:.3g} mm", 0.5 * scale_ * longest),
           scale_ == 1 && longest < 1 ? "is the file in metres? then scale: 1000 next to edge"
                                      : "scale gives the mm of one unit of the file");
  }

  // gmsh is given nothing but STEP, whatever the file is called.
  void read_step() {
    const char* expected = "a STEP file, which begins with ISO-10303-21";
    step_ = read_file(path_, expected);
    std::string_view text = step_;
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos || !text.substr(first).starts_with("ISO-10303-21"))
      refuse("this is no STEP file", expected);
  }

  MshModel model(const SolidOrder& order, std::vector<std::string>& notes) const {
    if (is_surface_) return mesh_surface_by_gmsh(surface_, order, path_, notes);
    return mesh_step_by_gmsh(step_, order, path_, notes);
  }

  Attempt attempt(const SolidOrder& order, bool split = false) const {
    Attempt made;
    MshModel found = model(order, made.notes);
    if (!found.has_volumes) {
      if (is_surface_) refuse("no solid body", "triangles that enclose one");
      refuse("no solid body", "a STEP file with a solid");
    }
    if (split) found = split_into_hexahedra(found);
    made.mesh = mesh_of(found, path_, made.notes);
    made.quality = quality(made.mesh);
    return made;
  }

  // Tetrahedra are used as they are. Hexahedra are split from tetrahedra by gmsh, with new nodes on
  // the surface. Where these fold a cell, or gmsh cannot find their places on a surface of
  // triangles, new nodes stay in the middles of straight edges.
  Attempt best_attempt() const {
    SolidOrder order{edge_, hexahedra_, false};
    Attempt curved = attempt(order);
    if (!hexahedra_ || curved.is_sound()) return curved;
    order.straight = true;
    Attempt straight = attempt(order);
    const double lost = std::abs(straight.quality.volume / curved.quality.volume - 1);
    if (straight.is_sound() && lost < 0.01) {
      straight.notes.push_back(
          fmt::format("nodes on the surface would fold cells: the edges of split tetrahedra stay "
                      "straight, which changes the volume by {:.2g} %",
                      100 * lost));
      return straight;
    }
    if (!is_surface_) return curved;  // another body: the folded cells are refused
    const SolidOrder tetrahedra{2 * edge_, false, false};
    Attempt split = attempt(tetrahedra, true);
    if (!split.is_sound())
      refuse("gmsh makes folded hexahedra of this surface", "a surface that it can mesh",
             "cells: tet15 uses tetrahedra, which do not fold");
    split.notes.push_back(
        "nodes on the surface would fold cells: the edges of split tetrahedra stay straight; "
        "cells: tet15 follows the surface better at the same edge");
    return split;
  }

  // Straight edges cut off what bulges between them.
  void add_volume_note(Attempt& made) const {
    if (!made.is_sound()) return;
    const double change = made.quality.volume / enclosed_ - 1;
    constexpr double noted = 0.005;
    constexpr double refused = 0.25;
    if (std::abs(change) < noted) return;
    const double per_unit = scale_ * scale_ * scale_;
    const std::string found =
        fmt::format("the mesh has {:.3g} mm^3, the surface encloses {:.3g} mm^3 ({:+.2g} %)",
                    per_unit * made.quality.volume, per_unit * enclosed_, 100 * change);
    std::string other;
    if (hexahedra_) other = ", and so does cells: tet15 at the same edge";
    if (std::abs(change) > refused)
      refuse(found, "a mesh with the volume of the surface",
             "a smaller edge follows the surface better" + other);
    made.notes.push_back("warning: " + found +
                         ": straight edges cut off what is curved; "
                         "a smaller edge follows the surface better");
  }
};

}  // namespace

Mesh read_solid(const std::string& path, const SolidOptions& options,
                std::vector<std::string>& notes) {
  return SolidMesher(path, options).mesh(notes);
}

}  // namespace langer

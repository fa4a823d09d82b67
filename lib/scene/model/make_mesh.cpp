#include "scene/model/make_mesh.hpp"
#include "core/base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mechanics/mesh/cut.hpp"
#include "mechanics/mesh/order.hpp"
#include "mechanics/mesh/raise.hpp"
#include "mechanics/mesh/section.hpp"
#include "meshing/grading.hpp"

namespace langer {

namespace {

// Selects the sets of the config; facets of a set are those with all nodes in it.
void name_sets(Mesh& mesh, const MeshConfig& config) {
  const std::vector<int> all = all_nodes(mesh);
  const std::vector<Facet> outer = boundary(mesh);
  for (const auto& [name, set] : config.sets) {
    std::vector<int> nodes = select(mesh, set.within, set.of ? mesh.node_sets.at(*set.of) : all);
    if (mesh.section) nodes = through_layers(mesh, in_front(mesh, nodes));
    if (nodes.empty())
      refuse("sets." + name, "no node of the mesh is in this set", "at least one", "");
    const std::vector<Facet> facets =
        facets_within(mesh, set.of ? mesh.facet_sets.at(*set.of) : outer, nodes);
    mesh.node_sets[name] = nodes;
    if (!facets.empty()) mesh.facet_sets[name] = facets;
  }
}

// Assigns cells to bodies: by the file, or by the thicknesses of layers from the bottom to the top.
void name_bodies(Mesh& mesh, const MeshConfig& config) {
  if (!mesh.bodies.empty()) {  // those of a file
    for (std::string& body : mesh.bodies)
      if (body.empty()) body = config.body;
    if (std::set<std::string>(mesh.bodies.begin(), mesh.bodies.end()).size() != mesh.bodies.size())
      refuse("body", "found the name of another body of the file", "another name", "");
    return;
  }
  mesh.bodies = {config.body};
  mesh.body.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  if (config.bodies.empty()) return;
  mesh.bodies.clear();
  const auto [origin, size] = box(config.geometry);
  double low = origin[1];
  for (std::size_t b = 0; b < config.bodies.size(); ++b) {
    mesh.bodies.push_back(config.bodies[b].name);
    const double high = low + config.bodies[b].thickness;
    const double slack = 1e-9 * size[1];
    for (int e = 0; e < mesh.n_cells(); ++e) {
      double least = mesh.X[mesh.cell(e)[0]][1];
      double most = least;
      for (int n : mesh.cell(e)) {
        least = std::min(least, mesh.X[n][1]);
        most = std::max(most, mesh.X[n][1]);
      }
      if (least > low - slack && most < high + slack) mesh.body[e] = static_cast<int>(b);
      if (least < high - slack && most > high + slack)
        refuse(fmt::format("bodies[{}].thickness", b),
               fmt::format("its upper border y = {:g} mm cuts through cells from {:g} to {:g} mm",
                           high, least, most),
               "a border between cells",
               "change the thickness, or the divisions or layers of the geometry");
    }
    low = high;
  }
}

// Grid lines go through the borders of layers. If one number gives the cells, or an estimate
// changes their size, the user cannot place them between the borders.
Geometry with_borders(const MeshConfig& config) {
  Geometry geometry = config.geometry;
  std::vector<double> borders;
  double y = box(geometry).origin[1];
  for (std::size_t b = 0; b + 1 < config.bodies.size(); ++b)
    borders.push_back(y += config.bodies[b].thickness);
  const auto put = [&](auto* with_lines) {
    if (with_lines) with_lines->borders = borders;
  };
  put(std::get_if<Block>(&geometry));
  put(std::get_if<SectionBox>(&geometry));
  put(std::get_if<IndentedBlock>(&geometry));
  put(std::get_if<IndentedDisc>(&geometry));
  return geometry;
}

CutRegion region_of(const Selection& within) {
  if (const auto* box = std::get_if<InBox>(&within))
    return {Vec3(box->from.data()), Vec3(box->to.data())};
  const auto& round = std::get<InCylinder>(within);
  const Vec3 half(round.radius, 1e9, round.radius);
  const Vec3 through(round.through.data());
  return {through - half, through + half, true};
}

// Cuts the cells of each region into eight, as many times as asked for. Neighbours are cut as well
// where two levels would meet (2:1 rule), so the number of cells is checked before each round.
Mesh with_cuts(Mesh mesh, const std::vector<CutConfig>& cuts) {
  CutMesh cells(std::move(mesh));
  for (int time = 0;; ++time) {
    std::vector<char> marked(static_cast<std::size_t>(cells.mesh().n_cells()), 0);
    for (const CutConfig& cut : cuts) {
      if (time >= cut.times) continue;
      const CutRegion region = region_of(cut.within);
      for (int e = 0; e < cells.mesh().n_cells(); ++e)
        if (has_part_of(region, cells.mesh(), e)) marked[static_cast<std::size_t>(e)] = 1;
    }
    const long long more = 7LL * std::count(marked.begin(), marked.end(), 1);
    if (more == 0) return cells.mesh();
    if (cells.mesh().n_cells() + more > most_cells)
      refuse("cuts", fmt::format("found more than {} cells", cells.mesh().n_cells() + more),
             fmt::format("at most {}", most_cells), "smaller regions, or fewer times");
    cells.cut(std::move(marked));
  }
}

// Points through which grid lines go. In an axisymmetric section they include the radii of sets, so
// that a hole or a ring has the same size on all meshes. Heights are not included: a set may
// consist of inner nodes.
Points with_radii(const MeshConfig& config) {
  Points points = config.positions();
  const auto* section = std::get_if<SectionBox>(&config.geometry);
  if (!section || section->of != SectionOf::axisymmetric) return points;
  const auto [low, high] = std::pair(section->origin[0], section->origin[0] + section->size[0]);
  for (const auto& [name, set] : config.sets) {
    const auto* cylinder = std::get_if<InCylinder>(&set.within);
    if (!cylinder || cylinder->axis != "y" || cylinder->through[0] != 0) continue;
    for (double radius : {cylinder->radius, cylinder->beyond.value_or(0)})
      if (radius > low && radius < high)
        points[fmt::format("{} {}", name, radius)] = {radius, section->origin[1], 0};
  }
  return points;
}

Mesh with_lines(const MeshConfig& config, std::vector<std::string>& notes) {
  const auto through = [&](const Points& points) {
    return std::visit(
        [&](const auto& g) {
          if constexpr (std::is_same_v<std::decay_t<decltype(g)>, FromFile>)
            return mesh_of(g, config.cells, notes);
          else
            return mesh_of(g, points, notes);
        },
        with_borders(config));
  };
  if (const Points points = with_radii(config); points.size() > config.points.size()) try {
      return through(points);
    } catch (const Failure&) {  // cells too long for so many lines: sets take whole ones then
      notes.clear();
    }
  return through(config.positions());
}

// Cells of a file do not follow from numbers of the config.
void refuse_folded_in_file(const Quality& q) {
  if (q.least_jacobian > 0) return;
  refuse("geometry.file.path",
         fmt::format("cell {} of the file is folded: Jacobian {:.3g} mm^3 at ({:.4g}, {:.4g}, "
                     "{:.4g})",
                     q.at_cell, q.least_jacobian, q.at[0], q.at[1], q.at[2]),
         "a positive Jacobian everywhere",
         "repair this cell in the program that made the file, for instance by smaller cells there");
}

// Lays the bottom of a flat body on a circle about the z direction, convex towards +y.
void bend_mesh(Mesh& mesh, const MeshConfig& config) {
  const Box spans = box(config.geometry);
  const double radius = config.bend->radius;
  double middle = spans.origin[0] + 0.5 * spans.size[0];
  const bool round = mesh.section && mesh.section->of == SectionOf::axisymmetric;
  if (round) middle = 0;
  const double bottom = spans.origin[1];
  for (std::size_t i = 0; i < mesh.X.size(); ++i) {
    Vec3& X = mesh.X[i];
    const double angle = (X[0] - middle) / radius;
    const double r = radius + X[1] - bottom;
    const double depth = X[0] == 0 ? 0 : X[2] / X[0];
    // a quarter of a circle ends in the plane itself
    const double cosine = std::abs(std::cos(angle)) < 1e-15 ? 0 : std::cos(angle);
    X[0] = middle + r * std::sin(angle);
    X[1] = bottom - radius + r * cosine;
    if (round) X[2] = depth * X[0];
  }
}

// Order matters: cells, their order (second order nodes), cuts, points, bodies, frames, sets. Sets
// of a mesh file have priority over the names of sides.
MadeMesh made(const MeshConfig& config) {
  MadeMesh result;
  Mesh& mesh = result.mesh;
  const bool from_file = std::holds_alternative<FromFile>(config.geometry);
  mesh = with_lines(config, from_file ? result.of_file : result.notes);
  if (config.cells != mesh.type) {
    const auto section = mesh.section;
    mesh = raised(mesh, config.cells);
    const auto [origin, size] = box(config.geometry);
    if (section)
      make_section(mesh, *section);
    else {
      number_in_order(mesh);
      make_symmetric(mesh, Vec3(origin[0] + 0.5 * size[0], 0, origin[2] + 0.5 * size[2]));
    }
  }
  if (!config.cuts.empty()) mesh = with_cuts(std::move(mesh), config.cuts);
  name_points(mesh, config.positions());
  result.quality = quality(mesh);
  if (from_file)
    refuse_folded_in_file(result.quality);
  else
    refuse_folded(result.quality, "geometry");
  name_bodies(mesh, config);
  if (config.frames == Frames::file && mesh.frames.empty())
    refuse("frames", "found file, and its sections have no *ORIENTATION that can be used",
           "frames: global", "the notes of langer-mesh say what was left out of the file");
  mesh.frames = frames(mesh, config.frames);
  const auto node_sets = mesh.node_sets;
  const auto facet_sets = mesh.facet_sets;
  name_sides(mesh);
  for (const auto& [name, set] : node_sets)
    mesh.node_sets[name] = set;  // a file's own sides come before ours
  for (const auto& [name, set] : facet_sets) mesh.facet_sets[name] = set;
  for (const auto& [name, set] : config.sets)
    if (node_sets.count(name))
      refuse("sets." + name, "found the name of a set of the file", "another name", "");
  name_sets(mesh, config);
  if (mesh.section) {
    for (const char* side : {"z_min", "z_max"}) {
      mesh.node_sets.erase(side);
      mesh.facet_sets.erase(side);
    }
    for (auto& [name, nodes] : mesh.node_sets) nodes = in_front(mesh, nodes);
  }
  if (config.bend) {
    bend_mesh(mesh, config);
    mesh.frames = frames(mesh, config.frames);
    result.quality = quality(mesh);
    refuse_folded(result.quality, "bend");
  }
  return result;
}

}  // namespace

MadeMesh make_mesh(const MeshConfig& config,
                   const std::function<Place(const std::string&)>& where) {
  try {
    return made(config);
  } catch (const Failure& failure) {
    std::vector<Error> errors = failure.errors();
    for (Error& e : errors)
      if (e.where.file.empty()) e.where = where(e.key);
    throw Failure(failure.code(), errors);
  }
}

}  // namespace langer

// What the mesh stage's YAML may say: one geometry, the frames of its cells, observation points and
// further named sets. The sides x_min x_max y_min y_max z_min z_max and top, bottom (= y_max,
// y_min) are always there, as nodes and facets.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "core/base/fields.hpp"
#include "core/base/text.hpp"
#include "mechanics/mesh/frames.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/select.hpp"
#include "meshing/block.hpp"
#include "meshing/exchange.hpp"

namespace langer {

struct SetConfig {
  std::optional<std::string> of;
  Selection within;
  static void fields(auto& v) {
    v(&SetConfig::of, "of", unit::none, "side that the nodes are taken from; none: the whole mesh");
    v(&SetConfig::within, "within", unit::none, "which of those nodes", required);
  }
  std::vector<Complaint> complaints() const {
    const auto sides = side_names();
    if (!of || std::find(sides.begin(), sides.end(), *of) != sides.end()) return {};
    std::string known;
    for (const std::string& side : sides) append(known, ", ", side);
    known = "one of " + known;
    return {{"of", "found \"" + *of + "\"", known, ""}};
  }
};

struct LayerConfig {
  std::string name;
  double thickness = 0;
  static void fields(auto& v) {
    v(&LayerConfig::name, "name", unit::none, "name of the body", required);
    v(&LayerConfig::thickness, "thickness", unit::mm,
      "along y; cells end at its borders: lines of a grid go through them, those of a file must lie there",
      required, positive);
  }
  std::vector<Complaint> complaints() const {
    if (!name.empty() && name.find_first_of(" \t\n./") == std::string::npos) return {};
    return {{"name", "found \"" + name + "\"", "a name without spaces, points and slashes", ""}};
  }
};

struct CutConfig {
  Selection within;
  int times = 1;
  static void fields(auto& v) {
    v(&CutConfig::within, "within", unit::none,
      "box, or cylinder along y: cells that have a part of it", required);
    v(&CutConfig::times, "times", unit::none, "cuts, each into eight", between(1, 8));
  }
  std::vector<Complaint> complaints() const {
    if (std::holds_alternative<InBox>(within)) return {};
    if (const auto* round = std::get_if<InCylinder>(&within);
        round && round->axis == "y" && !round->beyond)
      return {};
    return {{"within", "found another region", "a box, or a cylinder along y", ""}};
  }
};

struct BendConfig {
  static constexpr const char* short_key = "radius";
  double radius = 0;
  static void fields(auto& v) {
    v(&BendConfig::radius, "radius", unit::mm,
      "of the circle on which the bottom of the geometry is laid, its length unchanged", required,
      positive);
  }
};

struct MeshConfig {
  std::string body = "skin";
  std::vector<LayerConfig> bodies;
  Geometry geometry;
  CellType cells = CellType::hex8;
  std::vector<CutConfig> cuts;
  Frames frames = Frames::global;
  std::optional<BendConfig> bend = {};
  std::map<std::string, std::array<double, 3>> points;
  std::map<std::string, SetConfig> sets;
  std::vector<MeshFormat> exports;
  static void fields(auto& v) {
    v(&MeshConfig::body, "body", unit::none,
      "name of the body, where it is one, or of what a file gives no name");
    v(&MeshConfig::bodies, "bodies", unit::none,
      "layers from the bottom up, each a body of its own; none: one body");
    v(&MeshConfig::geometry, "geometry", unit::none, "what is meshed", required);
    v(&MeshConfig::cells, "cells", unit::none,
      "hex8, or hex27: quadratic displacements with nodes in the middles of edges, facets and cells too; about 8 times the work of "
      "a hex8, and far fewer are needed; tet15, where geometry is a file: tetrahedra with quadratic displacements and bubbles; of an "
      ".inp what it has: hex27 of 20 or 27 nodes, tet15 of 4 or 10");
    v(&MeshConfig::cuts, "cuts", unit::none,
      "regions whose hex8 are cut into eight; the nodes in the middles of larger cells next to them move with the corners of these");
    v(&MeshConfig::frames, "frames", unit::none,
      "what the fibres' angle is measured in: the coordinate axes, each cell's edges, or the *ORIENTATION of an .inp file, from its "
      "axis 1 to its axis 2");
    v(&MeshConfig::bend, "bend", unit::none,
      "a flat block or section is bent about the z direction: an arch; of an axisymmetric section a spherical cap or shell. Its bottom lies "
      "on a circle that is convex towards +y, its middle (of an axisymmetric section the axis) where it was. Points, sets and sides are "
      "named on the flat body");
    v(&MeshConfig::points, "points", unit::mm,
      "observation points by name: sets of one node, exactly there");
    v(&MeshConfig::sets, "sets", unit::none,
      "further sets by name: nodes, and the facets of the surface between them");
    v(&MeshConfig::exports, "export", unit::none,
      "the mesh for other programs next to the output, hex8 only: msh for Gmsh, inp for Abaqus and CalculiX; bodies and sets are kept");
  }
  Points positions() const {
    Points positions;
    for (const auto& [name, x] : points) positions[name] = {x[0], x[1], x[2]};
    return positions;
  }
  std::vector<Complaint> complaints() const {
    std::vector<Complaint> found =
        std::visit([&](const auto& g) { return contradictions(g, positions()); }, geometry);
    const ReferenceCell& cell = reference(cells);
    const char* name = names(cells)[static_cast<std::size_t>(cells)];
    double thickness = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      thickness += bodies[i].thickness;
      for (std::size_t k = 0; k < i; ++k)
        if (bodies[k].name == bodies[i].name)
          found.push_back({"bodies[" + std::to_string(i) + "].name",
                           "found \"" + bodies[i].name + "\" again", "another name", ""});
    }
    if (std::holds_alternative<FromFile>(geometry)) {
      const std::string expected = "none, where geometry is a file";
      if (!bodies.empty())
        found.push_back({"bodies", "found " + std::to_string(bodies.size()) + " layers", expected,
                         "the bodies are those of the file"});
      if (cell.hexahedron() && cell.second_order() && !std::get<FromFile>(geometry).is_inp())
        found.push_back({"cells", std::string("found ") + name,
                         "hex8 or tet15, where geometry is no .inp", ""});
      if (frames == Frames::file && !std::get<FromFile>(geometry).is_inp())
        found.push_back({"frames", "found file, and geometry is no .inp", "global",
                         "only an .inp has directions, as *ORIENTATION"});
      if (!cell.hexahedron() && frames == Frames::element_edges)
        found.push_back({"frames", std::string("found element_edges together with cells: ") + name,
                         "global: no edge of a tetrahedron stands for a direction", ""});
    } else {
      if (frames == Frames::file)
        found.push_back(
            {"frames", "found file, and geometry is no file", "global or element_edges", ""});
      if (!cell.hexahedron())
        found.push_back(
            {"cells", std::string("found ") + name,
             "hex8 or hex27: tetrahedra are for bodies from a file (geometry: {file: ...})", ""});
      if (const double height = box(geometry).size[1];
          !bodies.empty() && !(std::abs(thickness - height) <= 1e-9 * height))
        found.push_back({"bodies", fmt::format("found layers of {:g} mm in all", thickness),
                         fmt::format("{:g} mm, the height of the geometry", height),
                         "change a thickness, or the second number of its size"});
    }
    if (bend) complain_of_bend(found);
    if (!cuts.empty() && (cells != CellType::hex8 || is_section(geometry)))
      found.push_back(
          {"cuts", "found together with other cells than the hex8 of a body", "none", ""});
    if (!cuts.empty() && !exports.empty())
      found.push_back({"export", "found together with cuts",
                       "none: other programs know no nodes that hang", ""});
    if (!exports.empty() && is_section(geometry))
      found.push_back({"export", "found with a section",
                       "none: other programs have sections of their own", ""});
    else if (!exports.empty() && !cell.names.abaqus.written)
      found.push_back(
          {"export", std::string("found together with cells: ") + name, "cells: hex8", ""});
    const auto sides = side_names();
    const auto is_side = [&](const std::string& name) {
      return std::find(sides.begin(), sides.end(), name) != sides.end();
    };
    for (const auto& [name, x] : points)
      if (is_side(name))
        found.push_back({"points." + name, "found the name of a side", "another name", ""});
    for (const auto& [name, set] : sets) {
      if (is_side(name))
        found.push_back({"sets." + name, "found the name of a side", "another name", ""});
      if (points.count(name))
        found.push_back({"sets." + name, "found the name of a point", "another name", ""});
    }
    return found;
  }

 private:
  void complain_of_bend(std::vector<Complaint>& found) const {
    const auto* section = std::get_if<SectionBox>(&geometry);
    if (!section && !std::holds_alternative<Block>(geometry)) {
      found.push_back({"bend", "found with another geometry", "block or section", ""});
      return;
    }
    const Box spans = box(geometry);
    const bool round = section && section->of == SectionOf::axisymmetric;
    double angle = spans.size[0] / bend->radius;
    if (round) angle = 2 * (spans.origin[0] + spans.size[0]) / bend->radius;
    if (angle > 6.2831853072)
      found.push_back(
          {"bend.radius", "found a circle that the body goes around more than once",
           round ? "at least its outer radius over pi" : "at least its length over 2 pi", ""});
    if (!cuts.empty()) found.push_back({"bend", "found together with cuts", "one of the two", ""});
  }
};

}  // namespace langer

// Solids that triangles enclose: what is wrong with a surface is found before meshing, and what a
// mesh loses of the volume is stated.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/select.hpp"
#include "meshing/closed_surface.hpp"
#include "meshing/exchange.hpp"
#include "meshing/read_surface.hpp"
#include "meshing/seal_holes.hpp"
#include "meshing/split_tetrahedra.hpp"
#include "support/near.hpp"

using namespace langer;

namespace solid_tests {

namespace {

std::string folder() {
  const auto path = std::filesystem::path(BINARY_DIR) / "test_files" / "solid";
  std::filesystem::create_directories(path);
  return path.string();
}

using Corners = std::array<Vec3, 3>;

std::string stl_text(const std::vector<Corners>& triangles) {
  std::string text = "solid body\n";
  for (const Corners& corners : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : corners) text += fmt::format("vertex {} {} {}\n", x[0], x[1], x[2]);
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid body\n";
}

std::string write_stl(const std::string& name, const std::vector<Corners>& triangles) {
  const std::string path = folder() + "/" + name + ".stl";
  std::ofstream(path) << stl_text(triangles);
  return path;
}

// A body of revolution along z: a belly between two flat ends, of n sides and as many rings.
std::vector<Corners> spindle(int n_sides, int n_rings) {
  const auto point = [&](int ring, int side) {
    const double z = 14. * ring / n_rings - 7;
    const double radius = 2 + std::pow(std::cos(std::numbers::pi * z / 14), 2);
    const double angle = 2 * std::numbers::pi * (side % n_sides) / n_sides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  std::vector<Corners> triangles;
  for (int side = 0; side < n_sides; ++side) {
    triangles.push_back({Vec3(0, 0, -7), point(0, side + 1), point(0, side)});
    triangles.push_back({Vec3(0, 0, 7), point(n_rings, side), point(n_rings, side + 1)});
    for (int ring = 0; ring < n_rings; ++ring) {
      triangles.push_back({point(ring, side), point(ring, side + 1), point(ring + 1, side + 1)});
      triangles.push_back({point(ring, side), point(ring + 1, side + 1), point(ring + 1, side)});
    }
  }
  return triangles;
}

std::vector<Corners> box(const Vec3& origin = Vec3::Zero(), double side = 2) {
  // faces as seen from outside, by their corners' numbers (x + 2 y + 4 z)
  constexpr std::array<std::array<int, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  const auto corner = [&](int i) -> Vec3 {
    return origin + side * Vec3(i % 2, (i / 2) % 2, i / 4);
  };
  std::vector<Corners> triangles;
  for (const auto& f : faces) {
    triangles.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
    triangles.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
  }
  return triangles;
}

std::string refusal(const std::vector<Corners>& triangles) {
  try {
    require_closed(parse_surface(stl_text(triangles), "t.stl", FlatTriangles::allowed), "t.stl");
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    return failure.what();
  }
  return "";
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

}  // namespace

TEST_CASE("closed surfaces pass, whichever way their normals point, and enclose their volume") {
  for (const int n : {3, 8, 16}) {
    const std::vector<Corners> body = spindle(n, n);
    CHECK(refusal(body) == "");
    std::vector<Corners> inside_out = body;
    for (Corners& corners : inside_out) std::swap(corners[0], corners[1]);
    CHECK(refusal(inside_out) == "");
  }
  // far from the origin, and with triangles two of whose corners are one
  std::vector<Corners> far = box(Vec3(1000, -2000, 500), 3);
  far.push_back({far[0][0], far[0][0], far[0][1]});
  far.push_back({far[3][0], far[3][1], far[3][1]});
  const Triangles surface = parse_surface(stl_text(far), "t.stl", FlatTriangles::allowed);
  CHECK(surface.corners.size() == 12);
  CHECK(refusal(far) == "");
  CHECK(std::abs(enclosed_volume(surface) - 27) < 27e-9);
}

TEST_CASE("an open surface is refused with the number and the places of its open edges") {
  std::vector<Corners> one = box();
  one.erase(one.begin());  // the triangle (0 0 0), (0 2 0), (2 2 0)
  const std::string message = refusal(one);
  CHECK(message.starts_with("t.stl: the surface is open; 3 edges with the middles "));
  for (const char* place : {"(0, 1, 0)", "(1, 2, 0)", "(1, 1, 0)"})
    CHECK(message.find(place) != std::string::npos);
  CHECK(message.find("fill the hole in the program") != std::string::npos);

  std::vector<Corners> face = box();
  face.erase(face.begin(), face.begin() + 2);
  CHECK(refusal(face).starts_with("t.stl: the surface is open; 4 edges with the middles "));
  std::vector<Corners> shared = box();
  shared.erase(shared.begin(), shared.begin() + 4);  // bottom and top
  CHECK(refusal(shared).find("; 8 edges") != std::string::npos);
  CHECK(refusal(shared).find("and others") != std::string::npos);
  // every single triangle of a body
  for (std::size_t t = 0; t < spindle(5, 4).size(); ++t) {
    std::vector<Corners> body = spindle(5, 4);
    body.erase(body.begin() + static_cast<std::ptrdiff_t>(t));
    CHECK(refusal(body).starts_with("t.stl: the surface is open; 3 edges with the middles "));
  }
  // corners that do not meet: a slit
  std::vector<Corners> slit = box();
  slit[0][1] += Vec3(0, 0, 1e-3);
  CHECK(refusal(slit).find("the surface is open") != std::string::npos);
}

TEST_CASE("walls inside and turned triangles are refused by name") {
  std::vector<Corners> wall = box();
  wall.push_back({Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 2)});
  CHECK(refusal(wall).find("t.stl: ") == 0);
  std::vector<Corners> twice = box();
  twice.push_back(twice[4]);
  twice.push_back(twice[4]);
  CHECK(refusal(twice).find("more than two triangles meet at one edge; 3 edges") !=
        std::string::npos);
  for (std::size_t t = 0; t < 12; ++t) {
    std::vector<Corners> turned = box();
    std::swap(turned[t][0], turned[t][1]);
    CHECK(refusal(turned).find("neighbouring triangles have opposite orientations; 3 edges") !=
          std::string::npos);
  }
}

TEST_CASE("an open file is refused before gmsh is asked, and the closed one is meshed") {
  std::vector<std::string> notes;
  std::vector<Corners> open = spindle(8, 8);
  open.pop_back();
  const std::string path = write_stl("open", open);
  CHECK_THROWS_WITH_AS((read_solid(path, {true, 1, CellType::tet15}, notes)),
                       doctest::Contains("the surface is open; 3 edges"), Failure);
  const Mesh mesh =
      read_solid(write_stl("closed", spindle(8, 8)), {true, 1.5, CellType::tet15}, notes);
  CHECK(quality(mesh).least_jacobian > 0);
}

TEST_CASE("small holes are filled, whatever their shape, and the advice of the refusal works") {
  const std::vector<Corners> whole = spindle(16, 20);
  const double enclosed =
      enclosed_volume(parse_surface(stl_text(whole), "t.stl", FlatTriangles::allowed));
  // one triangle; several that meet in a chain; a patch on either side
  const std::vector<std::vector<std::size_t>> holes = {
      {40}, {80, 81, 82, 83}, {30, 31, 200, 201, 202}};
  for (const std::vector<std::size_t>& hole : holes) {
    CAPTURE(hole.size());
    std::vector<Corners> body;
    for (std::size_t t = 0; t < whole.size(); ++t)
      if (std::find(hole.begin(), hole.end(), t) == hole.end()) body.push_back(whole[t]);
    const std::string message = refusal(body);
    const std::size_t at = message.find("seal: ");
    REQUIRE(at != std::string::npos);
    const double width = std::stod(message.substr(at + 6));
    Triangles surface = parse_surface(stl_text(body), "t.stl", FlatTriangles::allowed);
    const std::size_t before = surface.points.size();
    for (const Hole& found : holes_of(surface)) {
      CHECK(found.width <= width);
      CHECK(fill(found, surface));
    }
    require_closed(surface, "t.stl");
    CHECK(surface.points.size() == before);  // no new points
    CHECK(enclosed_volume(surface) == near(enclosed, 0.01));

    std::vector<std::string> notes;
    const std::string path = write_stl("sealed", body);
    const Mesh mesh = read_solid(path, {true, 1.5, CellType::tet15, width}, notes);
    CHECK(quality(mesh).least_jacobian > 0);
    CHECK(says(notes, "filled a hole of "));
    CHECK_THROWS_WITH_AS((read_solid(path, {true, 1.5, CellType::tet15, 1e-3}, notes)),
                         doctest::Contains("the surface is open"), Failure);
  }
}

TEST_CASE("holes that meet in a point are left open, and a flat one is filled flat") {
  std::vector<Corners> face = box();
  face.erase(face.begin(), face.begin() + 2);
  Triangles surface = parse_surface(stl_text(face), "t.stl", FlatTriangles::allowed);
  REQUIRE(holes_of(surface).size() == 1);
  CHECK(fill(holes_of(surface)[0], surface));
  CHECK(std::abs(enclosed_volume(surface) - 8) < 8e-12);
  require_closed(surface, "t.stl");
  // a triangle that is turned is no hole
  std::vector<Corners> turned = box();
  std::swap(turned[4][0], turned[4][1]);
  CHECK(holes_of(parse_surface(stl_text(turned), "t.stl", FlatTriangles::allowed)).empty());
  // two triangles that share one corner only
  const std::vector<Corners> body = spindle(16, 20);
  std::size_t other = 0;
  const auto shared = [&](std::size_t t) {
    int n = 0;
    for (const Vec3& a : body[60])
      for (const Vec3& b : body[t]) n += (a - b).norm() < 1e-9;
    return n;
  };
  while (other < body.size() && shared(other) != 1) ++other;
  REQUIRE(other < body.size());
  std::vector<Corners> touching;
  for (std::size_t t = 0; t < body.size(); ++t)
    if (t != 60 && t != other) touching.push_back(body[t]);
  CHECK(holes_of(parse_surface(stl_text(touching), "t.stl", FlatTriangles::allowed)).empty());
  CHECK(refusal(touching).find("the surface is open") != std::string::npos);
}

TEST_CASE("hexahedra of a smooth surface that gmsh folds are split with straight edges") {
  const std::vector<Corners> body = spindle(16, 20);
  const std::string path = write_stl("spindle", body);
  const double enclosed =
      enclosed_volume(parse_surface(stl_text(body), "t.stl", FlatTriangles::allowed));
  for (const double edge : {1., 1.5}) {
    CAPTURE(edge);
    std::vector<std::string> notes;
    const Mesh mesh = read_solid(path, {true, edge, CellType::hex8}, notes);
    const Quality found = quality(mesh);
    CHECK(found.least_jacobian > 0);
    CHECK(found.volume < enclosed);
    CHECK(found.volume > 0.8 * enclosed);
    CHECK_FALSE(coincident_nodes(mesh, 1e-6));
    CHECK(says(notes, fmt::format("{:.3g} mm^3, the surface encloses {:.3g} mm^3 ({:+.2g} %)",
                                  found.volume, enclosed, 100 * (found.volume / enclosed - 1))));
    // every facet of the surface is in one set of faces
    std::size_t n_in_faces = 0;
    for (const auto& [name, facets] : mesh.facet_sets) n_in_faces += facets.size();
    CHECK(n_in_faces == boundary(mesh).size());
    // the advice of the note: tetrahedra follow the surface better at the same edge
    std::vector<std::string> notes_of_tetrahedra;
    const Quality tetrahedra =
        quality(read_solid(path, {true, edge, CellType::tet15}, notes_of_tetrahedra));
    CHECK(tetrahedra.least_jacobian > 0);
    CHECK(tetrahedra.volume > found.volume);
    CHECK(tetrahedra.volume < enclosed * (1 + 1e-9));
  }
}

TEST_CASE("a mesh that loses a quarter of the volume is refused, and its advice helps") {
  const std::string path = write_stl("coarse", spindle(16, 20));
  std::vector<std::string> notes;
  CHECK_THROWS_WITH_AS((read_solid(path, {true, 3, CellType::hex8}, notes)),
                       doctest::Contains("a smaller edge follows the surface better"), Failure);
  CHECK(quality(read_solid(path, {true, 1, CellType::hex8}, notes)).least_jacobian > 0);
}

TEST_CASE("a coarse mesh of tetrahedra states the volume that it loses, a box loses none") {
  std::vector<std::string> notes;
  read_solid(write_stl("tetrahedra", spindle(16, 20)), {true, 3, CellType::tet15}, notes);
  CHECK(says(notes, "straight edges cut off what is curved"));
  for (const CellType cells : {CellType::hex8, CellType::tet15}) {
    notes.clear();
    CHECK(std::abs(quality(read_solid(write_stl("box", box()), {true, 1, cells}, notes)).volume -
                   8) < 1e-6);
    CHECK_FALSE(says(notes, "volume"));
    CHECK_FALSE(says(notes, "mm^3"));
  }
}

TEST_CASE("a tetrahedron is split into four hexahedra that fill it") {
  MshModel model;
  model.node_tags = {3, 5, 7, 11};
  model.X = {0, 0, 0, 3, 0.2, 0, 0.1, 2, 0, 0.3, 0.4, 4};
  model.cells = {{4, "Tetrahedron 4", {9}, {3, 5, 7, 11}, {}}};
  model.groups = {{2, 1, "base", {{2, "Triangle 3", {1}, {3, 7, 5}, {}}}, {}}};
  const MshModel split = split_into_hexahedra(model);
  CHECK(split.node_tags.size() == 4 + 6 + 4 + 1);
  REQUIRE(split.cells.size() == 1);
  CHECK(split.cells[0].type == 5);
  CHECK(split.cells[0].tags.size() == 4);
  CHECK(split.groups[0].elements[0].tags.size() == 3);
  Mat3 edges;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) edges(i, k) = model.X[3 * (k + 1) + i] - model.X[i];
  Mesh mesh;
  mesh.type = CellType::hex8;
  for (std::size_t n = 0; n < split.node_tags.size(); ++n)
    mesh.X.emplace_back(split.X.data() + 3 * n);
  for (const std::size_t node : split.cells[0].nodes) {
    const auto at = std::find(split.node_tags.begin(), split.node_tags.end(), node);
    mesh.connectivity.push_back(static_cast<int>(at - split.node_tags.begin()));
  }
  mesh.body.assign(4, 0);
  mesh.bodies = {""};
  const Quality found = quality(mesh);
  CHECK(found.least_jacobian > 0);
  CHECK(std::abs(found.volume - edges.determinant() / 6) < 1e-12);
}

}  // namespace solid_tests

// Triangles of STL files.
#include <doctest/doctest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/traps.hpp"
#include "meshing/gmsh/gmsh_session.hpp"
#include "meshing/read_surface.hpp"
#include "support/near.hpp"

using namespace langer;

namespace surface_tests {

namespace {

const std::string tetrahedron =
    "solid t\n"
    "  facet normal 0 0 -1\n    outer loop\n      vertex 0 0 0\n      vertex 0 1 0\n      vertex 1 0 0\n    endloop\n  endfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nVERTEX +1.0e0 0 0\nvertex 0 0 1\nendloop\nendfacet\r\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 1e-10\nendloop\nendfacet\n"  // 1e-10: the same corner
    "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid t\n";

std::string refusal(const std::string& bytes) {
  try {
    parse_surface(bytes, "t.stl");
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    return failure.what();
  }
  return "";
}

std::string binary(const std::vector<std::array<float, 9>>& triangles) {
  std::string bytes(80, ' ');
  bytes.replace(0, 5, "solid");  // some programs write that in binary files too
  const auto put = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  put(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) put(0.f);
    for (float x : t) put(x);
    put(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace

TEST_CASE("a text of triangles is a surface whose triangles share their corners") {
  const Triangles surface = parse_surface(tetrahedron, "t.stl");
  CHECK(surface.points == std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}});
  CHECK(surface.corners ==
        std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}});
}

TEST_CASE("a binary file of triangles is the same surface") {
  const Triangles text = parse_surface(tetrahedron, "t.stl");
  const Triangles surface = parse_surface(binary({{0, 0, 0, 0, 1, 0, 1, 0, 0},
                                                  {0, 0, 0, 1, 0, 0, 0, 0, 1},
                                                  {0, 0, 0, 0, 0, 1, 0, 1, 0},
                                                  {1, 0, 0, 0, 1, 0, 0, 0, 1}}),
                                          "t.stl");
  CHECK(surface.points == text.points);
  CHECK(surface.corners == text.corners);
}

TEST_CASE("what gmsh writes as STL is read as gmsh reads it") {
  const std::string folder = std::string(BINARY_DIR) + "/test_files/surface";
  std::filesystem::create_directories(folder);
  for (const int is_binary : {0, 1}) {
    CAPTURE(is_binary);
    const std::string path = folder + "/ball.stl";
    std::size_t n_triangles = 0, n_points = 0;
    {
      const NoTraps in_gmsh;
      const GmshSession session;
      gmsh::model::occ::addSphere(1, 2, 3, 5);
      gmsh::model::occ::synchronize();
      gmsh::option::setNumber("Mesh.Binary", is_binary);
      gmsh::model::mesh::generate(2);
      gmsh::write(path);
    }
    {
      const NoTraps in_gmsh;
      const GmshSession session;
      gmsh::merge(path);
      std::vector<std::size_t> tags;
      std::vector<double> X, parametric;
      gmsh::model::mesh::getNodes(tags, X, parametric);
      n_points = tags.size();
      std::vector<int> types;
      std::vector<std::vector<std::size_t>> elements, corners;
      gmsh::model::mesh::getElements(types, elements, corners, 2);
      REQUIRE(types == std::vector<int>{2});
      n_triangles = elements[0].size();
    }
    const Triangles surface = read_surface(path);
    CHECK(surface.corners.size() == n_triangles);
    CHECK(surface.points.size() == n_points);
    CHECK(2 * (surface.points.size() - 2) ==
          surface.corners.size());  // closed, like a sphere (Euler)
    for (const Vec3& x : surface.points) CHECK((x - Vec3(1, 2, 3)).norm() == near(5, 1e-6));
  }
}

TEST_CASE("a file that is no surface is refused, a text with its line") {
  CHECK(refusal("nothing") ==
        "t.stl: no triangles; expected an STL file with triangles, normals outwards");
  CHECK(refusal("") == refusal("nothing"));
  CHECK(refusal("outer loop\nvertex 0 0 zero\n")
            .starts_with("t.stl:2:1: found \"zero\" for a coordinate"));
  CHECK(refusal("outer loop\nvertex 0 0\n")
            .starts_with("t.stl:2:1: a corner of fewer than three coordinates"));
  CHECK(refusal("outer loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n")
            .starts_with("t.stl:4:1: a facet that is no triangle"));
  CHECK(refusal("outer loop\nvertex 0 0 0\nvertex 1 0 0\n")
            .starts_with("t.stl:3:1: a facet that is no triangle"));
  CHECK(refusal("vertex 0 0 0\nvertex 1 0 0\nvertex 0 nan 0\n")
            .starts_with("t.stl: a position that is not finite"));
  CHECK(refusal("vertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\n")
            .starts_with("t.stl: triangle 1 has no area"));
  CHECK(refusal("vertex 1 1 1\nvertex 1 1 1\nvertex 1 1 1\n")
            .starts_with("t.stl: triangle 1 has no area"));
  CHECK(refusal(binary({{0, 0, 0, 0, 1, 0, 1, 0, 0}}).substr(0, 120))
            .starts_with("t.stl: no triangles"));
  CHECK_THROWS_AS(read_surface("/nonexistent/t.stl"), Failure);
}

}  // namespace surface_tests

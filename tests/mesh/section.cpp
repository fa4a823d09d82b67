#include "mechanics/mesh/section.hpp"

#include <doctest/doctest.h>

#include <numbers>

#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/raise.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

Mesh section(SectionOf of, double depth, CellType cells) {
  Mesh mesh = raised(test::block({0, 0.5, 2}, {0, 1, 1.5}, {0, 1}), cells);
  mesh.node_sets.clear();
  make_section(mesh, {of, depth});
  return mesh;
}

}  // namespace

TEST_CASE(
    "a layer of cells becomes a section: numbered by layers, as deep as it says, of the volume of the whole body") {
  for (CellType cells : {CellType::hex8, CellType::hex27})
    for (double depth : {1e-4, 0.3}) {
      const Mesh wedge = section(SectionOf::axisymmetric, depth, cells);
      CHECK(section_fault(wedge) == "");
      CHECK(n_front(wedge) == (cells == CellType::hex8 ? 9 : 25));
      const Quality q = quality(wedge);
      CHECK(q.volume == near(std::numbers::pi * 4 * 1.5, 1e-13));
      CHECK(q.least_jacobian ==
            near(0.25 * 0.5 * 0.5, 1e-13));  // a quarter of the smallest cell's area
      CHECK(q.least_scaled_jacobian == near(1, 1e-13));
      CHECK(q.shortest_edge == 0.5);
      CHECK(q.longest_edge == 1.5);
      CHECK(!coincident_nodes(wedge, 1e-9));  // front and back meet on the axis, which is no tear
      CHECK(quality(section(SectionOf::plane_strain, depth, cells)).volume ==
            near(3 * depth, 1e-13));
    }
}

TEST_CASE("nodes behind z = 0 move as those in it") {
  const Mesh mesh = section(SectionOf::axisymmetric, 0.25, CellType::hex27);
  const auto ties = section_ties(mesh);
  const int n = n_front(mesh);
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    CHECK(ties[i].of == i % n);
    const double r = mesh.X[i][0];
    const Vec3 widened =
        ties[i].T * Vec3(0.1 * r, 0.2, 5);  // what would move it along z is forbidden
    CHECK((widened - Vec3(0.1 * r, 0.2, 0.1 * mesh.X[i][2])).norm() < 1e-15);
  }
  const Mesh strip = section(SectionOf::plane_strain, 0.25, CellType::hex8);
  for (const Image& tie : section_ties(strip)) CHECK(tie.T * Vec3(1, 2, 3) == Vec3(1, 2, 0));
}

TEST_CASE("what is no section is told from one") {
  Mesh mesh = section(SectionOf::axisymmetric, 0.25, CellType::hex8);
  mesh.X[17][2] *= 1.001;
  CHECK(section_fault(mesh).find("node 17 is not behind node 8") != std::string::npos);
  mesh = section(SectionOf::axisymmetric, 0.25, CellType::hex8);
  std::swap(mesh.connectivity[0], mesh.connectivity[1]);
  CHECK(section_fault(mesh).find("cell 0") != std::string::npos);
  mesh = section(SectionOf::plane_strain, 0.25, CellType::hex8);
  mesh.node_sets["back"] = {9};
  CHECK(section_fault(mesh).find("\"back\"") != std::string::npos);
  mesh.node_sets.clear(), mesh.section->depth = 0;
  CHECK(section_fault(mesh).find("depth") != std::string::npos);
}

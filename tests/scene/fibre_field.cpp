// Fibre directions from formulas and points, and how far they turn between neighbours.
#include "scene/model/fibre_field.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/hdf5/h5.hpp"
#include "support/block.hpp"
#include "support/near.hpp"

using namespace langer;

namespace fibre_field_tests {

namespace {
constexpr double degree = std::numbers::pi / 180;
Place nowhere(const std::string&) { return {"solve.yaml", 7, 3}; }

Directions laid(const FibreField& field, const Mesh& mesh) {
  std::vector<int> cells;
  for (int e = 0; e < mesh.n_cells(); ++e) cells.push_back(e);
  return make_directions(mesh, {{0}}, {first_family(field, mesh, cells, "fibre_field", nowhere)});
}
}  // namespace

TEST_CASE(
    "a formula gives each cell the angle at its centre, and the jump is its slope times the cell's length") {
  const Mesh mesh = test::block(test::even(0, 8, 4), test::even(0, 1, 1), test::even(0, 3, 3));
  const Directions directions = laid(FormulaField{"30 + 2*x"}, mesh);
  for (int e = 0; e < mesh.n_cells(); ++e) {
    const double alpha = (30 + 2 * cell_centre(mesh, e)[0]) * degree;
    CHECK((directions.of(e)[0] - Vec3(std::cos(alpha), 0, std::sin(alpha))).norm() < 1e-14);
  }
  const FibreJump jump = largest_jump(mesh, directions);
  CHECK(jump.degrees == near(4, 1e-10));  // 2 degrees per mm, 2 mm from centre to centre
  CHECK(std::fmod(jump.place[0], 2) == near(0));
}

TEST_CASE(
    "a formula that cannot be read is refused with the place of its key and the position in the text") {
  const Mesh mesh = test::block(test::even(0, 1, 1), test::even(0, 1, 1), test::even(0, 1, 1));
  for (const auto& [formula, part] : {std::pair{"30 + 2*q", "character 8"},
                                      {"1/(x - 0.5)", "inf"},
                                      {"1, 2", "2 values"},
                                      {"", ""}}) {
    const auto text = std::string(formula);
    CAPTURE(text);
    std::string said;
    try {
      laid(FormulaField{formula}, mesh);
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::config);
      said = failure.what();
    }
    CHECK(said.find("solve.yaml:7:3: fibre_field.formula.alpha") != std::string::npos);
    CHECK(said.find(part) != std::string::npos);
  }
}

TEST_CASE(
    "directions between points do not depend on the points' signs, and opposite answers are said to be none") {
  MeasuredDirections points{{{0, 0, 0}, {2, 0, 0}}, {{1, 0, 0}, Vec3(1, 0, 1).normalized()}};
  const Vec3 middle(1, 0, 0), a = direction_at(points, middle, Between::inverse_distance, 2);
  CHECK(std::abs(a.dot(Vec3(std::cos(22.5 * degree), 0, std::sin(22.5 * degree)))) == near(1));
  points.a[1] = -points.a[1];
  CHECK(a.cross(direction_at(points, middle, Between::inverse_distance, 2)).norm() < 1e-14);
  CHECK(direction_at(points, {0.9, 0, 0}, Between::nearest, 2) == Vec3(1, 0, 0));
  points.a[1] = Vec3(0, 0, 1);
  CHECK(direction_at(points, middle, Between::inverse_distance, 2) == Vec3::Zero());
}

TEST_CASE(
    "the same points from a CSV file and from an HDF5 file, datasets of unequal length are refused by name") {
  const auto folder = std::filesystem::temp_directory_path() / "langer_fibre_points";
  std::filesystem::create_directories(folder);
  const std::string csv = (folder / "points.csv").string(),
                    h5_file = (folder / "points.h5").string();
  std::ofstream(csv) << "x,y,z,a_x,a_y,a_z\n0,0,0,1,0,0\n2,0,0,3,0,4\n";
  const auto write = [&](std::size_t n_last) {
    h5::File file = h5::File::create(h5_file);
    const std::vector<std::vector<double>> columns{{0, 2}, {0, 0}, {0, 0}, {1, 3}, {0, 0}, {0, 4}};
    const char* const names[] = {"x", "y", "z", "a_x", "a_y", "a_z"};
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t n = i == 5 ? n_last : 2;
      file.root().write<double>(names[i], {n}, std::span<const double>(columns[i]).first(n));
    }
    file.commit();
  };
  write(2);
  PointField field;
  field.file.path = csv;
  const MeasuredDirections a = read_directions(field);
  field.file.path = h5_file;
  const MeasuredDirections b = read_directions(field);
  CHECK(a.x == b.x);
  CHECK(a.a == b.a);
  CHECK((b.a[1] - Vec3(0.6, 0, 0.8)).norm() < 1e-15);
  write(1);
  try {
    read_directions(field);
    FAIL("accepted");
  } catch (const Failure& e) {
    CHECK(std::string(e.what()).find("a_z") != std::string::npos);
  }
  std::ofstream(csv) << "x,y,z,a_x,a_y,a_z\n0,0,0,1,0,0\n2,0,0,0,0,0\n";
  field.file.path = csv;
  CHECK_THROWS_WITH_AS(read_directions(field), doctest::Contains("a direction of no length"),
                       Failure);
  std::filesystem::remove_all(folder);
}

}  // namespace fibre_field_tests

#include "results/store/snapshot.hpp"

#include <doctest/doctest.h>

#include <numeric>

#include "core/hdf5/h5.hpp"
#include "example.hpp"
#include "results/store/provenance.hpp"

using namespace langer;

namespace {
std::vector<double> ramp(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 0.5);
  return values;
}
}  // namespace

TEST_CASE(
    "a snapshot has the arrays of static VTKHDF: geometry, point and cell fields of 1, 3, 6 and 9 components") {
  const std::string path = example::folder("snapshot") + "/snapshot.h5";
  const Mesh mesh = example::bar();
  write_snapshot(
      path, mesh,
      {{"u", "mm", 3, ramp(36)}, {"sigma", "MPa", 6, ramp(72)}, {"von_mises", "MPa", 1, ramp(12)}},
      {{"pressure", "MPa", 1, ramp(2)}, {"F_mean", "-", 9, ramp(18)}}, example::identity());
  CHECK(read_origin(path).schema == "snapshot");
  const h5::Group grid = h5::File::open(path).root().group("VTKHDF");
  CHECK(grid.text_attribute("Type") == "UnstructuredGrid");
  CHECK_FALSE(grid.has("Steps"));
  CHECK(grid.read<std::int64_t>("NumberOfPoints", {1}).values[0] == 12);
  CHECK(grid.read<std::int64_t>("NumberOfCells", {1}).values[0] == 2);
  CHECK(grid.read<std::int64_t>("NumberOfConnectivityIds", {1}).values[0] == 16);
  CHECK(grid.read<std::int64_t>("Offsets", {3}).values == std::vector<std::int64_t>{0, 8, 16});
  CHECK(grid.read<std::uint8_t>("Types", {2}).values == std::vector<std::uint8_t>{12, 12});
  const auto connectivity = grid.read<std::int64_t>("Connectivity", {16}).values;
  CHECK(std::vector<int>(connectivity.begin(), connectivity.end()) == mesh.connectivity);
  const h5::Group points = grid.group("PointData"), cells = grid.group("CellData");
  CHECK(points.read<double>("u", {12, 3}).values == ramp(36));
  CHECK(points.read<double>("sigma", {12, 6}).values == ramp(72));
  CHECK(points.read<double>("von_mises", {12}).values == ramp(12));
  CHECK(points.unit("sigma") == "MPa");
  CHECK(cells.read<double>("pressure", {2}).values == ramp(2));
  CHECK(cells.read<double>("F_mean", {2, 9}).values == ramp(18));
}

TEST_CASE("a field of the wrong length is a bug, and no file is left") {
  const std::string path = example::folder("short_field") + "/snapshot.h5";
  try {
    write_snapshot(path, example::bar(), {{"u", "mm", 3, ramp(35)}}, {}, example::identity());
    FAIL("accepted");
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::bug);
  }
  CHECK_FALSE(std::filesystem::exists(path));
  CHECK_FALSE(std::filesystem::exists(path + ".part"));
}

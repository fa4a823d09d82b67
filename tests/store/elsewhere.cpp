// Values that stand in another file, or in other units than ours, are refused by name.
#include <doctest/doctest.h>
#include <hdf5.h>

#include <cstring>

#include "core/hdf5/h5.hpp"
#include "core/hdf5/unit_attribute.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"
#include "results/store/mesh_file.hpp"
#include "solution_example.hpp"
#include "support/refusal.hpp"

using namespace langer;

namespace elsewhere_tests {

using example::holds;
using example::refusal;

namespace {

std::string solution(const std::string& folder) {
  const std::string path = folder + "/solution.h5";
  SolutionWriter writer(path, example::header(true));
  for (int i = 0; i < 2; ++i) writer.append(example::step(i, true));
  writer.finish();
  return path;
}

// changes the file behind langer's back, as another program would: without its seal
void edited(const std::string& path, const std::function<void(hid_t)>& edit) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(file >= 0);
  edit(file);
  H5Fclose(file);
}

void set_unit(hid_t file, const char* dataset, const char* attribute, const char* unit) {
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, std::strlen(unit));
  if (H5Aexists_by_name(file, dataset, attribute, H5P_DEFAULT) > 0)
    H5Adelete_by_name(file, dataset, attribute, H5P_DEFAULT);
  const hid_t made = H5Acreate_by_name(file, dataset, attribute, type, space, H5P_DEFAULT,
                                       H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE(made >= 0);
  H5Awrite(made, type, unit);
  H5Aclose(made), H5Sclose(space), H5Tclose(type);
}

void read_all(const std::string& path) {
  const SolutionReader reader(path);
  for (int i = 0; i < reader.n_steps(); ++i) reader.step(i);
}

}  // namespace

TEST_CASE(
    "links into another file are refused, direct or through a soft link, of datasets and groups") {
  for (const char* what :
       {"/VTKHDF/PointData/u", "/history/t", "/contact", "/material", "/VTKHDF/Points"})
    for (const bool soft : {false, true}) {
      CAPTURE(what);
      CAPTURE(soft);
      const std::string folder = example::folder("links"), path = solution(folder);
      std::filesystem::copy_file(path, folder + "/other.h5");
      edited(path, [&](hid_t file) {
        REQUIRE(H5Ldelete(file, what, H5P_DEFAULT) >= 0);
        const char* name = soft ? "/away" : what;
        REQUIRE(H5Lcreate_external((folder + "/other.h5").c_str(), what, file, name, H5P_DEFAULT,
                                   H5P_DEFAULT) >= 0);
        if (soft) REQUIRE(H5Lcreate_soft("/away", file, what, H5P_DEFAULT, H5P_DEFAULT) >= 0);
      });
      const std::string said = refusal([&] { read_all(path); });
      CHECK(holds(said, "is a link into another file"));
    }
}

TEST_CASE("arrays whose values are stored in another file are refused") {
  const std::string folder = example::folder("stored");
  example::write_bytes(folder + "/raw", std::string(36 * 8, 'x'));
  for (const bool virtually : {false, true}) {
    const std::string path = solution(folder);
    edited(path, [&](hid_t file) {
      REQUIRE(H5Ldelete(file, "/VTKHDF/Points", H5P_DEFAULT) >= 0);
      const hsize_t extent[] = {12, 3};
      const hid_t space = H5Screate_simple(2, extent, nullptr),
                  list = H5Pcreate(H5P_DATASET_CREATE);
      if (virtually)
        H5Pset_virtual(list, space, (folder + "/other.h5").c_str(), "/VTKHDF/Points", space);
      else
        H5Pset_external(list, (folder + "/raw").c_str(), 0, 36 * 8);
      const hid_t made =
          H5Dcreate2(file, "/VTKHDF/Points", H5T_IEEE_F64LE, space, H5P_DEFAULT, list, H5P_DEFAULT);
      REQUIRE(made >= 0);
      H5Dclose(made), H5Pclose(list), H5Sclose(space);
    });
    CHECK(holds(refusal([&] { read_all(path); }),
                "/VTKHDF/Points: keeps its values in another file"));
  }
}

TEST_CASE("values in other units are refused, with the unit found and the one expected") {
  const std::string folder = example::folder("units");
  struct Case {
    const char *dataset, *attribute, *unit, *said;
  };
  for (const Case& c :
       {Case{"/VTKHDF/Points", "unit", "m", "/VTKHDF/Points: values in m; expected values in mm"},
        Case{"/VTKHDF/PointData/u", "unit", "um", "values in um; expected values in mm"},
        Case{"/VTKHDF/PointData/reaction", "units", "mN", "values in mN; expected values in N"},
        Case{"/VTKHDF/CellData/von_mises", "unit", "kPa", "values in kPa; expected values in MPa"},
        Case{"/history/penetration", "unit", "m", "values in m; expected values in mm"},
        Case{"/contact/indenter/r", "unit", "kN", "values in kN; expected values in N"},
        Case{"/material/matrix/0/yeoh/a1", "unit", "kPa", "values in kPa; expected values in MPa"},
        Case{"/history/t", "unit", "s", "values in s; expected a pure number"}}) {
    CAPTURE(c.dataset);
    const std::string path = solution(folder);
    CHECK(refusal([&] { read_all(path); }) == "");
    edited(path, [&](hid_t file) { set_unit(file, c.dataset, c.attribute, c.unit); });
    CHECK(holds(refusal([&] { read_all(path); }), c.said));
  }
  const std::string path = solution(folder);
  edited(path, [&](hid_t file) { set_unit(file, "/", "units", "m N Pa s rad"); });
  CHECK(holds(refusal([&] { read_all(path); }), "units m N Pa s rad; expected mm N MPa s deg"));
}

TEST_CASE("fits and curves in other units are refused too") {
  const std::string folder = example::folder("fit_units");
  FitRecord fit;
  fit.parameters = {{"a1", "MPa", 0.269, 0, 10, 0.01}};
  fit.covariance = MatX::Identity(1, 1), fit.starts = MatX::Ones(2, 1);
  fit.strain = {0, 0.3}, fit.stress = {0, 0.07}, fit.model = {0, 0.07}, fit.strain_max = 0.3;
  fit.tests = {{"t",
                "equibiaxial",
                "nominal",
                30,
                1,
                {1, 1.3},
                {},
                {0, 0.07},
                {0, 0.06},
                {0, 0.07},
                {0, 0.06},
                1,
                0,
                0}};
  Curves curves;
  curves.columns = {{"force", "N", {0, 1}}};
  curves.curves = {{"force", "u_ind", "mm", "force", "N", {0, 1}, {0, 1}}};
  curves.summary = {{"force", 1, "N"}};
  struct Case {
    const char *dataset, *unit, *said;
  };
  const auto each = [&](const std::string& path, const auto& write, const auto& read,
                        std::initializer_list<Case> cases) {
    for (const Case& c : cases) {
      CAPTURE(c.dataset);
      write(path);
      CHECK(refusal([&] { read(path); }) == "");
      edited(path, [&](hid_t file) { set_unit(file, c.dataset, "unit", c.unit); });
      CHECK(holds(refusal([&] { read(path); }), c.said));
    }
  };
  Material law;
  law.matrix = {NeoHooke{0.1}};
  law.volume = QuadraticVolume{1e-3};
  each(folder + "/material.h5",
       [&](const std::string& path) { write_material(path, law, fit, example::identity()); },
       read_material,
       {{"/tests/t/stress_z", "kPa", "values in kPa; expected values in MPa"},
        {"/tests/t/first", "percent", "values in percent; expected a pure number"},
        {"/tests/t/fibre_angle", "rad", "values in rad; expected values in deg"},
        {"/curve/stress", "Pa", "values in Pa; expected values in MPa"},
        {"/fit/parameters/a1/value", "kPa", "values in kPa"},
        {"/fit/parameters/a1/standard_error", "percent",
         "values in percent; expected values in MPa"},
        {"/fit/strain_range", "percent", "values in percent"}});
  each(folder + "/curves.h5",
       [&](const std::string& path) { write_curves(path, curves, example::identity()); },
       read_curves,
       {{"/columns/force", "kN", "/columns/force: values in kN"},
        {"/curves/force/x", "um", "/curves/force/x: values in um"},
        {"/summary/force", "mN", "/summary/force: values in mN"}});
}

}  // namespace elsewhere_tests

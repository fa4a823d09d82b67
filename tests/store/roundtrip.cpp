#include <doctest/doctest.h>

#include <cmath>
#include <thread>

#include "core/hdf5/h5.hpp"
#include "mechanics/mesh/raise.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"
#include "results/store/mesh_file.hpp"
#include "results/store/provenance.hpp"
#include "solution_example.hpp"
#include "support/near.hpp"

using namespace langer;
using example::bytes;

TEST_CASE("arrays of every type and rank come back as written") {
  const std::string path = example::folder("arrays") + "/a.h5";
  h5::File file = h5::File::create(path);
  const h5::Group g = file.root().make_group("deep").make_group("er");
  const std::vector<double> reals{1, -2.5, 1e-300, 0.1, 3, 4};
  const std::vector<std::int64_t> integers{-1, std::int64_t{1} << 60};
  g.write<double>("reals", {2, 3}, reals, "mm");
  g.write<std::int64_t>("integers", {2}, integers);
  g.write<std::uint8_t>("bytes", {1, 1, 2}, std::vector<std::uint8_t>{0, 255});
  g.write<double>("none", {0, 3}, {});
  g.write_text("word", "");
  g.write_text("greek", "σ = 1 MPa");
  g.make_extendible<double>("rows", {2}, 3, "N");
  for (int i = 0; i < 5; ++i) g.append<double>("rows", std::vector<double>{1.0 * i, 2.0 * i});
  g.write_scalar("x", 1);
  g.write_scalar("x", 2, "deg");
  CHECK_FALSE(std::filesystem::exists(path));
  file.commit();
  CHECK_FALSE(std::filesystem::exists(path + ".part"));

  const h5::Group r = h5::File::open(path).root().group("deep").group("er");
  CHECK(r.read<double>("reals", {2, 3}).values == reals);
  CHECK(r.unit("reals") == "mm");
  CHECK(r.read<std::int64_t>("integers", {h5::any}).values == integers);
  CHECK(r.read<std::uint8_t>("bytes", {1, 1, 2}).values == std::vector<std::uint8_t>{0, 255});
  CHECK(r.read<double>("none", {h5::any, 3}).values.empty());
  CHECK(r.read_text("word") == "");
  CHECK(r.read_text("greek") == "σ = 1 MPa");
  CHECK(r.shape("rows") == h5::Shape{5, 2});
  CHECK(r.read_rows<double>("rows", 3, 2, {2}).values == std::vector<double>{3, 6, 4, 8});
  CHECK(r.read_scalar("x") == 2);
  CHECK(r.unit("x") == "deg");
  CHECK(r.datasets() == std::vector<std::string>{"bytes", "greek", "integers", "none", "reals",
                                                 "rows", "word", "x"});
  CHECK_THROWS_AS(r.read<double>("reals", {3, 2}), Failure);
  CHECK_THROWS_AS(r.read<double>("integers", {2}), Failure);
  CHECK_THROWS_AS(r.read<double>("nothing", {}), Failure);
  CHECK_THROWS_AS(r.read_rows<double>("rows", 4, 2, {2}), Failure);
  CHECK_THROWS_AS(r.group("nothing"), Failure);
}

TEST_CASE("a dataset grows by few values and by many, before and after a flush") {
  const std::string path = example::folder("grows") + "/a.h5";
  h5::File file = h5::File::create(path);
  const h5::Group g = file.root().make_group("history");
  g.make_extendible<double>("x", {}, 16);
  std::vector<double> expected;
  for (std::size_t count : {1, 300, 2, 1, 65, 64}) {
    const std::vector<double> rows(count, 0.5 * static_cast<double>(expected.size()));
    g.append<double>("x", rows);
    expected.insert(expected.end(), rows.begin(), rows.end());
    file.flush();
    CHECK(g.has("x"));
    CHECK(g.read<double>("x", {h5::any}).values == expected);
  }
  file.commit();
  CHECK(h5::File::open(path).root().group("history").read<double>("x", {h5::any}).values ==
        expected);
}

TEST_CASE("a file given up leaves nothing behind and the old one whole") {
  const std::string path = example::folder("given_up") + "/a.h5";
  write_mesh(path, example::bar(), example::identity());
  const std::string old = bytes(path);
  { h5::File::create(path).root().write_scalar("x", 1); }
  CHECK(bytes(path) == old);
  CHECK_FALSE(std::filesystem::exists(path + ".part"));
}

TEST_CASE("a mesh comes back as written, with its content id") {
  const std::string path = example::folder("mesh") + "/mesh.h5";
  write_mesh(path, example::bar(), example::identity());
  const MeshFile file = read_mesh(path);
  CHECK(example::same(file.mesh, example::bar()));
  CHECK(file.content_id == content_id(example::identity(), 1));
  const Origin origin = read_origin(path);
  CHECK(origin.schema == "mesh");
  CHECK(origin.identity.config == example::identity().config);
  CHECK(origin.identity.inputs == example::identity().inputs);
  CHECK(origin.identity.command == example::identity().command);
}

TEST_CASE("a mesh of hex27 comes back as written, with VTK's cell type 29") {
  const std::string path = example::folder("mesh_hex27") + "/mesh.h5";
  Mesh mesh = raised(example::bar(), CellType::hex27);
  mesh.body = {0, 1}, mesh.bodies = example::bar().bodies, mesh.frames = example::bar().frames;
  mesh.facet_sets = example::bar().facet_sets, mesh.node_sets = {{"M", {4}}};
  write_mesh(path, mesh, example::identity());
  const Mesh back = read_mesh(path).mesh;
  CHECK(back.type == CellType::hex27);
  CHECK(back.n_cells() == 2);
  CHECK(example::same(back, mesh));
  const h5::Group grid = h5::File::open(path).root().group("VTKHDF");
  CHECK(grid.read<std::uint8_t>("Types", {2}).values == std::vector<std::uint8_t>{29, 29});
  CHECK(grid.read<std::int64_t>("Offsets", {3}).values == std::vector<std::int64_t>{0, 27, 54});
}

TEST_CASE("content ids know the stage, the config, the schema version and every input") {
  const Identity id = example::identity();
  Identity other = id;
  other.inputs["mesh"] = "fedcba9876543211";
  CHECK(content_id(id, 1) != content_id(other, 1));
  CHECK(content_id(id, 1) != content_id(id, 2));
  other = id, other.command = "elsewhere";
  CHECK(content_id(id, 1) == content_id(other, 1));
  CHECK(fnv1a("") == "cbf29ce484222325");  // the offset basis, and the published value for "a"
  CHECK(fnv1a("a") == "af63dc4c8601ec8c");
}

TEST_CASE("equal content gives equal bytes, whenever it is written") {
  const std::string folder = example::folder("bytes");
  setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  write_mesh(folder + "/a.h5", example::bar(), example::identity());
  std::this_thread::sleep_for(
      std::chrono::milliseconds(1100));  // object times, if they were on, count seconds
  write_mesh(folder + "/b.h5", example::bar(), example::identity());
  unsetenv("SOURCE_DATE_EPOCH");
  CHECK(bytes(folder + "/a.h5").size() > 2000);
  CHECK(bytes(folder + "/a.h5") == bytes(folder + "/b.h5"));
}

namespace {
Material two_families() {
  Material m;
  m.matrix = {Yeoh{0.269, 0.376, 0.415}, NeoHooke{0.1}, YeohI2{0.01, 0.02, 0.03}};
  m.fibres = {{HgoFibre{-0.317, 0.319}, 30, FibreSwitch::I4},
              {HgoFibre{0.1, 0}, -30, FibreSwitch::off}};
  m.volume = QuadraticVolume{1e-6};
  return m;
}
FitRecord fit() {
  FitRecord f;
  f.parameters = {{"a1", "MPa", 0.269, -INFINITY, INFINITY, 0.01}, {"c2", "-", 0.319, 0, 10, 0.1}};
  f.covariance = MatX::Identity(2, 2) * 1e-4;
  f.covariance(0, 1) = f.covariance(1, 0) = 5e-5;
  f.starts = VecX::LinSpaced(3, 1, 2) * VecX::LinSpaced(3, 3, 7).transpose();
  f.cost = 1e-5, f.kkt_residual = 1e-12, f.mean_error_percent = 0.4, f.max_error_percent = 2.1;
  f.strain_min = 0, f.strain_max = 0.6;
  f.strain = {0, 0.3, 0.6}, f.stress = {0, 0.0709, 1.0564}, f.model = {0, 0.07, 1.06};
  f.r2 = 0.99, f.aicc = -100, f.bic = -90;
  FittedTest biaxial{"offx", "biaxial", "nominal", 30,       2,    {1, 1.1}, {1, 1.2},
                     {0, 1}, {0, 2},    {0, 1.1},  {0, 2.1}, 0.97, 1,        3};
  FittedTest shear{"s",      "simple_shear",
                   "cauchy", 0,
                   1,        {0, 0.5, 1},
                   {},       {0, 1, 2},
                   {},       {0, 1.1, 2.1},
                   {},       0.9,
                   1,        3};
  f.tests = {biaxial, shear};
  f.noise.model = "both";
  f.noise.correlation = 0.9;
  f.noise.share = 0.5;
  f.noise.limit = 0.95;
  f.noise.minus_two_log_likelihood = -120;
  f.noise.aicc = {{"white", -50}, {"both", -100}};
  f.left_out_error_percent = 3.5;
  return f;
}
}  // namespace

TEST_CASE("a material comes back as written: terms, families, switches") {
  const std::string path = example::folder("material") + "/material.h5";
  const Material m = two_families();
  write_material(path, m, {}, example::identity());
  const MaterialFile file = read_material(path);
  CHECK_FALSE(file.fit);
  REQUIRE(file.material.matrix.size() == 3);
  CHECK(std::get<Yeoh>(file.material.matrix[0]).a3 == 0.415);
  CHECK(std::get<NeoHooke>(file.material.matrix[1]).a1 == 0.1);
  CHECK(std::get<YeohI2>(file.material.matrix[2]).b2 == 0.02);
  REQUIRE(file.material.fibres.size() == 2);
  CHECK(std::get<HgoFibre>(file.material.fibres[0].law).c1 == -0.317);
  CHECK(file.material.fibres[0].tension_switch == FibreSwitch::I4);
  CHECK(file.material.fibres[1].alpha_deg == -30);
  CHECK(file.material.fibres[1].tension_switch == FibreSwitch::off);
  CHECK(std::get<QuadraticVolume>(file.material.volume).d == 1e-6);
  CHECK(h5::File::open(path).root().group("material/volume/quadratic").unit("d") == "1/MPa");
}

TEST_CASE("every law of fibres and of volume change stands in a group of its key, and comes back") {
  const std::string path = example::folder("laws") + "/material.h5";
  Material m = two_families();
  m.fibres = {{ExpPowFibre{0.3, 0.8, 2.5}, 30},
              {PowLinearFibre{12, 1.06, 3}, -30, FibreSwitch::I4_bar, 0.1}};
  for (const Volume& volume : {Volume(LogarithmicVolume{1e3}), Volume(SimoTaylorVolume{2e3})}) {
    m.volume = volume;
    write_material(path, m, {}, example::identity());
    const Material back = read_material(path).material;
    CHECK(back.volume.index() == volume.index());
    CHECK(bulk_modulus(back) == bulk_modulus(m));
    CHECK(std::get<ExpPowFibre>(back.fibres[0].law).beta == 2.5);
    CHECK(back.fibres[0].alpha_deg == 30);
    CHECK(std::get<PowLinearFibre>(back.fibres[1].law).lam0 == 1.06);
    CHECK(back.fibres[1].kappa == 0.1);
    CHECK(h5::File::open(path).root().group("material/fibres/0/exp_pow").unit("ksi") == "MPa");
  }
}

TEST_CASE("the record of a fit comes back, and its parameters stand in the summary") {
  const std::string path = example::folder("fit") + "/material.h5";
  write_material(path, two_families(), fit(), example::identity());
  const FitRecord f = *read_material(path).fit;
  REQUIRE(f.parameters.size() == 2);
  CHECK(f.parameters[1].name == "c2");
  CHECK(f.parameters[0].lower == -INFINITY);
  CHECK(f.parameters[1].standard_error == 0.1);
  CHECK(f.covariance == fit().covariance);
  CHECK(f.starts == fit().starts);
  CHECK(f.model == fit().model);
  CHECK(f.strain_max == 0.6);
  CHECK(f.r2 == 0.99);
  CHECK(f.bic == -90);
  CHECK(f.noise.model == "both");
  CHECK(f.noise.correlation == 0.9);
  CHECK(f.noise.share == 0.5);
  CHECK(f.noise.limit == 0.95);
  CHECK(f.noise.minus_two_log_likelihood == -120);
  CHECK(f.noise.aicc == fit().noise.aicc);
  CHECK(f.left_out_error_percent == 3.5);
  REQUIRE(f.tests.size() == 2);
  CHECK(f.tests[0].name == "offx");
  CHECK(f.tests[0].fibre_angle_deg == 30);
  CHECK(f.tests[0].second == std::vector{1., 1.2});
  CHECK(f.tests[0].model_z == std::vector{0., 2.1});
  CHECK(f.tests[1].kind == "simple_shear");
  CHECK(f.tests[1].stress_z.empty());
  CHECK(f.tests[1].model_x == std::vector{0., 1.1, 2.1});
  const auto correlation =
      h5::File::open(path).root().group("fit").read<double>("correlation", {2, 2}).values;
  CHECK(correlation[1] == near(0.5, 1e-14));
  bool found = false;
  for (const Summary& s : read_summary(path))
    if (s.name == "a1") found = s.value == 0.269 && s.unit == "MPa";
  CHECK(found);
}

TEST_CASE(
    "correlations do not depend on units, and are not numbers where nothing is determined or nothing varies") {
  MatX covariance(2, 2);
  covariance << 4, -3, -3, 9;
  for (double scale :
       {1., 1e-200, 1e-300, 1e200}) {  // the product of two variances leaves the range of doubles
    const MatX r = correlation(scale * covariance);
    CHECK(r(0, 1) == near(-0.5, 1e-14));
    CHECK(r(1, 1) == near(1, 1e-14));
  }
  covariance << std::nan(""), std::nan(""), std::nan(""), 9;
  CHECK(std::isnan(correlation(covariance)(0, 1)));
  CHECK(correlation(covariance)(1, 1) == 1);
  CHECK(correlation(MatX::Zero(2, 2)).array().isNaN().all());
}

TEST_CASE("curves, columns and summary come back, the CSV names carry units") {
  const std::string folder = example::folder("curves");
  Curves c;
  c.curves = {{"force", "U_ind", "mm", "force", "N", {0, 0.5, 1}, {0, 0.1, 9.3}}};
  c.columns = {
      {"u_ind", "mm", {0, 0.1}}, {"force", "N", {0, 1.0 / 3}}, {"contact_nodes", "-", {0, 12}}};
  c.summary = {{"force", 9.3, "N"}, {"stretch", 1.1, "-"}};
  write_curves(folder + "/curves.h5", c, example::identity());
  const CurvesFile file = read_curves(folder + "/curves.h5");
  REQUIRE(file.curves.curves.size() == 1);
  CHECK(file.curves.curves[0].y == c.curves[0].y);
  CHECK(file.curves.curves[0].x_unit == "mm");
  CHECK(file.curves.curves[0].y_label == "force");
  REQUIRE(file.curves.columns.size() == 3);
  CHECK(file.curves.columns[0].name == "u_ind");
  CHECK(file.curves.columns[1].values == c.columns[1].values);
  CHECK(read_summary(folder + "/curves.h5").size() == 2);
  CHECK(bytes(folder + "/curves.csv") ==
        "u_ind_mm,force_N,contact_nodes\n0,0,0\n0.1,0.3333333333333333,12\n");
  CHECK(csv_name("d", "1/MPa") == "d_per_MPa");
}

TEST_CASE("what a solution took comes back where it took one run, and its curves pass it on") {
  const std::string folder = example::folder("cost");
  const auto solution = [&](const std::optional<Cost>& cost) {
    const std::string path = folder + "/solution.h5";
    SolutionWriter file(path, example::header(false));
    file.append(example::step(0, false));
    file.finish(cost);
    return path;
  };
  const Origin whole = read_origin(solution(Cost{1.5, 2.5, 64}));
  REQUIRE((whole.cost && whole.identity.solution_cost));
  CHECK(whole.cost->cpu == 1.5);
  CHECK(whole.identity.solution_cost->memory == 64);
  Identity identity = example::identity();
  identity.solution_cost = whole.identity.solution_cost;
  write_curves(folder + "/curves.h5", {}, identity);
  const Origin curves = read_origin(folder + "/curves.h5");
  REQUIRE((curves.cost && curves.identity.solution_cost));
  CHECK(curves.identity.solution_cost->wall == 2.5);
  const Origin continued = read_origin(solution({}));
  CHECK(continued.cost);
  CHECK_FALSE(continued.identity.solution_cost);
}

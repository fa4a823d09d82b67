// What columns are called, what they hold, and what is said of names that do not exist.
#include "results/post/curves.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "core/tensor/stress.hpp"
#include "mechanics/mesh/select.hpp"
#include "results/post/describe_columns.hpp"
#include "results/post/steps.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/solution_layout.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/post_config.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"
#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

std::vector<ColumnChoice> choices(const std::string& list) {
  return read_config<PostConfig>(parse_yaml("columns: [" + list + "]", "post.yaml")).config.columns;
}

struct Sample {
  Mesh mesh = [] {
    Mesh m = test::block({0, 1, 2, 3}, {0, 1, 2}, {0, 2});
    name_sides(m);
    m.node_sets["A"] = {5};
    m.node_sets["B"] = {m.n_nodes() - 1};
    return m;
  }();
  Body body = test::body(mesh, {test::table1(30, 1e-2)}, Formulation::mean_dilatation);
  StepState state = [this] {
    StepState s = unloaded(mesh);
    // bending, so that every point differs
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      const Vec3& X = mesh.X[i];
      s.u[i] = Vec3(0.02 * X[0] * X[1], -0.01 * X[0] * X[0], 0.005 * X[2] * X[1]);
      s.reaction[i] = Vec3(i, -2 * i, 0.5);
    }
    s.t = 0.25, s.increment = 0.05, s.iterations = 4, s.residual = 1e-10;
    s.stick = 3, s.slip = 2;
    s.histories = {{"penetration", 1e-11},       {"cone", 2e-9},
                   {"complementarity", 3e-9},    {"energy", 0.5},
                   {"negative_eigenvalues", 1},  {"shear_stiffness_min", -0.2},
                   {"unstable_volume", 0.1},     {"outside_fit", 0.3},
                   {"driving_force", 7},         {"time", 12},
                   {"viscous_work", 0.3},        {"adhesion_stored", 0.2},
                   {"adhesion_dissipated", 0.1}, {"energy_released", 0.05},
                   {"bonded_area", 1.5},         {"contact_area", 2.5},
                   {"contact_radius", 0.9},      {"contact_pressure_max", 0.04},
                   {"load_factor", 0.7},         {"load_pressure", 0.02},
                   {"pumped_volume", 4},         {"kinetic_energy", 0.6},
                   {"energy_balance", -0.01},    {"applied_pressure", 0.03}};
    for (int i = 0; i < mesh.n_nodes(); ++i) {
      s.velocity.push_back(Vec3(1 + i, -2, 0.5 * i));
      s.acceleration.push_back(Vec3(30, 20 + i, -10));
    }
    return s;
  }();
  Available available{true,
                      true,
                      {"adhesion_dissipated",
                       "adhesion_stored",
                       "bonded_area",
                       "complementarity",
                       "cone",
                       "driving_force",
                       "energy",
                       "energy_balance",
                       "energy_released",
                       "kinetic_energy",
                       "load_factor",
                       "load_pressure",
                       "negative_eigenvalues",
                       "outside_fit",
                       "penetration",
                       "pumped_volume",
                       "shear_stiffness_min",
                       "time",
                       "unstable_volume",
                       "viscous_work"}};

  Measures look(const std::string& list) const {
    return look_up(choices(list), "columns", body, available);
  }
  std::vector<double> values(const std::string& list, StressAt at = StressAt::nodal_average) const {
    const Measures measures = look(list);
    REQUIRE(measures.complaints.empty());
    GaussValues gauss;
    return measured(body, measures.measures, at, state, gauss);
  }
  double value(const std::string& choice) const { return values(choice)[0]; }
};

}  // namespace

TEST_CASE(
    "a column is called after its quantity, its place and its fibre family, name: replaces that") {
  const auto name = [](const std::string& choice) {
    return column_name(choices(choice)[0]);
  };
  CHECK(name("{quantity: u_ind}") == "u_ind");
  CHECK(name("{quantity: u_y, at: A}") == "u_y_A");
  CHECK(name("{quantity: von_mises, at: M}") == "von_mises_M");
  CHECK(name("{quantity: fibre_stretch, at: M, family: 2}") == "fibre_stretch_M_2");
  CHECK(name("{quantity: u_y, at: B, name: u_y}") == "u_y");
  CHECK(name("{history: energy}") == "energy");
}

TEST_CASE("a force has the column of its error beside it where the solver estimated one") {
  const auto named = [](const std::string& list, const std::vector<std::string>& histories) {
    std::vector<std::string> names;
    for (const ColumnChoice& c : with_errors(choices(list), histories))
      names.push_back(column_name(c) + "|" + c.history.value_or(""));
    return names;
  };
  using Names = std::vector<std::string>;
  const std::string list =
      "{quantity: u_ind}, {quantity: force, name: F}, {quantity: reaction_x, at: x_max}, {quantity: reaction_x, at: bottom}";
  CHECK(named(list, {"energy"}) ==
        Names{"u_ind|", "F|", "reaction_x_x_max|", "reaction_x_bottom|"});
  CHECK(named(list, {"force_error", "reaction_x_max_error"}) ==
        Names{"u_ind|", "F|", "F_error|force_error", "reaction_x_x_max|",
              "reaction_x_x_max_error|reaction_x_max_error", "reaction_x_bottom|"});
  CHECK(named("{quantity: force}, {history: force_error}", {"force_error"}) ==
        Names{"force|", "force_error|force_error"});
  CHECK(named("{quantity: force}", {"force_error", "force_limit_share"}) ==
        Names{"force|", "force_error|force_error", "force_of_mesh|force_limit_share"});
  CHECK(named("{history: force_left}",
              {"force_left", "force_left_error", "force_left_limit_share"}) ==
        Names{"force_left|force_left", "force_left_error|force_left_error",
              "force_left_of_mesh|force_left_limit_share"});
  // the travel of an indenter that has a given force, by both of its names
  const std::vector<std::string> travel{"travel_a", "travel_a_error", "travel_a_limit_share"};
  CHECK(named("{quantity: u_ind}, {history: travel_a}", travel) ==
        Names{"u_ind|", "u_ind_error|travel_a_error", "u_ind_of_mesh|travel_a_limit_share",
              "travel_a|travel_a", "travel_a_error|travel_a_error",
              "travel_a_of_mesh|travel_a_limit_share"});
  for (const char* name : {"force_error", "force_left_error", "reaction_top_error"})
    CHECK(solution::unit_of(name) == std::string("N"));
  for (const char* name : {"force_limit_share", "force_left_limit_share", "torque_a_limit_share"})
    CHECK(solution::unit_of(name) == std::string("-"));
}

TEST_CASE("every quantity can be measured, is finite, and is found by its own word") {
  Sample s;
  for (const QuantityLine& line : quantity_lines()) {
    CAPTURE(line.word);
    const std::string place = needs_place(line) ? ", at: x_max" : "";
    const std::string choice = std::string("{quantity: ") + line.word + place + "}";
    CHECK(std::isfinite(s.value(choice)));
    CHECK(s.look(choice).measures[0].unit == line.unit);
  }
}

TEST_CASE("every quantity is listed once, its word finds it, its unit is that of the number") {
  std::set<std::string> words;
  const std::set<std::string> units{"-",   "mm",   "mm^2", "mm^3", "N",
                                    "MPa", "N mm", "s",    "mm/s", "mm/s^2"};
  const std::string text = columns_text();
  for (std::size_t i = 0; i < quantity_lines().size(); ++i) {
    const QuantityLine& line = quantity_lines()[i];
    CAPTURE(line.word);
    CHECK(words.insert(line.word).second);
    CHECK(static_cast<std::size_t>(quantity(line.word)) == i);
    CHECK(std::string(names(Quantity{})[i]) == line.word);
    CHECK(units.count(line.unit) == 1);
    const std::string first = std::string("\n  ") + line.word + " ",
                      list = text.substr(0, text.find("\nhistory:"));
    CHECK(list.find(first) != std::string::npos);
    CHECK(list.find(first) == list.rfind(first));
  }
  CHECK_THROWS_AS(quantity("no_such_quantity"), std::logic_error);
}

// A body of another size, in other units of length and force: every number changes by the factor
// that its unit says.
TEST_CASE("a column has the dimension that its unit says") {
  constexpr double length = 3, force = 7, stress = force / (length * length);
  Sample s, scaled;
  for (Vec3& X : scaled.mesh.X) X *= length;
  for (Vec3& u : scaled.state.u) u *= length;
  for (Vec3& r : scaled.state.reaction) r *= force;
  for (Vec3& v : scaled.state.velocity) v *= length;
  for (Vec3& a : scaled.state.acceleration) a *= length;
  s.state.u_ind = Vec3(0.1, -0.4, 0.2), scaled.state.u_ind = length * s.state.u_ind;
  s.state.contact.assign(s.mesh.X.size(), {0.2, 0.05, 0.01, 2});
  scaled.state.contact.assign(s.mesh.X.size(), {stress * 0.2, stress * 0.05, length * 0.01, 2});
  s.state.force_ind = Vec3(0.3, 2, -0.1), scaled.state.force_ind = force * s.state.force_ind;
  s.state.sums = {0.6, 1.5, 0.2, 0.01, 0.4, 0.7, 0.8};
  scaled.state.sums = {length * 0.6, length * force * 1.5, length * force * 0.2,
                       0.01,         length * force * 0.4, 0.7,
                       force * 0.8};
  const std::map<std::string, double> factor{{"-", 1},
                                             {"mm", length},
                                             {"mm^2", length * length},
                                             {"mm^3", length * length * length},
                                             {"N", force},
                                             {"MPa", stress},
                                             {"N mm", length * force},
                                             {"s", 1},
                                             {"mm/s", length},
                                             {"mm/s^2", length}};
  for (auto& history : scaled.state.histories) {
    const auto column = std::find_if(quantity_lines().begin(), quantity_lines().end(),
                                     [&](const auto& q) { return q.word == history.first; });
    history.second *= factor.at(column == quantity_lines().end() ? solution::unit_of(history.first)
                                                                 : column->unit);
  }
  Material law = test::table1(30, 1e-2), stiffer = law;
  std::get<QuadraticVolume>(stiffer.volume).d /= stress;
  for (Fibre& f : stiffer.fibres) std::get<HgoFibre>(f.law).c1 *= stress;
  for (MatrixTerm& term : stiffer.matrix)
    for (double* a : {&std::get<Yeoh>(term).a1, &std::get<Yeoh>(term).a2, &std::get<Yeoh>(term).a3})
      *a *= stress;
  const Body body = test::body(s.mesh, {law}, Formulation::mean_dilatation),
             other = test::body(scaled.mesh, {stiffer}, Formulation::mean_dilatation);
  for (const QuantityLine& line : quantity_lines()) {
    CAPTURE(line.word);
    const std::string choice =
        std::string("{quantity: ") + line.word + (needs_place(line) ? ", at: x_max}" : "}");
    GaussValues gauss, of_other;
    const double value =
        measured(body, look_up(choices(choice), "columns", body, s.available).measures,
                 StressAt::nodal_average, s.state, gauss)[0];
    const double then =
        measured(other, look_up(choices(choice), "columns", other, s.available).measures,
                 StressAt::nodal_average, scaled.state, of_other)[0];
    CHECK(value != 0);
    CHECK(then == near(factor.at(line.unit) * value, 1e-9));
  }
}

TEST_CASE(
    "the list of columns says unit and meaning of every quantity and every number of the solver") {
  const std::string text = columns_text();
  for (const QuantityLine& line : quantity_lines()) {
    CAPTURE(line.word);
    CHECK(std::string(line.meaning).size() >= 6);
    CHECK(text.find(std::string("\n  ") + line.word + " ") != std::string::npos);
  }
  CHECK(
      text.find(
          "pressure                     MPa   mean stress: tr(sigma)/3, the mean stress: positive in tension") !=
      std::string::npos);
  // a history has the unit of the quantity of its name
  for (const QuantityLine& line : quantity_lines())
    if (const solution::HistoryLine* history = solution::line_of(std::string_view(line.word));
        history && !is<OfPoint>(line))
      CHECK(std::string(history->unit) == line.unit);
  const auto unit = [](const std::string& choice) {
    return unit_of(choices(choice)[0]);
  };
  CHECK(unit("{history: shear_stiffness_min}") == "MPa");
  CHECK(unit("{history: weakest_x}") == "mm");
  CHECK(unit("{history: energy}") == "N mm");
  CHECK(unit("{history: force_left_y}") == "N");
  CHECK(unit("{history: volume_change}") == "-");
}

TEST_CASE("the unloaded state gives zeros, and ones for ratios of volume and length") {
  Sample s;
  s.state = unloaded(s.mesh);
  for (const QuantityLine& line : quantity_lines()) {
    CAPTURE(line.word);
    const bool place = std::string(line.word).starts_with("von_mises_max_");
    if (place) continue;
    const std::string word = line.word;
    const bool ratio =
        word.starts_with("J") || word.starts_with("fibre_stretch") || word == "relaxation";
    const double value = s.value(std::string("{quantity: ") + line.word +
                                 (needs_place(line) ? ", at: x_max" : "") + "}");
    CHECK(value == near(ratio ? 1 : 0, 1e-14));
  }
}

TEST_CASE("the indenter's travel is a length, its force positive where the body resists") {
  Sample s;
  s.state.u_ind = Vec3(0.3, -0.4, 0);      // presses down and moves along x
  s.state.force_ind = Vec3(-0.6, 5, 0.1);  // pushed up and back
  CHECK(s.value("{quantity: u_ind}") == near(0.5));
  CHECK(s.value("{quantity: force}") == near(0.6 * 0.6 + 0.8 * 5));
  CHECK(s.values("{quantity: force_x}, {quantity: force_y}, {quantity: force_z}") ==
        std::vector<double>{-0.6, 5, 0.1});
  CHECK(s.values("{quantity: contact_nodes}, {quantity: stick_nodes}, {quantity: slip_nodes}") ==
        std::vector<double>{5, 3, 2});
  s.state.u_ind.setZero();
  CHECK(s.value("{quantity: force}") == near(s.state.force_ind.norm()));
}

TEST_CASE("displacements, strains and reactions of points and sets") {
  Sample s;
  CHECK(s.value("{quantity: u_y, at: A}") == s.state.u[5][1]);
  double mean = 0, sum = 0;
  const auto& face = s.mesh.node_sets.at("x_max");
  for (int node : face) mean += s.state.u[node][0] / face.size(), sum += s.state.reaction[node][1];
  CHECK(s.value("{quantity: u_x, at: x_max}") == near(mean));
  CHECK(s.value("{quantity: eps_xx, at: x_max}") == near(mean / 3));
  CHECK(s.value("{quantity: eps_xx, at: x_max, length: 6}") == near(mean / 6));
  CHECK(s.value("{quantity: reaction_y, at: x_max}") == near(sum));
  CHECK(s.value("{history: energy}") == 0.5);
}

TEST_CASE("stress at a point is the nodal average or that of the nearest Gauss points, as chosen") {
  Sample s;
  const GaussValues gauss = gauss_values(s.body, s.state.u);
  for (StressAt at : {StressAt::nodal_average, StressAt::nearest_gauss}) {
    const VecX row = node_values(s.body, 5, gauss, at);
    const auto v = s.values(
        "{quantity: sigma_xz, at: A}, {quantity: von_mises, at: A}, {quantity: sigma_1, at: A}, "
        "{quantity: pressure, at: A}, {quantity: J, at: A}, {quantity: fibre_stretch, at: A}",
        at);
    CHECK(v[0] == row[5]);
    CHECK(v[1] == von_mises(sigma_of(row)));
    CHECK(v[2] == principal_stresses(sigma_of(row))[0]);
    CHECK(v[3] == mean_stress(sigma_of(row)));
    CHECK(v[4] == row[6]);
    CHECK(v[5] == row[7]);
  }
  CHECK(s.values("{quantity: von_mises, at: A}")[0] !=
        s.values("{quantity: von_mises, at: A}", StressAt::nearest_gauss)[0]);
}

TEST_CASE(
    "extremes are over all Gauss points, the greatest von Mises stress over all nodes, with its place") {
  Sample s;
  double most = 0, J = 10, stretch = 0;
  Vec3 place;
  const GaussValues all = gauss_values(s.body, s.state.u);
  for (int n = 0; n < s.mesh.n_nodes(); ++n) {
    const double here = von_mises(sigma_of(node_values(s.body, n, all, StressAt::nodal_average)));
    if (here <= most) continue;
    most = here;
    place = s.mesh.X[n];
  }
  for (int e = 0; e < s.mesh.n_cells(); ++e)
    for (int g = 0; g < 8; ++g) {
      const VecX row = gauss_values(s.body, s.state.u, e).row(g).transpose();
      J = std::min(J, row[6]), stretch = std::max(stretch, row[7]);
    }
  const auto v = s.values(
      "{quantity: von_mises_max}, {quantity: von_mises_max_x}, {quantity: von_mises_max_y}, "
      "{quantity: von_mises_max_z}, {quantity: J_min}, {quantity: fibre_stretch_max}");
  CHECK(v[0] == most);
  CHECK((Vec3(v[1], v[2], v[3]) - place).norm() == 0);
  CHECK(v[4] == J);
  CHECK(v[5] == stretch);
}

TEST_CASE(
    "names that the mesh or the solution lacks are complaints with their key and what there is") {
  Sample s;
  const auto bad = [&](const std::string& list) {
    return s.look(list).complaints;
  };
  auto found = bad("{quantity: force}, {quantity: u_y, at: Q}");
  REQUIRE(found.size() == 1);
  CHECK(found[0].key == "columns[1].at");
  CHECK(found[0].found == "the mesh has no nodes called \"Q\"");
  CHECK(found[0].expected.starts_with("one of A, B, bottom, top, x_max"));
  found = bad("{quantity: u_y, at: x_mas}");
  CHECK(found.at(0).hint == "did you mean \"x_max\"?");
  found = bad("{history: enrgy}");
  CHECK(found.at(0).key == "columns[0].history");
  CHECK(found.at(0).hint == "did you mean \"energy\"?");
  CHECK(bad("{quantity: fibre_stretch, at: A, family: 2}").at(0).key == "columns[0].family");
  s.available.contact = false;
  CHECK(bad("{quantity: u_ind}").at(0).key == "columns[0].quantity");
  const Body isotropic = test::body(s.mesh, {test::neo_hooke(1, 1)}, Formulation::displacement);
  CHECK(look_up(choices("{quantity: fibre_stretch_max}"), "further", isotropic, {})
            .complaints.at(0)
            .key == "further[0].quantity");
}

TEST_CASE("what is wrong with a config is known before there is a solution") {
  const auto complaint = [](const std::string& yaml) -> std::string {
    try {
      read_config<PostConfig>(parse_yaml(yaml, "post.yaml"));
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::config);
      return failure.what();
    }
    return "nothing";
  };
  const std::string good =
      "columns:\n- {quantity: u_ind}\n- {quantity: u_y, at: A}\n- {quantity: force}\n";
  CHECK(complaint(good) == "nothing");
  const auto says = [&](const std::string& yaml, const std::string& part) {
    const std::string message = complaint(yaml);
    INFO(message);
    CHECK(message.find(part) != std::string::npos);
  };
  says("columns: []", "post.yaml:1:1: columns: an empty list");
  says("columns:\n- {quantity: von_misess, at: M}", "did you mean \"von_mises\"?");
  says("columns:\n- {quantity: von_mises}", "post.yaml:2:3: columns[0].at: missing");
  says("columns:\n- {quantity: force, at: M}",
       "post.yaml:2:21: columns[0].at: M; expected no place");
  says("columns:\n- {at: M}", "neither a quantity nor a history");
  says("columns:\n- {quantity: t, history: energy}", "both a quantity and a history");
  says("columns:\n- {quantity: t, name: 'a,b'}",
       "post.yaml:2:17: columns[0].name: the column name \"a,b\"");
  says(good + "further:\n- {quantity: force}",
       "post.yaml:6:3: further[0]: a second column called force");
  says(good + "snapshots: [last, t=0.5, 3, -1]", "snapshots[3]: \"-1\"");
  says(good + "figures:\n  f: {x: u_ind, y: [force, u_y]}", "did you mean \"u_y_A\"?");
  says(good + "figures:\n  f: {x: u_ind, y: [force, u_y]}", "post.yaml:6:28: figures.f.y[1]");
  says(good + "figures:\n  f: {x: u_ind, y: [force, u_y_A]}",
       "u_y_A in mm; expected columns in N, as the first");
  says(good + "figures:\n  f: {x: u_ind, y: [force], legends: [a, b]}", "2 legends for 1 columns");
  says(good + "figures:\n  render: {x: u_ind, y: [force]}", "figures.render");
  says(good + "render: {field: force}",
       "render.field: force; expected a quantity of nodes or points");
  says(good + "render: {field: u_y, range: [1, 0]}", "render.range");
  says(good + "render: {field: u_y, step: first}", "render.step");
}

TEST_CASE("states are chosen as the last, by row, or as the first at or beyond t") {
  const std::vector<double> t{0, 0.25, 0.1 + 0.2 + 0.2, 1};
  const auto row = [&](const std::string& text) {
    return row_of(*parse_step(text), t);
  };
  CHECK(row("last") == 3);
  CHECK(row("0") == 0);
  CHECK(row("2") == 2);
  CHECK(row("4") == -1);
  CHECK(row("t=0") == 0);
  CHECK(row("t=0.26") == 2);
  CHECK(row("t=0.5") == 2);
  CHECK(row("t=1") == 3);
  CHECK(row("t=1.1") == -1);
  for (const char* bad : {"", "first", "-1", "1.5", "t=", "t=x", "t=nan", "t=inf", "2x"})
    CHECK_FALSE(parse_step(bad));
}

TEST_CASE("the configs of the project are read, and their canonical text reads back the same") {
  for (const char* name : {"indentation", "tensile", "compression", "smoke"}) {
    CAPTURE(name);
    const auto loaded = read_config<PostConfig>(
        load_yaml(std::string(SOURCE_DIR) + "/configs/post/" + name + ".yaml"));
    const std::string text = to_yaml(loaded.config);
    CHECK(to_yaml(read_config<PostConfig>(parse_yaml(text, "again.yaml")).config) == text);
  }
}

TEST_CASE("every column of every shipped post config has its line in the list") {
  int columns = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(std::string(SOURCE_DIR) + "/configs/post")) {
    const Tree tree = load_yaml(file.path().string());
    const Tree* list = tree.find("columns");
    if (!list || list->list.empty() || list->list[0].kind != Tree::Kind::map)
      continue;  // of gather and others
    CAPTURE(file.path().string());
    for (const ColumnChoice& c : read_config<PostConfig>(tree).config.columns) {
      if (c.history) CHECK(solution::line_of(*c.history));
      if (c.quantity)
        CHECK(columns_text().find(std::string("\n  ") + line_of(*c.quantity).word + " ") !=
              std::string::npos);
      ++columns;
    }
  }
  CHECK(columns > 50);
}

TEST_CASE("the table of an indentation has the columns that others rely on") {
  const auto config =
      read_config<PostConfig>(load_yaml(std::string(SOURCE_DIR) + "/configs/post/indentation.yaml"))
          .config;
  std::string head;
  for (const ColumnChoice& c : config.columns)
    head += (head.empty() ? "" : ",") + csv_name(column_name(c), unit_of(c));
  CHECK(
      head ==
      "u_ind_mm,force_N,von_mises_M_MPa,von_mises_max_MPa,u_y_A_mm,u_y_B_mm,u_y_C_mm,u_y_D_mm,newton_iterations,contact_nodes");
}

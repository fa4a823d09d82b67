// A section in place of a block: offered where the scene is the same around an axis, taken where
// the sides matter little enough, and its force is that of the block within what is named.
#include "accuracy/refinement/section_in_place.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <random>

#include "support/laws.hpp"
#include "support/near.hpp"

using namespace langer;

namespace section_in_place_tests {

namespace {

using Random = std::mt19937;
double draw(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
const auto nowhere = [](const std::string&) {
  return Place{};
};
const Voice silent{"solve", true, false};

SolveConfig pressed(double length, double width, double thickness, double edge) {
  SolveConfig config;
  config.mesh.emplace();
  config.mesh->geometry =
      IndentedBlock{{-0.5 * length, 0, -0.5 * width}, {length, thickness, width}, 2.5, 0.6, edge};
  config.mesh->cells = CellType::hex27;
  config.material = test::neo_hooke(0.1, 1e-3);
  config.supports = {{"bottom", {Axis::x, Axis::y, Axis::z}}};
  config.contacts["ball"] = {"", Sphere{2.5, {0, thickness + 2.5, 0}}, 0, {{1, {0, -0.6, 0}}}};
  config.path.first = config.path.largest = 0.5;
  config.stability = StabilityCheck::off;
  return config;
}

bool offered(const SolveConfig& config) {
  return on_a_disc(config, config.material, 5).has_value();
}

double force_of(const SolveConfig& config) {
  return end_of_path(config, config.material, nowhere).at(0).value;
}

double named(const std::vector<Summary>& summary, const std::string& name) {
  for (const Summary& s : summary)
    if (s.name == name) return s.value;
  FAIL("no " << name);
  return 0;
}

}  // namespace

TEST_CASE(
    "a section is offered for what is the same around the block's axis, wherever that is, as seen from there") {
  Random random(31);
  for (int n = 0; n < 10; ++n) {
    SolveConfig config = pressed(12, 10, 2, 0.3);
    const double x = draw(random, -5, 5), y = draw(random, -2, 2), z = draw(random, -5, 5);
    auto& block = std::get<IndentedBlock>(config.mesh->geometry);
    for (int k = 0; k < 3; ++k)
      block.origin[static_cast<std::size_t>(k)] += std::array{x, y, z}[static_cast<std::size_t>(k)];
    const double at_x = block.origin[0] + 6,
                 at_z = block.origin[2] + 5;  // in the digits of the block
    Indenter shape = Sphere{2.5, {at_x, y + 4.5, at_z}};
    if (n % 3 == 1) shape = Cylinder{1.5, 0.3, {at_x, y + 2, at_z}};
    if (n % 3 == 2) shape = Ellipsoid{{2, 1, 2}, {at_x, y + 3, at_z}};
    config.contacts["ball"].rigid = shape;
    config.mesh->points["A"] = {at_x + 3, y + 2, at_z};
    config.mesh->sets["patch"] = {"top", InCylinder{"y", {at_x, 0, at_z}, 3}};
    config.contacts["ball"].on = "patch";
    if (n % 2) {
      Fibre none{HgoFibre{0.2, 0.3}, draw(random, -90, 90)};
      none.kappa = 1.0 / 3;
      config.material->fibres = {none};
    }
    const auto section = on_a_disc(config, config.material, 6.2);
    REQUIRE(section.has_value());
    const auto& disc = std::get<IndentedDisc>(section->mesh->geometry);
    CHECK(disc.size == std::array{6.2, 2.0});
    CHECK(disc.base == block.origin[1]);
    CHECK(disc.edge == 0.3);
    CHECK(section->mesh->points.at("A")[0] == near(3, 1e-12));
    CHECK(section->mesh->points.at("A")[2] == 0);
    CHECK(unchanged_by(section->contacts.at("ball").rigid.value(), {Vec3(-1, 1, -1).asDiagonal()}));
    CHECK(section->complaints().empty());
  }
}

TEST_CASE(
    "none is offered for what is not: place, path, supports at the sides, fibres, sets, points, a named symmetry") {
  const SolveConfig base = pressed(12, 10, 2, 0.3);
  REQUIRE(offered(base));
  const std::vector<std::function<void(SolveConfig&)>> breaks{
      [](SolveConfig& c) {
        c.contacts["ball"].rigid = Sphere{2.5, {0.1, 4.5, 0}};
      },
      [](SolveConfig& c) {
        c.contacts["ball"].rigid = Ellipsoid{{2, 1, 1.9}, {0, 3, 0}};
      },
      [](SolveConfig& c) {
        c.contacts["ball"].rigid = Cylinder{1, 0.3, {0, 2, 0}, {0.1, 1, 0}};
      },
      [](SolveConfig& c) {
        c.contacts["ball"].motion = {{1, {0.1, -0.6, 0}}};
      },
      [](SolveConfig& c) {
        c.contacts["other"] = {"", Sphere{1, {3, 3, 0}}, 0, {{1, {0, -0.2, 0}}}};
      },
      [](SolveConfig& c) {
        c.contacts.clear(), c.loads = {{"top", Displacement{{}, HistoryConfig{-0.1}, {}}}};
      },
      [](SolveConfig& c) {
        c.supports.push_back({"x_min", {Axis::x}});
      },
      [](SolveConfig& c) {
        c.supports.push_back({"z_max", {Axis::x, Axis::y, Axis::z}});
      },
      [](SolveConfig& c) {
        c.supports = {{"bottom", {Axis::x, Axis::y}}};
      },
      [](SolveConfig& c) {
        c.loads = {{"bottom", Displacement{HistoryConfig{0.1}, {}, {}}}};
      },
      [](SolveConfig& c) {
        c.loads = {{"x_max", Displacement{{}, HistoryConfig{0.1}, {}}}};
      },
      [](SolveConfig& c) {
        c.material->fibres = {Fibre{HgoFibre{0.2, 0.3}, 0}};
      },
      [](SolveConfig& c) { c.materials["skin"].material = test::table1(30, 1e-3); },
      [](SolveConfig& c) {
        c.mesh->sets["patch"] = {"top", InBox{{-1, 0, -1}, {1, 3, 1}}};
      },
      [](SolveConfig& c) {
        c.mesh->sets["patch"] = {"top", InCylinder{"y", {0.1, 0, 0}, 2}};
      },
      [](SolveConfig& c) {
        c.mesh->sets["side"] = {"x_min", InCylinder{"y", {0, 0, 0}, 2}};
      },
      [](SolveConfig& c) {
        c.mesh->points["A"] = {0, 2, 3};
      },
      [](SolveConfig& c) {
        c.mesh->points["A"] = {-3, 2, 0};
      },
      [](SolveConfig& c) { c.symmetry = SymmetryChoice::half_turn; },
      [](SolveConfig& c) {
        std::get<IndentedBlock>(c.mesh->geometry).under = {0.5, 0};
      },
      [](SolveConfig& c) { c.mesh->geometry = Block{}; },
      [](SolveConfig& c) { c.mesh.reset(); },
  };
  for (std::size_t i = 0; i < breaks.size(); ++i) {
    CAPTURE(i);
    SolveConfig config = base;
    breaks[i](config);
    CHECK_FALSE(offered(config));
  }
}

TEST_CASE(
    "the force of a block lies between those of the discs inside and around it, and within what the sides may change") {
  Random random(32);
  for (int n = 0; n < 3; ++n) {
    const double length = draw(random, 5, 7), width = n == 0 ? length : draw(random, 5, 7);
    CAPTURE(length);
    CAPTURE(width);
    SolveConfig config = pressed(length, width, draw(random, 2, 3), 0.3536);
    if (n == 2) config.contacts["ball"].friction = 0.3;
    const RadiiOfBlock radii = radii_of(std::get<IndentedBlock>(config.mesh->geometry));
    const auto disc = [&](double radius) {
      return force_of(*on_a_disc(config, config.material, radius));
    };
    const double inside = disc(radii.inside), alike = disc(radii.alike),
                 around = disc(radii.around);
    config.symmetry = SymmetryChoice::automatic;
    const double block = force_of(config);
    MESSAGE("block ", block, " N, discs inside ", inside, ", alike ", alike, ", around ", around);
    CHECK(inside < block);
    CHECK(block < around);
    CHECK(std::abs(block - alike) < std::max(alike - inside, around - alike));
    CHECK(inside < 0.99 * around);  // the sides matter here
  }
}

TEST_CASE("the sides are measured where the force is judged, and not where the indenter has left") {
  const auto sides = [](std::vector<WaypointConfig> motion) {
    SolveConfig config = pressed(7, 7, 2, 0.3536);
    config.reduce = Reduce::automatic;
    config.accuracy = "10%";
    config.contacts["ball"].motion = std::move(motion);
    const SectionInPlace section(silent, config, config.material, nowhere, false);
    REQUIRE(section.taken());
    return named(section.summary({}), "force_error_sides");
  };
  const double pressed_only = sides({{1, {0, -0.6, 0}}});
  CHECK(pressed_only > 1e-3);
  CHECK(sides({{0.5, {0, -0.6, 0}}, {1, {0, -0.1, 0}}}) == near(pressed_only, 1e-3));
  CHECK(sides({{0.5, {0, -0.6, 0}}, {1, {0, 0.1, 0}}}) == near(pressed_only, 1e-3));
}

TEST_CASE(
    "a section is taken where its sides change less than is allowed, and names what they change") {
  SolveConfig wide = pressed(24, 24, 2, 0.3536), narrow = pressed(5, 5, 2.5, 0.3536);
  for (SolveConfig* config : {&wide, &narrow}) {
    const SectionInPlace unasked(silent, *config, config->material, nowhere, false);
    CHECK_FALSE(unasked.taken());
    CHECK(unasked.summary({}).empty());
    config->reduce = Reduce::automatic;
    CHECK_FALSE(SectionInPlace(silent, *config, config->material, nowhere, true).taken());
  }
  const SectionInPlace taken(silent, wide, wide.material, nowhere, false);
  REQUIRE(taken.taken());
  CHECK(std::holds_alternative<IndentedDisc>(taken.config().mesh->geometry));
  const double sides = named(taken.summary({}), "force_error_sides");
  const double section = force_of(taken.config());
  CHECK(sides < 0.01 * section);
  wide.symmetry = SymmetryChoice::automatic;
  CHECK(std::abs(force_of(wide) - section) <
        sides + 0.01 * section);  // and what these cells are worth
  CHECK_FALSE(SectionInPlace(silent, narrow, narrow.material, nowhere, false).taken());
  narrow.accuracy = "50%";
  CHECK(SectionInPlace(silent, narrow, narrow.material, nowhere, false).taken());
}

TEST_CASE("an accuracy counts the sides with the estimate: shorter cells first, then the block") {
  SolveConfig config = pressed(24, 24, 2, 0.3536);
  config.reduce = Reduce::automatic, config.accuracy = "1%";
  SectionInPlace section(silent, config, config.material, nowhere, false);
  REQUIRE(section.taken());
  CHECK(section.config().estimate == EstimateBy::refinement);
  CHECK(section.config().mesh->cells == CellType::hex27);
  CHECK(section.config().complaints().empty());
  const auto edge = [&] {
    return std::get<IndentedDisc>(section.config().mesh->geometry).edge;
  };
  const auto errors = [](double share) {
    return std::vector<ErrorEstimate>{{{"force", "N", 2}, 2 * share, 0, 0, 0, 2}};
  };
  const double first = edge();
  CHECK(section.accurate(errors(0.001)));
  const double percent = named(section.summary(errors(0.001)), "accuracy");
  CHECK(percent > 0.1);
  CHECK(percent < 1);
  CHECK_FALSE(section.accurate(errors(0.02)));
  REQUIRE(section.taken());
  CHECK(edge() < first);
  const double after = edge(), step = section.config().path.largest_increment();
  CHECK(after == near(first * std::sqrt(0.8 * (1 - percent) / 2), 0.3));  // by what the sides leave
  // what increments cost is taken from them
  CHECK_FALSE(section.accurate({{{"force", "N", 2}, 0.004, 0.04, 0, 0, 2}}));
  CHECK(section.config().path.largest_increment() < 0.6 * step);
  CHECK(edge() > 0.7 * after);
  int times = 0;
  while (section.taken() && times < 20) section.accurate(errors(0.02)), ++times;
  CHECK(times < 10);
  CHECK_FALSE(section.taken());
  CHECK(std::holds_alternative<IndentedBlock>(section.config().mesh->geometry));
}

TEST_CASE("an accuracy is asked of forces on indenters, of several their own, else of reactions") {
  const auto names = [](std::vector<std::string> found) {
    std::vector<Valued> all;
    std::vector<ErrorEstimate> estimates;
    for (const std::string& name : found)
      all.push_back({name, "N", 1}), estimates.push_back({all.back()});
    std::string chosen;
    for (const Valued& v : forces_judged(all)) chosen += v.name + " ";
    std::string again;
    for (const ErrorEstimate& e : forces_judged(estimates)) again += e.of.name + " ";
    CHECK(chosen == again);
    return chosen;
  };
  CHECK(names({"force", "force_left", "reaction_top", "force_right", "von_mises_max"}) ==
        "force_left force_right ");
  CHECK(names({"reaction_top", "von_mises_max", "force"}) == "force ");
  CHECK(names({"reaction_top", "displacement_A", "reaction_side"}) ==
        "reaction_top reaction_side ");
  CHECK(names({"von_mises_max"}) == "");
}

}  // namespace section_in_place_tests

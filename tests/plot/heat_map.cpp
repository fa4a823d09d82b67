// Matrices as coloured cells and groups of bars: what is drawn where.
#include "results/plot/heat_map.hpp"
#include "support/marks.hpp"
#include "support/near.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace langer;

namespace {

const Label* label(const std::vector<Label>& all, const std::string& text) {
  for (const Label& l : all)
    if (l.text == text) return &l;
  return nullptr;
}

double top(const Patch& p) { return std::min(p.corners[0][1], p.corners[2][1]); }
double height(const Patch& p) { return std::abs(p.corners[2][1] - p.corners[0][1]); }

}  // namespace

TEST_CASE(
    "A heat map has one cell per value: red above zero, blue below, grey where there is none") {
  HeatMap map;
  map.title = "correlation", map.x_names = map.y_names = {"a", "b"};
  map.values.resize(2, 2);
  map.values << 1, -0.5, 0, std::numeric_limits<double>::quiet_NaN();
  map.numbers = map.first_row_on_top = true;
  const Drawing d = heat_map(map);
  const auto cells = test::marks_of<Patch>(d);
  REQUIRE(cells.size() == 4 + 40);  // and the scale
  CHECK(cells[0].fill.r > cells[0].fill.b);
  CHECK(cells[1].fill.b > cells[1].fill.r);
  CHECK(cells[0].fill.r - cells[0].fill.b > cells[1].fill.b - cells[1].fill.r);
  CHECK(cells[3].fill.r == cells[3].fill.g);
  CHECK(top(cells[0]) < top(cells[2]));
  const auto labels = test::marks_of<Label>(d);
  for (const char* text : {"correlation", "a", "b", "1", "-0.50", "0", "–"})
    CHECK(label(labels, text) != nullptr);
  map.first_row_on_top = false;
  const auto turned = test::marks_of<Patch>(heat_map(map));
  CHECK(top(turned[0]) > top(turned[2]));
  for (const auto& [x, y] : cells[3].corners)
    CHECK((x > 0 && x < d.width && y > 0 && y < d.height));
}

TEST_CASE(
    "The line of zero runs between cells of different sign only, losses are redder the earlier they come") {
  HeatMap map;
  map.values = MatX::Constant(3, 3, 1);
  map.zero_line = true;
  const auto strokes = [&] {
    return test::marks_of<Stroke>(heat_map(map)).size();
  };
  const std::size_t axes = strokes();
  map.values(1, 1) = -1;
  CHECK(strokes() == axes + 4);
  map.zero_line = false;
  CHECK(strokes() == axes);
  map.losses = true,
  map.values = (MatX(1, 3) << 0, 0.5, std::numeric_limits<double>::infinity()).finished();
  const auto cells = test::marks_of<Patch>(heat_map(map));
  REQUIRE(cells.size() == 3);  // no scale
  CHECK(cells[0].fill.g < cells[1].fill.g);
}

TEST_CASE("Bars are as high as their values, intervals stand on them, a missing one is left out") {
  Bars b;
  b.groups = {"zone"}, b.series = {"a1", "c1", "c2"};
  b.values = (MatX(3, 1) << 2, 1, std::numeric_limits<double>::quiet_NaN()).finished();
  b.low = b.high = b.values;
  b.low(1, 0) = 0.5, b.high(1, 0) = 1.5;
  const Drawing d = bars(b);
  const auto patches = test::marks_of<Patch>(d);
  REQUIRE(patches.size() == 2 + 3);  // bars, then the legend
  CHECK(height(patches[0]) == near(2 * height(patches[1])));
  const auto labels = test::marks_of<Label>(d);
  for (const char* text : {"zone", "a1", "c1", "c2"}) CHECK(label(labels, text) != nullptr);
  int vertical = 0;
  for (const Stroke& s : test::marks_of<Stroke>(d))
    if (s.points[0][0] == s.points[1][0] &&
        std::abs(s.points[0][1] - s.points[1][1]) == near(0.5 * height(patches[0])))
      ++vertical;
  CHECK(vertical == 1);
}

// The style of figures: sizes on paper, fonts, colours, decimal signs and formats, by what the
// files say of themselves.
#include "results/plot/figure_style.hpp"

#include <doctest/doctest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "results/plot/gnuplot.hpp"
#include "results/plot/heat_map.hpp"
#include "results/plot/map_drawing.hpp"
#include "results/plot/pictures.hpp"
#include "support/marks.hpp"
#include "support/near.hpp"

using namespace langer;

namespace figure_style_tests {

namespace fs = std::filesystem;

namespace {

std::string folder(const std::string& name) {
  const fs::path path = fs::path(BINARY_DIR) / "test_files" / ("style_" + name);
  fs::remove_all(path);
  fs::create_directories(path);
  return path.string();
}
std::string text_of(const std::string& path) {
  std::ostringstream s;
  s << std::ifstream(path, std::ios::binary).rdbuf();
  return s.str();
}
bool has_gnuplot() { return std::system("command -v gnuplot > /dev/null 2>&1") == 0; }

FigureStyle column(double width) {
  FigureStyle style;
  style.width = width;
  style.formats = {PictureFormat::svg, PictureFormat::png, PictureFormat::pdf, PictureFormat::eps};
  style.dpi = 300;
  return style;
}

// the four numbers behind a word
std::array<double, 4> four_behind(const std::string& text, const std::string& word) {
  std::array<double, 4> found{};
  std::size_t at = text.find(word);
  REQUIRE(at != std::string::npos);
  at = text.find_first_of("0123456789-", at + word.size());
  std::istringstream numbers(text.substr(at, 80));
  for (double& x : found) numbers >> x;
  return found;
}
// a PDF with what its compressed streams hold behind it: cairo 1.18 puts the sizes of pages there
std::string pdf_of(const std::string& path) {
  const std::string file = text_of(path);
  std::string all = file;
  for (std::size_t at = file.find("stream\n"); at != std::string::npos;
       at = file.find("stream\n", at + 1)) {
    std::string plain(1 << 20, '\0');
    uLongf n = plain.size();
    const std::string packed = file.substr(at + 7);
    // what is behind the stream's end is no fault of it
    const int result = uncompress(reinterpret_cast<Bytef*>(plain.data()), &n,
                                  reinterpret_cast<const Bytef*>(packed.data()), packed.size());
    if (result == Z_OK) all += plain.substr(0, n);
  }
  return all;
}
int png_width(const std::string& bytes) {
  int width = 0;
  for (int i = 16; i < 20; ++i)
    width = 256 * width + static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
  return width;
}

HeatMap correlations(int n, const std::string& name) {
  HeatMap map;
  map.title = "correlation of the parameters";
  for (int i = 0; i < n; ++i) map.x_names.push_back(name + std::to_string(i));
  map.y_names = map.x_names, map.numbers = map.first_row_on_top = true;
  map.values = MatX::Constant(n, n, -0.987);
  return map;
}

struct TextBox {
  double left, right, top, bottom;
};
TextBox box_of(const Label& label) {
  const double w = text_width(label.text, label.size), h = label.size;
  const double along = label.anchor == Label::Anchor::start    ? 0
                       : label.anchor == Label::Anchor::middle ? -w / 2
                                                               : -w;
  if (label.turned == 90)
    return {label.at[0] - 0.8 * h, label.at[0] + 0.1 * h, label.at[1] - along - w,
            label.at[1] - along};
  return {label.at[0] + along, label.at[0] + along + w, label.at[1] - 0.75 * h, label.at[1]};
}

}  // namespace

TEST_CASE("figures have the width that was asked for, in every format") {
  if (!has_gnuplot()) return;
  for (const double width : {85.0, 170.0}) {
    const std::string where = folder("width");
    std::ofstream(where + "/c.csv") << "t,u_mm\n0,0\n1,0.5\n";
    FigureStyle style = column(width);
    Pictures pictures(where, style);
    pictures.draw("curve",
                  Plot{"", "t", "u (mm)", {{"c.csv", "t", "u_mm", "u"}, {"c.csv", "t", "t", "t"}}});
    pictures.draw("matrix", heat_map(correlations(4, "a"), pictures.look()));
    REQUIRE(pictures.failed().empty());
    for (const std::string name : {"curve", "matrix"}) {
      CAPTURE(name);
      const double points = width / 25.4 * 72;
      CHECK(std::abs(four_behind(pdf_of(where + "/" + name + ".pdf"), "/MediaBox")[2] - points) <
            1);
      CHECK(std::abs(four_behind(text_of(where + "/" + name + ".eps"), "%%BoundingBox:")[2] -
                     points) < 1.5);
      CHECK(std::abs(png_width(text_of(where + "/" + name + ".png")) - width / 25.4 * 300) <= 1);
    }
    CHECK(text_of(where + "/matrix.svg")
              .find("width=\"" + std::to_string(static_cast<int>(width)) + "mm\"") !=
          std::string::npos);
    // gnuplot's SVG counts in 1/96 inch
    const std::string svg_width =
        "width=\"" + std::to_string(std::lround(width / 25.4 * 96)) + "\"";
    CHECK(text_of(where + "/curve.svg").find(svg_width) != std::string::npos);
  }
}

TEST_CASE("letters are as large on paper as they were asked to be, whatever the width") {
  for (const double width : {70.0, 85.0, 180.0})
    for (const double points : {7.0, 9.0}) {
      FigureStyle style = column(width);
      style.font_size = points;
      const Drawing d = heat_map(correlations(3, "a"), style.look());
      CHECK(d.width * style.drawing_unit() == near(width / 25.4 * 72));
      for (const Label& label : test::marks_of<Label>(d))
        if (label.text == "a1") CHECK(label.size * style.drawing_unit() == near(points));
      const std::string script =
          gnuplot_script(Plot{"", "t", "u", {{"c.csv", "t", "u_mm", "u"}}}, "f", style);
      CHECK(script.find("set terminal pdfcairo") != std::string::npos);
      CHECK(script.find("font 'DejaVu Sans," + std::to_string(static_cast<int>(points)) +
                        "' linewidth") != std::string::npos);
    }
}

TEST_CASE(
    "names of parameters in a correlation lie on the page and not on each other, however long and many") {
  for (const double width : {0.0, 85.0, 120.0})
    for (const int n : {2, 5, 9})
      for (const std::string name : {"a", "matrix.yeoh.a", "dermis.fibres[0].hgo.c"}) {
        FigureStyle style;
        if (width > 0) style = column(width);
        const Drawing d = heat_map(correlations(n, name), style.look());
        std::vector<TextBox> boxes;
        for (const Label& label : test::marks_of<Label>(d)) {
          const TextBox b = box_of(label);
          INFO(width << " mm, " << n << " of " << name << ": " << label.text);
          CHECK(b.left > -2);
          CHECK(b.right < d.width + 2);
          CHECK(b.top > -2);
          CHECK(b.bottom < d.height + 2);
          if (label.text.starts_with(name)) boxes.push_back(b);
        }
        CHECK(boxes.size() == static_cast<std::size_t>(2 * n));
        for (std::size_t i = 0; i < boxes.size(); ++i)
          for (std::size_t k = 0; k < i; ++k) {
            const TextBox &a = boxes[i], &b = boxes[k];
            const bool apart =
                a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
            INFO(width << " mm, " << n << " of " << name << ": " << i << " and " << k);
            CHECK(apart);
          }
      }
}

TEST_CASE(
    "a stability map has no two values far apart in one colour, and its scale ends where its values do") {
  HeatMap map;
  map.values = (MatX(1, 6) << -20, -0.2, 0.02, 0.2, 20, 2000).finished();
  map.middle = 0.5, map.limit = 2000, map.swap_colours = true;
  const auto cells = test::marks_of<Patch>(heat_map(map));
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < i; ++k) {
      const Colour &a = cells[static_cast<std::size_t>(i)].fill,
                   &b = cells[static_cast<std::size_t>(k)].fill;
      CHECK(std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 0.03);
    }
  bool below = false, most = false;
  for (const Label& label : test::marks_of<Label>(heat_map(map)))
    below = below || label.text == "-10", most = most || label.text == "1000";
  CHECK(below);
  CHECK(most);
}

TEST_CASE("every map of colours grows in lightness and every signed one falls on both sides") {
  for (const ColourMap map :
       {ColourMap::violet_yellow, ColourMap::viridis, ColourMap::cividis, ColourMap::grey})
    for (int i = 1; i <= 50; ++i)
      CHECK(lightness(scale_colour(i / 50.0, map)) > lightness(scale_colour((i - 1) / 50.0, map)));
  for (const SignedColours colours : {SignedColours::blue_red, SignedColours::green_purple})
    for (int i = 1; i <= 50; ++i)
      for (const double sign : {-1.0, 1.0}) {
        const Colour c = signed_colour(sign * i / 50.0, colours);
        CHECK(lightness(c) < lightness(signed_colour(sign * (i - 1) / 50.0, colours)));
        for (const double part : {c.r, c.g, c.b}) CHECK((part >= -0.002 && part <= 1.002));
      }
}

TEST_CASE("a comma stands between the digits of numbers and nowhere else") {
  CHECK(with_decimal("0.5 to 1.25 MPa", DecimalSign::comma) == "0,5 to 1,25 MPa");
  CHECK(with_decimal("a.b, 1. and .5", DecimalSign::comma) == "a.b, 1. and .5");
  CHECK(with_decimal("0.5", DecimalSign::point) == "0.5");
  FigureStyle style;
  style.decimal = DecimalSign::comma;
  Drawing d{100, 50, {}};
  d.marks = {Label{{5, 5}, "0.5", 12},
             Label{{5, 25}, "version 1.2", 12, Label::Anchor::start, false, false, 0, true}};
  const std::string s = svg(d, style), script = gnuplot_script(d, "p", style);
  for (const std::string& text : {s, script}) {
    CHECK(text.find("0,5") != std::string::npos);
    CHECK(text.find("version 1.2") != std::string::npos);
  }
  Plot plot{"title 0.3",
            "t",
            "u",
            {{"c.csv", "t", "u_mm", "0.5 mm"}, {"c.csv", "t", "u_mm", "sample 1.2"}}};
  plot.lines[0].values = true;
  plot.marks = {{3.84, "limit 3.84"}};
  const std::string curve = gnuplot_script(plot, "f", style);
  for (const char* text : {"set decimalsign ','", "0,5\u00a0mm", "sample\u00a01.2",
                           "title\u00a00.3", "limit\u00a03,84", "first 3.84"})
    CHECK(curve.find(text) != std::string::npos);
}

TEST_CASE("titles go into the caption where a journal wants them there") {
  FigureStyle style;
  style.titles = false;
  const Drawing d = heat_map(correlations(3, "a"), style.look());
  for (const Label& label : test::marks_of<Label>(d))
    CHECK(label.text != "correlation of the parameters");
  CHECK(gnuplot_script(Plot{"a title", "t", "u", {{"c.csv", "t", "u_mm", "u"}}}, "f", style)
            .find("set title") == std::string::npos);
  CHECK(d.height < heat_map(correlations(3, "a")).height);
}

TEST_CASE("a style that cannot be is refused") {
  FigureStyle style;
  CHECK(style.complaints().empty());
  style.font = "Arial,9";
  CHECK(style.complaints().at(0).key == "font");
  style = {};
  style.formats.clear();
  CHECK(style.complaints().at(0).key == "formats");
  style.formats = {PictureFormat::pdf, PictureFormat::pdf};
  CHECK(style.complaints().at(0).key == "formats[1]");
}

}  // namespace figure_style_tests

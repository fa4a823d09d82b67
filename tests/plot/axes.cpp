// What stands at the axes of figures by gnuplot: one notation on each, by the texts of the SVG.
#include <unistd.h>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "results/plot/figure_style.hpp"
#include "results/plot/gnuplot.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

bool has_gnuplot() { return std::system("command -v gnuplot > /dev/null 2>&1") == 0; }

struct Ends {
  double low, high;
};

struct Figure {
  std::string script, svg;
  std::vector<std::string> texts;  // each of one piece, with spaces as they are typed
};

// the texts of a picture, whose sub- and superscripts are pieces of their own in the file
std::vector<std::string> texts_of(const std::string& svg) {
  std::vector<std::string> texts;
  for (std::size_t at = svg.find("<text"); at != std::string::npos;
       at = svg.find("<text", at + 1)) {
    std::string text;
    bool in_tag = false;
    for (const char c : svg.substr(at, svg.find("</text>", at) - at)) {
      in_tag = in_tag || c == '<';
      if (!in_tag && c != '\n' && c != '\t') text += c;
      if (c == '>') in_tag = false;
    }
    for (std::size_t k = text.find("\u00a0"); k != std::string::npos; k = text.find("\u00a0", k))
      text.replace(k, 2, " ");
    text.erase(0, text.find_first_not_of(' '));
    texts.push_back(text);
  }
  return texts;
}

// of this process: cases run side by side
std::string folder() {
  return (fs::path(BINARY_DIR) / "test_files" / fmt::format("axes_{}", getpid())).string();
}

Figure drawn(const std::string& script) {
  const std::string where = folder();
  std::ofstream(where + "/f.gp") << script;
  REQUIRE(run_gnuplot(where, "f.gp") == "");
  std::ostringstream svg;
  svg << std::ifstream(where + "/f.svg").rdbuf();
  return {script, svg.str(), texts_of(svg.str())};
}

Figure drawn(const Ends& x, const Ends& y, DecimalSign sign = DecimalSign::point) {
  const std::string where = folder();
  fs::create_directories(where);
  std::ofstream(where + "/c.csv") << fmt::format("x,y\n{},{}\n{},{}\n", x.low, y.low, x.high,
                                                 y.high);
  FigureStyle style;
  style.decimal = sign;
  style.formats = {PictureFormat::svg};
  Plot plot{"", "travel of it (100% mm)", "energy (N mm)", {{"c.csv", "x", "y", "a"}}};
  plot.marks = {{0.5 * (y.low + y.high), "a mark"}};
  return drawn(gnuplot_script(plot, "f", style));
}

bool has(const Figure& f, const std::string& text) {
  return std::find(f.texts.begin(), f.texts.end(), text) != f.texts.end();
}

}  // namespace

TEST_CASE("an axis of small numbers has a factor in its unit and one notation") {
  if (!has_gnuplot()) return;
  const Figure f = drawn({0, 1}, {0, 4.84e-4});
  INFO(f.svg);
  for (const char* text : {"0", "1", "2", "3", "4", "5", "energy (10-4 N mm)",
                           "travel of it (100% mm)", "0.2", "a mark"})
    CHECK(has(f, text));
  CHECK_FALSE(has(f, "0.0001"));
  CHECK(has(drawn({0, 1}, {0, 4.84e-4}, DecimalSign::comma), "0,2"));
  const Figure comma = drawn({-3e-7, 1e-7}, {0, 2.1e6}, DecimalSign::comma);
  INFO(comma.svg);
  for (const char* text :
       {"-3", "1", "0,5", "2", "2,5", "energy (106 N mm)", "travel of it (10-7 100% mm)"})
    CHECK(has(comma, text));
}

TEST_CASE("no axis mixes 0.0001 with a power of ten, wherever it begins and ends") {
  if (!has_gnuplot()) return;
  const Ends all[] = {{0, 9.6e-5},       {0, 1.7e-4},      {-2e-5, 4.75e-4}, {-5e-4, 1e-5},
                      {-2.6e-4, 2.3e-4}, {2e-5, 3e-4},     {3e-9, 4e-9},     {0, 5.5e-4},
                      {-3e-4, 3e-4},     {9.5e-4, 9.9e-4}, {7e5, 1.4e6},     {-3e7, 10},
                      {0, 2e300},        {0, 3e-300}};
  for (const Ends& ends : all) {
    const Figure f = drawn({0, 1}, ends), turned = drawn(ends, {0, 1});
    for (const Figure* one : {&f, &turned}) {
      INFO(ends.low << " to " << ends.high << "\n" << one->svg);
      CHECK(std::set(one->texts.begin(), one->texts.end()).size() >=
            10);  // no two tics read alike: five beside those of the other axis
      for (const std::string& text : one->texts) CHECK(text.find("×") == std::string::npos);
    }
  }
}

TEST_CASE("small numbers along x have a factor: written out they would touch each other") {
  if (!has_gnuplot()) return;
  const Figure f = drawn({0, 1.8e-3}, {0, 1.8e-3});
  INFO(f.svg);
  for (const char* text : {"travel of it (10-3 100% mm)", "1.8", "energy (N mm)", "0.0018"})
    CHECK(has(f, text));
}

TEST_CASE("all other axes are what gnuplot makes of them") {
  if (!has_gnuplot()) return;
  for (const Ends& ends : {Ends{0, 5},
                           {0, 9.9e-4},
                           {0.00991, 0.01003},
                           {-0.81, 0.93},
                           {3, 8.7e5},
                           {0, 0},
                           {-7e-4, 6e-4}}) {
    INFO(ends.low << " to " << ends.high);
    const Figure f = drawn({0, 1}, ends);
    const std::size_t from = f.script.find("# an axis"), to = f.script.find("set terminal svg");
    REQUIRE(from < to);
    CHECK(f.svg == drawn(f.script.substr(0, from) + f.script.substr(to)).svg);
  }
}

// Figures and the picture of the body: what is drawn, not how it looks.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "mechanics/contact/rigid.hpp"
#include "results/plot/drawing.hpp"
#include "results/plot/figure_style.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/post/figure.hpp"
#include "results/post/map.hpp"
#include "results/post/render.hpp"
#include "support/block.hpp"
#include "support/marks.hpp"
#include "support/near.hpp"

using namespace langer;

namespace {

std::string folder(const std::string& name) {
  const auto path = std::filesystem::path(BINARY_DIR) / "test_files" / ("post_" + name);
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path.string();
}

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }
std::string text_of(const std::string& path) {
  std::ostringstream s;
  s << std::ifstream(path).rdbuf();
  return s.str();
}

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

bool has_gnuplot() { return std::system("command -v gnuplot > /dev/null 2>&1") == 0; }

RenderScene scene_of(const Mesh& mesh) {
  RenderScene scene{mesh, mesh.X, {}, "height (mm)", {}};
  for (const Vec3& x : mesh.X) scene.values.push_back(x[1]);
  return scene;
}

}  // namespace

TEST_CASE("the colour scale grows evenly in lightness and stays within what a screen shows") {
  constexpr int n = 200;
  const double first = lightness(scale_colour(0)), last = lightness(scale_colour(1));
  for (int i = 0; i <= n; ++i) {
    const Colour c = scale_colour(double(i) / n);
    for (double part : {c.r, c.g, c.b}) CHECK((part >= 0 && part <= 1));
    // 0.05 of 100: the digits that the published sRGB matrix has
    CHECK(lightness(c) == near(first + (last - first) * i / n, 5e-4));
  }
  CHECK(lightness(Colour{1, 1, 1}) == near(100, 1e-6));
  CHECK(lightness(Colour{0, 0, 0}) == 0);
  CHECK(hex(scale_colour(-1)) == hex(scale_colour(0)));
  CHECK(hex(Colour{1, 0, 0.5}) == "#ff0080");
}

TEST_CASE("the outer surface is every facet of one cell only, seen from outside") {
  const Mesh mesh = test::block(test::even(0, 3, 3), test::even(0, 2, 2), test::even(0, 1, 1));
  const auto surface = outer_surface(mesh, std::vector<bool>(6, true));
  CHECK(surface.size() == 2 * (3 * 2 + 3 * 1 + 2 * 1));
  const Vec3 middle(1.5, 1, 0.5);
  for (const auto& q : surface) {
    const Vec3 n = (mesh.X[q[2]] - mesh.X[q[0]]).cross(mesh.X[q[3]] - mesh.X[q[1]]);
    CHECK(n.dot(mesh.X[q[0]] - middle) > 0);
  }
  std::vector<bool> one(6, false);
  one[3] = true;
  CHECK(outer_surface(mesh, one).size() == 6);
}

TEST_CASE("a block seen from a corner shows three of its sides, what is near over what is far") {
  const Mesh mesh = test::cube(2);
  RenderChoice choice;
  choice.view = {45, 35};
  const Drawing drawing = render(scene_of(mesh), choice);
  // the outlines of quads are closed lines of five points, as is the frame of the colour bar
  int outlines = 0;
  for (const Stroke& s : test::marks_of<Stroke>(drawing)) outlines += s.points.size() == 5;
  CHECK(outlines == 3 * 4 + 1);
  for (const Patch& p : test::marks_of<Patch>(drawing))
    for (const PagePoint& c : p.corners) {
      CHECK((c[0] >= 0 && c[0] <= drawing.width));
      CHECK((c[1] >= 0 && c[1] <= drawing.height));
    }
}

TEST_CASE("along z the picture is the x-y plane to scale, coloured by the nodes' values") {
  const Mesh mesh = test::block({0, 2}, {0, 1}, {0, 1});
  RenderChoice choice;
  choice.view = {0, 0};
  choice.range = {0, 1};
  const Drawing drawing = render(scene_of(mesh), choice);
  const auto patches = test::marks_of<Patch>(drawing);
  const Patch& whole = patches[0];
  REQUIRE(whole.corners.size() == 4);
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
  for (const PagePoint& c : whole.corners)
    x0 = std::min(x0, c[0]), x1 = std::max(x1, c[0]), y0 = std::min(y0, c[1]),
    y1 = std::max(y1, c[1]);
  CHECK((x1 - x0) / (y1 - y0) == near(2));
  // upper parts are lighter: their value is larger, the shade is the same
  double above = 0, below = 100;
  for (std::size_t i = 1; i < patches.size(); ++i) {
    const Patch& p = patches[i];
    if (p.corners.size() != 4 || p.corners[0][0] > x1) continue;
    const double middle = (p.corners[0][1] + p.corners[2][1]) / 2;
    if (middle < y0 + 0.2 * (y1 - y0)) above = std::max(above, lightness(p.fill));
    if (middle > y0 + 0.8 * (y1 - y0)) below = std::min(below, lightness(p.fill));
  }
  CHECK(above > below + 20);
}

TEST_CASE("cuts leave out cells and cut the sphere, whose disc then faces the eye") {
  const Mesh mesh = test::cube(4);
  RenderScene scene = scene_of(mesh);
  scene.indenters = {outline(Sphere{0.4, {0.5, 1.4, 0.5}}, {})};
  RenderChoice choice;
  choice.view = {20, 20};
  const auto discs = [](const Drawing& d) {
    int n = 0;
    for (const Patch& p : test::marks_of<Patch>(d)) n += p.corners.size() > 12;
    return n;
  };
  CHECK(discs(render(scene, choice)) == 0);
  choice.cuts = {{CutNormal::z, 0.5, Side::below}};
  CHECK(discs(render(scene, choice)) == 1);
  choice.cuts[0].keep = Side::above;  // the disc looks away
  CHECK(discs(render(scene, choice)) == 0);
  choice.cuts[0].at = 2;  // nothing is left: still a drawing
  CHECK_NOTHROW(render(scene, choice));
  // ... whose colours mean nothing: no bar of values from infinity to infinity
  choice.range = std::nullopt;
  scene.values.assign(scene.x.size(), 1), scene.indenters.clear();
  const Drawing bare = render(scene, choice);
  for (const Stroke& s : test::marks_of<Stroke>(bare))
    for (const PagePoint& c : s.points) CHECK((std::isfinite(c[0]) && std::isfinite(c[1])));
  CHECK(test::marks_of<Patch>(bare).empty());
}

TEST_CASE(
    "a cut along z, as of a block, leaves a section as it is: the section lies in that plane") {
  Mesh mesh = test::cube(3);
  mesh.section = Section{SectionOf::plane_strain};
  RenderScene scene = scene_of(mesh);
  RenderChoice choice;
  const auto patches = [&] {
    return test::marks_of<Patch>(render(scene, choice)).size();
  };
  const std::size_t whole = patches();
  REQUIRE(whole >= 9);
  for (const Side side : {Side::below, Side::above}) {
    choice.cuts = {{CutNormal::z, 0, side}};
    CHECK(patches() == whole);
  }
  choice.cuts = {{CutNormal::x, 0.5, Side::below}};
  CHECK(patches() < whole);
}

// The plate is solid, so its profile is filled. What is on the other side of the axis is not shown.
TEST_CASE("a plate with a hole is drawn as its profile where the body is a section") {
  Mesh mesh = test::cube(3);
  mesh.section = Section{SectionOf::axisymmetric};
  const auto profiles = [](const Drawing& drawing) {
    std::vector<Patch> found;
    for (const Patch& p : test::marks_of<Patch>(drawing)) {
      if (p.corners.size() > 5 && lightness(p.fill) > 80) found.push_back(p);
    }
    return found;
  };
  const auto ends = [](const Patch& patch, int k) {
    std::array<double, 2> out{1e9, -1e9};
    for (const PagePoint& c : patch.corners) {
      out[0] = std::min(out[0], c[k]);
      out[1] = std::max(out[1], c[k]);
    }
    return out;
  };
  RenderScene scene = scene_of(mesh);
  CHECK(profiles(render(scene, {})).empty());
  for (const Aperture& plate :
       {Aperture{0.5, 0.1, {0, 1, 0}}, Aperture{0.5, 0.1, {0, 0, 0}, {0, -1, 0}}}) {
    scene.indenters = {outline(plate, {Vec3(0.5, 0.5, 0), 2})};
    const Drawing drawing = render(scene, {});
    const std::vector<Patch> filled = profiles(drawing);
    REQUIRE(filled.size() == 1);
    // the hole of 0.5 mm, the plate as far as 1 mm, a wall of 1.1 mm
    const auto x = ends(filled[0], 0);
    const auto y = ends(filled[0], 1);
    CHECK((y[1] - y[0]) / (x[1] - x[0]) == near(1.1 / 0.5, 1e-6));
    double left = 1e9;
    for (const Patch& p : test::marks_of<Patch>(drawing)) left = std::min(left, ends(p, 0)[0]);
    CHECK(x[0] - left == near(x[1] - x[0], 1e-6));
  }
  // in a body of three dimensions the whole wall stays
  mesh.section = std::nullopt;
  RenderScene body = scene_of(mesh);
  body.indenters = scene.indenters;
  CHECK(profiles(render(body, {})).empty());
}

TEST_CASE("every indenter is drawn, of whatever shape, the first and the fifth") {
  const Mesh mesh = test::cube(2);
  RenderScene scene = scene_of(mesh);
  Facets facets;
  facets.rounding = 0.05;
  facets.tree = std::make_shared<TriangleTree>(
      Triangles{{{0, 1.2, 0}, {1, 1.2, 0}, {0, 1.2, 1}, {0.3, 2, 0.3}},
                {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}});
  const std::vector<Indenter> shapes{Sphere{0.4, {0.5, 1.4, 0.5}},
                                     Plane{{0, 1, 0}, {0, -1, 0}},
                                     Cylinder{0.3, 0.1, {0.2, 1, 0.2}},
                                     Ellipsoid{{0.3, 0.2, 0.4}, {0.8, 1.2, 0.8}},
                                     facets,
                                     Aperture{0.3, 0.1, {0.5, 1, 0.5}}};
  REQUIRE(shapes.size() == std::variant_size_v<Indenter>);
  const auto marks = [&](const RenderScene& s) {
    return render(s, {}).marks.size();
  };
  const std::size_t bare = marks(scene);
  for (const Indenter& shape : shapes) {
    RenderScene alone = scene;
    alone.indenters = {outline(shape, {Vec3(0.5, 0.5, 0.5), 2})};
    CAPTURE(shape.index());
    CHECK(marks(alone) > bare + 3);
    const std::size_t before = marks(scene);
    scene.indenters.push_back(alone.indenters[0]);
    CHECK(marks(scene) == before + marks(alone) - bare);
  }
}

TEST_CASE("SVG and gnuplot script show the same marks, and texts cannot break out of either") {
  Drawing drawing{100, 50, {}};
  drawing.marks = {Patch{{{0, 0}, {10, 0}, {10, 10}}, Colour{1, 0, 0}},
                   Stroke{{{0, 0}, {10, 0}}, Colour{}},
                   Label{{5, 5}, "a <b> & 'c'\n`touch broken` \"d\"", 12}};
  const std::string s = svg(drawing, FigureStyle());
  CHECK(count(s, "<polygon") == 1);
  CHECK(count(s, "<polyline") == 1);
  CHECK(s.find("a &lt;b&gt; &amp; 'c' `touch broken`") != std::string::npos);
  const std::string script = gnuplot_script(drawing, "p", FigureStyle());
  CHECK(count(script, "0.00 50.00 16711680\n10.00 50.00 16711680\n10.00 40.00 16711680\n\n") ==
        1);                              // the patch, y upwards, red
  CHECK(count(script, ".50 0\n") == 4);  // the stroke as a black rectangle
  CHECK(count(script, "\n\n") == 2);
  CHECK(script.find("set label 'a <b> & ''c'' `touch broken` \"d\"'") != std::string::npos);
  if (!has_gnuplot()) return;
  const std::string where = folder("drawing");
  write(where + "/p.gp", script);
  CHECK(run_gnuplot(where, "p.gp") == "");
  CHECK(text_of(where + "/p.png").starts_with("\x89PNG"));
  CHECK_FALSE(std::filesystem::exists(where + "/broken"));
}

TEST_CASE("labels of quantities have subscripts in both pictures, other labels stand as they are") {
  Drawing drawing{100, 50, {}};
  drawing.marks = {Label{{5, 5}, "stress σ_{xx} (mm^2, a\\_b) < u_y", 20, Label::Anchor::end, true},
                   Label{{5, 25}, "my_file_{x}", 12}};
  const std::string s = svg(drawing, FigureStyle());
  CHECK(
      s.find(
          ">stress σ<tspan dy=\"5.00\" font-size=\"14.00\">xx</tspan><tspan dy=\"-5.00\" font-size=\"20.00\"> (mm</tspan>"
          "<tspan dy=\"-5.00\" font-size=\"14.00\">2</tspan><tspan dy=\"5.00\" font-size=\"20.00\">, a_b) &lt; u</tspan>"
          "<tspan dy=\"5.00\" font-size=\"14.00\">y</tspan></text>") != std::string::npos);
  CHECK(s.find(">my_file_{x}</text>") != std::string::npos);
  const std::string script = gnuplot_script(drawing, "p", FigureStyle());
  CHECK(script.find("right front enhanced") != std::string::npos);
  CHECK(script.find("set label 'my_file_{x}' at 5.00,29.20 left front noenhanced") !=
        std::string::npos);
}

TEST_CASE(
    "a figure takes its columns by name, labels carry units, legends are the columns or what the user says") {
  const auto column = [](Quantity of, const char* at = nullptr) {
    ColumnChoice c;
    c.quantity = of;
    if (at) c.at = at;
    return c;
  };
  const std::vector<ColumnChoice> columns{column(quantity("u_ind")), column(quantity("u_y"), "A"),
                                          column(quantity("u_y"), "B"),
                                          column(quantity("u_x"), "A")};
  FigureChoice figure;
  figure.x = "u_ind", figure.y = {"u_y_A", "u_y_B"}, figure.title = "it's a title";
  const auto head = [](const std::string& name, const std::string& unit) {
    return name + "_" + unit;
  };
  Plot plot = plot_of(figure, columns, "curves.csv", head);
  CHECK(plot.x_label == "indenter travel (mm)");
  CHECK(plot.y_label == "displacement u_y (mm)");
  CHECK(plot.lines[1].y == "u_y_B_mm");
  CHECK(plot.lines[1].legend == "displacement u_y at B");
  figure.legends = {"A", "B"};
  figure.y_label = "swelling";
  plot = plot_of(figure, columns, "curves.csv", head);
  CHECK(plot.y_label == "swelling (mm)");
  CHECK(plot.lines[0].legend == "A");
  CHECK(complaints(figure, columns).empty());
  figure.y = {"u_y_A", "u_x_A"};
  figure.y_label.reset();
  CHECK(plot_of(figure, columns, "curves.csv", head).y_label == "mm");
  CHECK(plain("stress σ_{xx}") == "stress σ_xx");
}

TEST_CASE("a column whose error stands beside it has a band in its figure") {
  std::vector<ColumnChoice> columns(3);
  columns[0].quantity = quantity("u_ind"), columns[1].quantity = quantity("force");
  columns[2].history = "force_error", columns[2].name = "force_error";
  FigureChoice figure;
  figure.x = "u_ind", figure.y = {"force"};
  const Plot with = plot_of(figure, columns, "c.csv", csv_name);
  CHECK(with.lines.at(0).error == "force_error_N");
  CHECK(gnuplot_script(with, "f", FigureStyle())
            .find("(column('force_N')-column('force_error_N'))") != std::string::npos);
  columns.pop_back();
  const Plot without = plot_of(figure, columns, "c.csv", csv_name);
  CHECK(without.lines.at(0).error.empty());
  CHECK(gnuplot_script(without, "f", FigureStyle()).find("filledcurves") == std::string::npos);
}

TEST_CASE(
    "gnuplot draws a figure from a CSV file, its complaint is reported, and so is its absence") {
  const std::string where = folder("figure");
  write(where + "/curves.csv", "t,u_mm,force_N\n0,0,0\n1,0.5,2\n2,1,8\n");
  Plot plot{"Force `touch broken`",
            "u (mm)",
            "F (N)",
            {{"curves.csv", "u_mm", "force_N", "it's"}, {"curves.csv", "u_mm", "t", "t"}}};
  write(where + "/f.gp", gnuplot_script(plot, "f", FigureStyle()));
  if (has_gnuplot()) {
    CHECK(run_gnuplot(where, "f.gp") == "");
    CHECK(text_of(where + "/f.svg").find("</svg>") != std::string::npos);
    CHECK(text_of(where + "/f.png").starts_with("\x89PNG"));
    CHECK_FALSE(std::filesystem::exists(where + "/broken"));
    for (PlotLine& line : plot.lines) line.csv = "missing.csv";
    write(where + "/g.gp", gnuplot_script(plot, "g", FigureStyle()));
    const std::string complaint = run_gnuplot(where, "g.gp");
    INFO(complaint);
    CHECK(complaint.starts_with("gnuplot: "));
    CHECK(complaint.size() > 20);
  }
  const std::string path = std::getenv("PATH");
  setenv("PATH", where.c_str(), 1);
  const std::string said = run_gnuplot(where, "f.gp");
  setenv("PATH", path.c_str(), 1);
  CHECK(said == "there is no gnuplot on the PATH");
}

TEST_CASE(
    "names of files that gnuplot would take for a pipe, a stream or a block of data are names of files") {
  const std::string where = folder("names");
  for (const std::string name :
       {"<touch run #", "|touch run #", "-", "$data", "+", "--help", "'x"}) {
    CAPTURE(name);
    write(where + "/" + name + ".csv", "t,u_mm\n0,0\n1,0.5\n");
    write(where + "/" + name + ".gp",
          gnuplot_script(Plot{"", "t", "u", {{name + ".csv", "t", "u_mm", "u"}}}, name,
                         FigureStyle()));
    if (!has_gnuplot()) continue;
    CHECK(run_gnuplot(where, name + ".gp") == "");
    CHECK(text_of(where + "/" + name + ".svg").find("</svg>") != std::string::npos);
    CHECK(text_of(where + "/" + name + ".png").starts_with("\x89PNG"));
    for (const auto& file : std::filesystem::directory_iterator(where))
      CHECK_FALSE(file.path().filename().string().starts_with("run"));
  }
}

TEST_CASE(
    "a body without a field is drawn plain, with its points, the edges at rest and what holds and moves it") {
  const Mesh mesh = test::block(test::even(0, 3, 3), test::even(0, 2, 2), test::even(0, 1, 1));
  RenderScene scene{mesh, mesh.X, {}, "", {}};
  for (Vec3& x : scene.x) x[0] *= 1.5;
  RenderChoice choice;
  CHECK(choice.complaints().empty());
  const std::size_t plain_strokes = test::marks_of<Stroke>(render(scene, choice)).size();
  for (const Patch& patch : test::marks_of<Patch>(
           render(scene, choice))) {  // shades of one paper: no colour of the scale
    CHECK(patch.fill.r >= patch.fill.b);
    CHECK(patch.fill.r < 1.1 * patch.fill.b);
  }
  choice.outline = true;
  CHECK(test::marks_of<Stroke>(render(scene, choice)).size() ==
        plain_strokes + 4 * (3 + 2 + 1));  // the box's twelve edges, cell by cell
  scene.points = {{"B", scene.x.back()}};
  scene.actions = {{{Vec3(4.5, 1, 0.5)}, Vec3::UnitX(), true, "u_x = 1 mm"},
                   {{Vec3(0, 1, 0.5)}, Vec3::UnitX(), false, "u_x = 0"}};
  const Drawing drawing = render(scene, choice);
  std::map<std::string, PagePoint> labels;
  for (const Label& label : test::marks_of<Label>(drawing)) labels[label.text] = label.at;
  REQUIRE(labels.count("B"));
  REQUIRE(labels.count("u_x = 1 mm"));
  CHECK(labels.at("u_x = 1 mm")[0] > labels.at("u_x = 0")[0]);  // x goes to the right in this view
  CHECK(test::marks_of<Stroke>(drawing).size() == plain_strokes + 24 + 2);
}

TEST_CASE("no label of a map's axes stands on another, whatever the reach") {
  SurfaceMap map;
  map.places = {{-10, -10}, {10, -10}, {10, 10}, {-10, 10}};
  map.values = {0, 1, 2, 3};
  map.facets.push_back({0, 1, 2, 3});
  for (const double reach : {1.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.5, 10.0}) {
    MapStyle style;
    style.reach = reach;
    std::vector<Label> labels = test::marks_of<Label>(map_drawing({{"", &map}}, style));
    for (std::size_t i = 0; i < labels.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (labels[i].anchor == Label::Anchor::end &&
            labels[k].at[0] == labels[i].at[0]) {  // those of the z axis
          INFO(reach << " " << labels[i].text << " " << labels[k].text);
          CHECK(std::abs(labels[i].at[1] - labels[k].at[1]) >= 14);
        }
  }
}

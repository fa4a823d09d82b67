// Input files of Abaqus/CAE and Gmsh: parts and instances, included files, facets from sets, and
// cells that are numbered the other way round.
#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "core/base/error.hpp"
#include "mechanics/element/surface.hpp"
#include "mechanics/mesh/facets.hpp"
#include "mechanics/mesh/quality.hpp"
#include "mechanics/mesh/reference.hpp"
#include "mechanics/mesh/select.hpp"
#include "meshing/exchange.hpp"
#include "meshing/inp.hpp"
#include "support/block.hpp"

using namespace langer;

namespace inp_parts_tests {

namespace {

// A unit cube of one element, with its numbers in `order`.
std::string cube(const std::string& order = "1,2,3,4,5,6,7,8") {
  return "*Node\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
         "*Element, type=C3D8RH\n1," +
         order + "\n";
}

std::string part(const std::string& name, const std::string& more = "") {
  return "*Part, name=" + name + "\n" + cube() + more + "*End Part\n";
}

// Files of one folder that is nowhere on the disk.
using Folder = std::map<std::string, std::string>;

InpOpener opener(const Folder& folder) {
  return [folder](const std::string& from, const std::string& named) {
    const std::filesystem::path path =
        (std::filesystem::path(from).parent_path() / named).lexically_normal();
    const auto found = folder.find(path.string());
    if (found == folder.end()) return InpInclusion{path.string(), "", "there is no such file"};
    return InpInclusion{path.string(), found->second, ""};
  };
}

Mesh read(const std::string& text, std::vector<std::string>& notes, const Folder& folder = {}) {
  return parse_inp(text, "m.inp", notes, opener(folder));
}

Mesh read(const std::string& text, const Folder& folder = {}) {
  std::vector<std::string> notes;
  return read(text, notes, folder);
}

std::string refusal(const std::string& text, const Folder& folder = {}) {
  try {
    read(text, folder);
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    return failure.what();
  }
  return "read";
}

bool near(const Vec3& a, const Vec3& b) { return (a - b).norm() < 1e-12; }

Vec3 middle(const Mesh& mesh, const std::string& set) {
  Vec3 sum = Vec3::Zero();
  for (int n : mesh.node_sets.at(set)) sum += mesh.X[static_cast<std::size_t>(n)];
  return sum / static_cast<double>(mesh.node_sets.at(set).size());
}

double area(const Mesh& mesh, const std::string& set) {
  return nodal_areas(mesh, mesh.facet_sets.at(set)).sum();
}

const std::string set_and_surface =
    "*Nset, nset=Set-1, instance=PART-1-1\n1,2,3,4\n"
    "*Nset, nset=Set-2, instance=PART-1-1\n5,6,7,8\n"
    "*Elset, elset=_Surf-1_S2, internal, instance=PART-1-1\n1\n"
    "*Surface, type=ELEMENT, name=Surf-1\n_Surf-1_S2, S2\n";

}  // namespace

TEST_CASE("an instance is moved by its first line, its assembly's sets and surfaces move with it") {
  std::vector<std::string> notes;
  const Mesh mesh = read(part("PART-1") +
                             "*Assembly, name=Assembly\n*Instance, name=PART-1-1, part=PART-1\n"
                             " 0., 0., 5.\n*End Instance\n" +
                             set_and_surface + "*End Assembly\n",
                         notes);
  CHECK(notes.empty());
  REQUIRE(mesh.n_nodes() == 8);
  CHECK(near(mesh.X[0], Vec3(0, 0, 5)));
  CHECK(near(mesh.X[6], Vec3(1, 1, 6)));
  CHECK(near(middle(mesh, "Set-1"), Vec3(0.5, 0.5, 5)));
  CHECK(near(middle(mesh, "Set-2"), Vec3(0.5, 0.5, 6)));
  CHECK(near(middle(mesh, "Surf-1"), Vec3(0.5, 0.5, 6)));
  CHECK(mesh.bodies == std::vector<std::string>{""});
}

TEST_CASE("an instance is moved first and turned about the axis of its second line then") {
  // 90 degrees about the line through (1, 0, 0) along z: (x, y) -> (1 - y, x - 1)
  const std::string lines = " 2., 0., 5.\n 1., 0., 0., 1., 0., 3., 90.\n";
  const auto placed = [](const std::string& data) {
    return read(part("P") + "*Instance, name=I, part=P\n" + data + "*End Instance\n");
  };
  const Mesh mesh = placed(lines);
  const Mesh plain = placed("");
  for (std::size_t n = 0; n < 8; ++n) {
    const Vec3 moved = plain.X[n] + Vec3(2, 0, 5);
    CHECK(near(mesh.X[n], Vec3(1 - moved[1], moved[0] - 1, moved[2])));
  }
  CHECK(quality(mesh).least_jacobian > 0);
  // a rotation alone, and one back and forth
  const Mesh turned = placed("0, 0, 0,\n0, 0, 0, 0, 0, 1, 30\n");
  CHECK(near(turned.X[1], Vec3(std::sqrt(0.75), 0.5, 0)));
  CHECK(near(placed("0,0,0,0,0,-1,-30\n").X[1], turned.X[1]));
  // an oblique axis keeps what lies on it
  CHECK(near(placed("0,0,0\n0,0,0,1,1,1,77\n").X[6], Vec3(1, 1, 1)));
  CHECK(near(placed("0,0,0\n0,0,0,1,1,1,120\n").X[1], Vec3(0, 1, 0)));
}

TEST_CASE("several instances of a part are bodies of their own with qualified sets") {
  std::vector<std::string> notes;
  const std::string own =
      "*Nset, nset=base\n1,2,3,4\n*Surface, name=top\n1, S2\n*Elset, elset=skin\n1\n"
      "*Solid Section, elset=skin, material=m\n,\n";
  const Mesh mesh = read(part("P", own) +
                             "*Assembly, name=A\n*Instance, name=left, part=P\n*End Instance\n"
                             "*Instance, name=right, part=P\n3, 0, 0\n*End Instance\n"
                             "*Nset, nset=both\nleft.base, right.base\n"
                             "*Nset, nset=both\nRIGHT.7\n"
                             "*Nset, nset=one, instance=right\nbase\n"
                             "*Surface, name=tops\nleft.1, S2\nright.skin, S2\n*End Assembly\n",
                         notes);
  CHECK(mesh.n_cells() == 2);
  CHECK(mesh.n_nodes() == 16);
  CHECK(mesh.bodies == std::vector<std::string>{"left.skin", "right.skin"});
  CHECK(mesh.body == std::vector<int>{0, 1});
  CHECK(near(middle(mesh, "left.base"), Vec3(0.5, 0.5, 0)));
  CHECK(near(middle(mesh, "right.base"), Vec3(3.5, 0.5, 0)));
  CHECK(near(middle(mesh, "right.top"), Vec3(3.5, 0.5, 1)));
  CHECK(mesh.node_sets.at("both") == std::vector<int>{0, 1, 2, 3, 8, 9, 10, 11, 14});
  CHECK(mesh.node_sets.at("one") == mesh.node_sets.at("right.base"));
  CHECK(mesh.facet_sets.at("tops").size() == 2);
  CHECK_FALSE(mesh.node_sets.count("base"));
  CHECK(notes.empty());
  // names of different parts that no other has stay short; cells without a name are their instance
  const Mesh two =
      read(part("P", "*Nset, nset=base\n1,2,3,4\n") + part("Q", "*Nset, nset=top\n5,6,7,8\n") +
           "*Instance, name=p, part=P\n*End Instance\n"
           "*Instance, name=q, part=q\n0,0,1\n*End Instance\n");
  CHECK(two.bodies == std::vector<std::string>{"p", "q"});
  CHECK(near(middle(two, "base"), Vec3(0.5, 0.5, 0)));
  CHECK(near(middle(two, "top"), Vec3(0.5, 0.5, 2)));
}

TEST_CASE("parts without any instance lie as they are, one without among others is left out") {
  CHECK(read(part("P")).n_cells() == 1);
  CHECK(read(part("P") + part("Q")).bodies == std::vector<std::string>{"P", "Q"});
  std::vector<std::string> notes;
  const Mesh mesh =
      read(part("P") + part("Q") + "*Instance, name=i, part=Q\n*End Instance\n", notes);
  CHECK(mesh.n_cells() == 1);
  CHECK(notes ==
        std::vector<std::string>{"left out, as they are no mesh: part P without an instance"});
}

TEST_CASE("an instance with a mesh of its own is moved too") {
  const Mesh mesh = read("*Part, name=P\n*End Part\n*Instance, name=i, part=P\n0, 0, 5\n" + cube() +
                         "*Nset, nset=n\n1\n*End Instance\n*Nset, nset=m\ni.n\n");
  CHECK(near(mesh.X[0], Vec3(0, 0, 5)));
  CHECK(mesh.node_sets.at("m") == std::vector<int>{0});
}

TEST_CASE("what is wrong with an instance is refused at its line") {
  const std::string p = part("P");  // 13 lines
  const auto at = [&](const std::string& more) {
    return refusal(p + more);
  };
  CHECK(at("*Instance, name=i, part=Q\n").starts_with("m.inp:14:1: there is no *PART \"Q\" above"));
  CHECK(at("*Instance, part=P\n").starts_with("m.inp:14:1: *INSTANCE without a name"));
  CHECK(at("*Instance, name=i, part=P\n*End Instance\n*Instance, name=I, part=P\n")
            .starts_with("m.inp:16:1: found a second *INSTANCE of the name \"I\""));
  CHECK(at("*Instance, name=i, part=P\n1, 2, 3, 4\n")
            .starts_with("m.inp:15:1: found 4 numbers below *INSTANCE"));
  CHECK(at("*Instance, name=i, part=P\n1, 2, 3\n1, 2, 3\n")
            .starts_with("m.inp:16:1: found a further line below *INSTANCE"));
  CHECK(at("*Instance, name=i, part=P\n0,0,0\n1, 2, 3, 1, 2, 3, 90\n")
            .starts_with("m.inp:16:1: found an axis of rotation through one point"));
  CHECK(at("*Instance, name=i, part=P\n0,zero,0\n").starts_with("m.inp:15:1: found \"zero\""));
  CHECK(at("*Part, name=p\n").starts_with("m.inp:14:1: found a second *PART of the name \"p\""));
  CHECK(at("*Instance, name=i, part=P\n*End Instance\n*Nset, nset=n, instance=j\n1\n")
            .starts_with("m.inp:17:1: there is no *INSTANCE \"j\" above"));
  CHECK(at("*Instance, name=i, part=P\n*End Instance\n*Nset, nset=n\ni.m\n")
            .starts_with("m.inp:17:1: there is no set \"i.m\" above"));
  CHECK(at("*Instance, name=i, part=P\n*End Instance\n*Surface, name=s\ni.2, S1\n")
            .starts_with("m.inp:17:1: there is no element 2"));
}

TEST_CASE("a small file cannot ask for endless memory by its instances") {
  std::string text = "*Part, name=P\n*Node, nset=n\n";
  for (int n = 0; n < 5000; ++n) text += fmt::format("{},{},0,0\n", n, n);
  text += "*End Part\n";
  for (int i = 0; i < 5000; ++i) text += fmt::format("*Instance, name=i{}, part=P\n", i);
  CHECK(refusal(text).find("all instances together have too many nodes and elements") !=
        std::string::npos);
}

TEST_CASE("an included file stands in the place of its card") {
  const std::string nodes = cube().substr(0, cube().find("*Element"));
  const std::string elements = cube().substr(nodes.size());
  const auto check = [](const Mesh& mesh) {
    CHECK(mesh.n_cells() == 1);
    CHECK(std::abs(quality(mesh).volume - 1) < 1e-14);
  };
  check(read("*INCLUDE, INPUT=n.inc\n" + elements, {{"n.inc", nodes}}));
  check(read(nodes + "*Include,\n input = \"my elements.txt\"\n*Nset, nset=a\n1\n",
             {{"my elements.txt", elements}}));
  // data lines alone, in a folder, and files that include others beside them
  check(read("*Node\n*INCLUDE, INPUT=sub/n.inc\n*INCLUDE, INPUT=sub/e.inc\n",
             {{"sub/n.inc", nodes.substr(nodes.find('\n') + 1)},
              {"sub/e.inc", "*INCLUDE, INPUT=deeper/e.inc\n"},
              {"sub/deeper/e.inc", elements}}));
  // materials alone are noted as left out
  std::vector<std::string> notes;
  check(read("*INCLUDE, INPUT=m.inc\n" + cube(), notes,
             {{"m.inc",
               "*MATERIAL, NAME=m\n*HYPERELASTIC, NEO HOOKE\n0.05, 0.01\n*ORIENTATION, "
               "NAME=o\n1, 0, 0, 0, 1, 0\n"}}));
  CHECK(notes == std::vector<std::string>{
                     "left out, as they are no mesh: *HYPERELASTIC, *MATERIAL, *ORIENTATION"});
}

namespace {

// Axes 1, 2, 3 of the orientation of the first element. Angles run from e_x = 1 to e_z = 2.
Mat3 axes(const Mesh& mesh) {
  REQUIRE(!mesh.frames.empty());
  const Mat3& frame = mesh.frames[0];
  CHECK(std::abs(frame.determinant() - 1) < 1e-12);
  Mat3 axes;
  axes << frame.col(0), frame.col(2), -frame.col(1);
  return axes;
}

std::string oriented(const std::string& parameters, const std::string& lines) {
  return cube() + "*Elset, elset=all\n1\n*Orientation, name=o" + parameters + "\n" + lines +
         "*Solid Section, elset=all, material=m, orientation=O\n1.,\n";
}

}  // namespace

TEST_CASE("an *ORIENTATION of a section gives its elements a frame") {
  std::vector<std::string> notes;
  CHECK(axes(read(oriented("", "1, 0, 0, 0, 1, 0\n"), notes)).isApprox(Mat3::Identity(), 1e-14));
  CHECK(notes ==
        std::vector<std::string>{
            "1 of 1 elements have an *ORIENTATION, in which `frames: file` measures angles"});
  // b only needs to be in the plane of axes 1 and 2, and c is the origin of both
  Mat3 expected;
  expected << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  CHECK(
      axes(read(oriented(", system=rectangular", "0, 3, 0, 0, 7, 2\n"))).isApprox(expected, 1e-14));
  CHECK(axes(read(oriented("", "5, 9, 5, 5, 13, 7, 5, 6, 5\n"))).isApprox(expected, 1e-14));
  // a further rotation: by 90 degrees about axis 3, 1 becomes what 2 was
  const Mat3 turned = axes(read(oriented("", "1, 0, 0, 0, 1, 0\n3, 90.\n")));
  CHECK(near(turned.col(0), Vec3::UnitY()));
  CHECK(near(turned.col(1), -Vec3::UnitX()));
  CHECK(near(turned.col(2), Vec3::UnitZ()));
  // around an axis: outwards, around, along; the middle of the cube is seen from (2, 0.5)
  const Mat3 around = axes(read(oriented(", SYSTEM=CYLINDRICAL", "2, 0.5, 0, 2, 0.5, 4\n")));
  CHECK(near(around.col(0), -Vec3::UnitX()));
  CHECK(near(around.col(1), -Vec3::UnitY()));
  CHECK(near(around.col(2), Vec3::UnitZ()));
  // directions of fibres below belong to a material
  CHECK(axes(read(oriented(", LOCAL DIRECTIONS=1", "1, 0, 0, 0, 1, 0\n1, 0\n0.7, 0.7, 0\n")))
            .isApprox(Mat3::Identity(), 1e-14));
}

TEST_CASE("an *ORIENTATION of a part turns with its instances") {
  const std::string more =
      "*Elset, elset=all\n1\n*Orientation, name=o\n1, 0, 0, 0, 1, 0\n"
      "*Solid Section, elset=all, orientation=o\n";
  const Mesh mesh = read(part("P", more) +
                         "*Instance, name=I, part=P\n3, 0, 0\n0, 0, 0, 0, 0, 1, 90\n*End Instance\n"
                         "*Instance, name=J, part=P\n9, 0, 0\n*End Instance\n");
  REQUIRE(mesh.frames.size() == 2);
  CHECK(near(mesh.frames[0].col(0), Vec3::UnitY()));
  CHECK(near(mesh.frames[0].col(2), -Vec3::UnitX()));
  CHECK(near(mesh.frames[1].col(0), Vec3::UnitX()));
  CHECK(near(mesh.frames[1].col(2), Vec3::UnitY()));
}

TEST_CASE("an *ORIENTATION that is not understood is left out with the reason") {
  const auto note = [](const std::string& text) {
    std::vector<std::string> notes;
    const Mesh mesh = read(text, notes);
    CHECK(mesh.frames.empty());
    REQUIRE(notes.size() == 1);
    return notes[0];
  };
  CHECK(note(oriented(", system=spherical", "0, 0, 0, 0, 0, 1\n")) ==
        "left out: *ORIENTATION o, SYSTEM=SPHERICAL");
  CHECK(note(oriented(", definition=nodes", "1, 2, 3\n")) ==
        "left out: *ORIENTATION o, DEFINITION=NODES");
  CHECK(note(oriented("", "dist-1\n1, 0.\n")) ==
        "left out: *ORIENTATION o, found \"dist-1\" in line 15");
  CHECK(note(oriented("", "1, 0, 0\n")) == "left out: *ORIENTATION o, 3 numbers in line 15");
  CHECK(note(oriented("", "1, 0, 0, 0, 1, 0\n4, 30\n")) ==
        "left out: *ORIENTATION o, rotation about axis 4 in line 16");
  for (const std::string points :
       {"1, 0, 0, 2, 0, 0\n", "0, 0, 0, 0, 1, 0\n", "0, 0, 0, 0, 0, 0\n", "",
        "1e300, 0, 0, 0, 1e300, 0, 1e300, 0, 0\n", "1e200, 0, 0, 0, 1e200, nan\n"}) {
    CAPTURE(points);
    CHECK(note(oriented("", points)).starts_with("left out: *ORIENTATION o, "));
  }
  CHECK(note(oriented(", system=cylindrical", "0.5, 0.5, 0, 0.5, 0.5, 1\n")) ==
        "left out: *ORIENTATION o, whose points give no directions");
  CHECK(note(cube() + "*Elset, elset=all\n1\n*Solid Section, elset=all, orientation=other\n") ==
        "left out: there is no *ORIENTATION other");
}

TEST_CASE("a fault in an included file has its line there") {
  CHECK(refusal("*INCLUDE, INPUT=n.inc\n", {{"n.inc", "*NODE\n1, 0, zero, 0\n"}})
            .starts_with("n.inc:2:1: found \"zero\"; expected a number"));
  CHECK(refusal("** \n*INCLUDE, INPUT=n.inc\n")
            .starts_with("m.inp:2:1: *INCLUDE of \"n.inc\": there is no such file"));
  CHECK(refusal("*INCLUDE\n").starts_with("m.inp:1:1: *INCLUDE without a file"));
  CHECK(refusal("*INCLUDE, INPUT=a\n", {{"a", "\n*INCLUDE, INPUT=b\n"}, {"b", "*INCLUDE, INPUT=a"}})
            .starts_with("b:1:1: *INCLUDE of \"a\", which includes this file"));
  CHECK(refusal("*INCLUDE, INPUT=m.inp\n", {{"m.inp", ""}})
            .starts_with("m.inp:1:1: *INCLUDE of \"m.inp\", which includes this file"));
  Folder chain;
  for (int i = 0; i < 30; ++i)
    chain[fmt::format("f{}", i)] = fmt::format("*INCLUDE, INPUT=f{}", i + 1);
  CHECK(
      refusal("*INCLUDE, INPUT=f0\n", chain).starts_with("f15:1:1: found *INCLUDE 17 files deep"));
  // 10 files in each of 8 levels would be 10^8 files
  Folder tree;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 10; ++k)
      tree[fmt::format("f{}", i)] += fmt::format("*INCLUDE, INPUT=f{}\n", i + 1);
  }
  tree["f8"] = "";
  CHECK(refusal("*INCLUDE, INPUT=f0\n", tree).find("found more than 1000 *INCLUDE") !=
        std::string::npos);
}

TEST_CASE("included files are plain files in the folder of the main file") {
  namespace fs = std::filesystem;
  const fs::path base = fs::path(BINARY_DIR) / "test_files" / "inclusion";
  fs::remove_all(base);
  fs::create_directories(base / "model" / "sub");
  const auto write = [](const fs::path& path, const std::string& text) {
    std::ofstream(path) << text;
  };
  const fs::path main = base / "model" / "main.inp";
  write(base / "model" / "sub" / "cube.inc", cube());
  write(base / "outside.inc", cube());
  fs::create_symlink(base / "outside.inc", base / "model" / "link.inc");
  fs::create_symlink(base, base / "model" / "up");
  const auto outcome = [&](const std::string& named) -> std::string {
    write(main, "*INCLUDE, INPUT=" + named + "\n");
    try {
      std::vector<std::string> notes;
      const Mesh mesh = read_inp(main.string(), notes);
      CHECK(mesh.n_cells() == 1);
      const std::vector<std::string> files = included_inp_files(main.string());
      REQUIRE(files.size() == 1);
      CHECK(fs::equivalent(files[0], base / "model" / "sub" / "cube.inc"));
      return "read";
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::input);
      return failure.what();
    }
  };
  CHECK(outcome("sub/cube.inc") == "read");
  CHECK(outcome("./sub/../sub/cube.inc") == "read");
  CHECK(outcome("../model/sub/cube.inc") == "read");
  for (const std::string named : {"../outside.inc", "link.inc", "up/outside.inc", "/etc/passwd"}) {
    CAPTURE(named);
    CHECK(outcome(named).starts_with(main.string() + ":1:1: *INCLUDE of \"" + named +
                                     "\": is not in the folder of the main file"));
  }
  CHECK(outcome("sub").find("\"sub\": is no plain file") != std::string::npos);
  CHECK(outcome("nothing").find("\"nothing\": there is no such file") != std::string::npos);
}

TEST_CASE("cells that are numbered the other way round are turned, with their sides") {
  std::vector<std::string> notes;
  const Mesh mesh =
      read(cube("5,6,7,8,1,2,3,4") + "*Surface, name=s\n1, S1\n*Surface, name=t\n1, S3\n", notes);
  CHECK(std::abs(quality(mesh).volume - 1) < 1e-14);
  CHECK(quality(mesh).least_jacobian > 0);
  CHECK(notes == std::vector<std::string>{
                     "the nodes of 1 of 1 elements are numbered the other way round (first: "
                     "element 1, m.inp:11): they are read as their mirror image"});
  // S1 has the first four nodes of the file, here those at z = 1; S3 the 1st, 2nd, 5th and 6th
  CHECK(near(middle(mesh, "s"), Vec3(0.5, 0.5, 1)));
  CHECK(near(middle(mesh, "t"), Vec3(0.5, 0, 0.5)));
}

// A block in the file's order, of which some cells are mirrored: the result is the block itself.
TEST_CASE("of cells of every kind some or all may be numbered the other way round") {
  const Mesh linear = test::block({0, 1, 2.5}, {0, 0.8, 2}, {-1, 0.2, 1});
  struct Kind {
    const char* type;
    Mesh mesh;
    std::vector<int> mirrored;  // the file's nodes of a cell, numbered the other way round
  };
  const Kind kinds[] = {
      {"C3D8", linear, {4, 5, 6, 7, 0, 1, 2, 3}},
      {"C3D20", raised(linear, CellType::hex27), {4,  5,  6, 7, 0,  1,  2,  3,  12, 13,
                                                  14, 15, 8, 9, 10, 11, 16, 17, 18, 19}},
      {"C3D4", test::tetrahedra(linear), {0, 2, 1, 3}},
      {"C3D10", test::tetrahedra(linear), {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}},
  };
  for (const Kind& kind : kinds) {
    CAPTURE(kind.type);
    const std::size_t n = kind.mirrored.size();
    for (const int every : {1, 2, 3}) {
      std::string text = "*NODE\n";
      for (int i = 0; i < kind.mesh.n_nodes(); ++i) {
        const Vec3& x = kind.mesh.X[static_cast<std::size_t>(i)];
        text += fmt::format("{}, {}, {}, {}\n", i + 1, x[0], x[1], x[2]);
      }
      text += fmt::format("*ELEMENT, TYPE={}\n", kind.type);
      for (int e = 0; e < kind.mesh.n_cells(); ++e) {
        text += std::to_string(e + 1);
        for (std::size_t a = 0; a < n; ++a) {
          const int local = e % every == 0 ? kind.mirrored[a] : static_cast<int>(a);
          text += fmt::format(",{} {}", a == 10 ? "\n" : "",
                              kind.mesh.cell(e)[static_cast<std::size_t>(local)] + 1);
        }
        text += "\n";
      }
      const ReferenceCell& cell = kind.mesh.cell();
      for (int side = 1; side <= cell.n_facets(); ++side) {
        text += fmt::format("*SURFACE, NAME=s{}\n1, S{}\n", side, side);
      }
      std::vector<std::string> notes;
      const Mesh found = read(text, notes);
      REQUIRE(notes.size() == 1);
      const int turned = (kind.mesh.n_cells() + every - 1) / every;
      CHECK(notes[0].starts_with(
          fmt::format("the nodes of {} of {} elements are numbered", turned, kind.mesh.n_cells())));
      CHECK(quality(found).least_jacobian > 0);
      CHECK(std::abs(quality(found).volume - quality(kind.mesh).volume) < 1e-12);
      CHECK(boundary(found).size() == boundary(kind.mesh).size());
      // The sides of the mirrored first element are those of its numbers in the file.
      const std::vector<std::vector<int>> corners =
          cell.hexahedron()
              ? std::vector<std::vector<int>>{{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                              {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}
              : std::vector<std::vector<int>>{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
      for (std::size_t side = 0; side < corners.size(); ++side) {
        Vec3 expected = Vec3::Zero();
        for (int a : corners[side]) {
          const int node = kind.mesh.cell(
              0)[static_cast<std::size_t>(kind.mirrored[static_cast<std::size_t>(a)])];
          expected += kind.mesh.X[static_cast<std::size_t>(node)];
        }
        expected /= static_cast<double>(corners[side].size());
        const Facet facet = found.facet_sets.at(fmt::format("s{}", side + 1)).at(0);
        Vec3 there = Vec3::Zero();
        const std::vector<int> nodes = facet_nodes(found, facet);
        for (std::size_t k = 0; k < corners[side].size(); ++k) {
          there += found.X[static_cast<std::size_t>(nodes[k])];
        }
        CHECK(near(there / static_cast<double>(corners[side].size()), expected));
      }
    }
  }
}

TEST_CASE("an element that is folded in truth is refused with its number and line") {
  const std::string expected = "m.inp:11:1: element 1 is folded: its Jacobian is ";
  CHECK(refusal(cube("1,2,4,3,5,6,7,8")).starts_with(expected));
  CHECK(refusal(cube("1,3,2,4,5,7,6,8")).starts_with(expected));
  CHECK(refusal(cube("1,1,1,1,5,5,5,5")).starts_with(expected));
}

TEST_CASE("facets of the surface whose nodes are all in a node set are a facet set of its name") {
  const Mesh block = test::block(test::even(0, 3, 3), test::even(0, 2, 2), test::even(-1, 1, 2));
  Mesh plain = block;
  plain.bodies = {"skin"};
  plain.body.assign(static_cast<std::size_t>(plain.n_cells()), 0);
  name_sides(plain);
  const auto areas = plain.facet_sets;
  plain.facet_sets.clear();
  plain.node_sets["line"] = {0, 1, 2, 3};
  plain.node_sets["corner"] = {0};
  for (int n = 0; n < plain.n_nodes(); ++n) plain.node_sets["all"].push_back(n);
  const std::string text = inp_text(plain);
  const Mesh mesh = read(text);
  for (const char* side : {"x_min", "x_max", "y_min", "top", "z_min", "z_max"}) {
    CAPTURE(side);
    CHECK(mesh.facet_sets.at(side).size() == areas.at(side).size());
    CHECK(std::abs(area(mesh, side) - nodal_areas(block, areas.at(side)).sum()) < 1e-12);
  }
  CHECK(mesh.facet_sets.at("all").size() == boundary(block).size());
  CHECK_FALSE(mesh.facet_sets.count("line"));
  CHECK_FALSE(mesh.facet_sets.count("corner"));
  // a surface of the same name comes first
  const Mesh with_surface = read(text + "*SURFACE, NAME=top\n1, S1\n");
  CHECK(with_surface.facet_sets.at("top").size() == 1);
}

namespace {

// What Gmsh writes of a bar of two hexahedra: each surface and volume is an element set, physical
// groups are further element sets and, where asked for, node sets.
std::string of_gmsh(const std::string& groups) {
  return "*Heading\n bar.inp\n*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,0,1,0\n5,1,1,0\n6,2,1,0\n"
         "7,0,0,1\n8,1,0,1\n9,2,0,1\n10,0,1,1\n11,1,1,1\n12,2,1,1\n"
         "******* E L E M E N T S *************\n"
         "*ELEMENT, type=CPS4, ELSET=Surface1\n1, 1, 7, 10, 4\n"
         "*ELEMENT, type=CPS4, ELSET=Surface2\n2, 3, 6, 12, 9\n"
         "*ELEMENT, type=CPS4, ELSET=Surface3\n3, 7, 8, 11, 10\n4, 8, 9, 12, 11\n"
         "*ELEMENT, type=C3D8, ELSET=Volume1\n5, 1,2,5,4,7,8,11,10\n"
         "*ELEMENT, type=C3D8, ELSET=Volume2\n6, 2,3,6,5,8,9,12,11\n" +
         groups;
}

}  // namespace

TEST_CASE("physical groups of Gmsh's own .inp are facet sets and bodies") {
  std::vector<std::string> notes;
  const Mesh mesh = read(of_gmsh("*ELSET,ELSET=left\n1\n*ELSET,ELSET=ends\n1, 2\n"
                                 "*ELSET,ELSET=upper\n3, 4\n*ELSET,ELSET=bone\n5\n"
                                 "*ELSET,ELSET=skin\n6\n*NSET,NSET=left\n1, 4, 7, 10\n"),
                         notes);
  CHECK(notes.empty());
  CHECK(mesh.n_cells() == 2);
  CHECK(mesh.bodies == std::vector<std::string>{"bone", "skin"});
  CHECK(mesh.body == std::vector<int>{0, 1});
  CHECK(std::abs(area(mesh, "left") - 1) < 1e-14);
  CHECK(std::abs(area(mesh, "ends") - 2) < 1e-14);
  CHECK(std::abs(area(mesh, "upper") - 2) < 1e-14);
  CHECK(std::abs(area(mesh, "Surface3") - 2) < 1e-14);
  CHECK(near(middle(mesh, "left"), Vec3(0, 0.5, 0.5)));
  CHECK(near(middle(mesh, "upper"), Vec3(1, 0.5, 1)));
}

TEST_CASE("volumes of Gmsh keep its names where its groups do not divide the body") {
  const std::string volumes[] = {"Volume1", "Volume2"};
  for (const std::string groups :
       {"", "*ELSET,ELSET=bone\n5\n", "*ELSET,ELSET=a\n5,6\n*ELSET,ELSET=b\n6\n"}) {
    CAPTURE(groups);
    const Mesh mesh = read(of_gmsh(groups));
    CHECK(mesh.bodies == std::vector<std::string>(volumes, volumes + 2));
  }
  CHECK(read(of_gmsh("*ELSET,ELSET=both\n5,6\n")).bodies == std::vector<std::string>{"both"});
  // a face that is no facet of a cell: its set is left out, by name
  std::vector<std::string> notes;
  const Mesh mesh = read(of_gmsh("*ELEMENT, type=CPS4, ELSET=lost\n7, 1, 3, 12, 10\n"), notes);
  CHECK_FALSE(mesh.facet_sets.count("lost"));
  REQUIRE(notes.size() >= 1);
  CHECK(notes[0] ==
        "left out: element set lost, as 1 of its plane elements are on no facet of a cell");
}

TEST_CASE("shells on the surface mark its facets, and that their stiffness is lost is said") {
  std::vector<std::string> notes;
  const Mesh mesh = read(cube() + "*Element, type=S4R, elset=membrane\n9, 5, 6, 7, 8\n", notes);
  CHECK(std::abs(area(mesh, "membrane") - 1) < 1e-14);
  CHECK(notes == std::vector<std::string>{"left out, as they are no mesh: elements S4R"});
}

namespace {

// The one note of a cube with this *HYPERELASTIC and its data lines.
std::string note_of_material(const std::string& parameters, const std::string& data) {
  std::vector<std::string> notes;
  read(cube() + "*Elset, elset=all\n1\n*Solid section, elset=all, material=M\n" +
           "*Material, name=m\n*Hyperelastic" + parameters + "\n" + data,
       notes);
  REQUIRE(notes.size() == 1);
  return notes.front();
}

std::string keys_of_material(const std::string& parameters, const std::string& data) {
  const std::string note = note_of_material(parameters, data);
  const std::string before =
      "the material M of all for a solve config, with the numbers of the file: material: ";
  CAPTURE(note);
  REQUIRE(note.starts_with(before));
  return note.substr(before.size());
}

}  // namespace

TEST_CASE("hyperelastic materials of an .inp are text for a solve config") {
  const auto check = [](const std::string& parameters, const std::string& data,
                        const std::string& matrix, const std::string& volume) {
    CHECK(keys_of_material(parameters, data) ==
          "{matrix: {" + matrix + "}, volume: {" + volume + "}}");
  };
  check(", NEO HOOKE", "0.05, 0.01\n", "neo_hooke: {a1: 0.05}", "quadratic: {d: 0.01}");
  check(", NEO HOOKE, moduli=long term", "0.05, 0.01\n", "neo_hooke: {a1: 0.05}",
        "quadratic: {d: 0.01}");
  check(", neo hooke", "0.05, 0.01, 37.\n", "neo_hooke: {a1: 0.05}", "quadratic: {d: 0.01}");
  check(", YEOH", "0.05, 0.02, -1e-3, 0.01, 0., 0.\n", "yeoh: {a1: 0.05, a2: 0.02, a3: -0.001}",
        "quadratic: {d: 0.01}");
  check(", MOONEY-RIVLIN", "0.05, 0.01, 0.5,\n", "mooney_rivlin: {c10: 0.05, c01: 0.01}",
        "quadratic: {d: 0.5}");
  check(", N=2, REDUCED POLYNOMIAL", "1, 2, 0.5, 0\n", "yeoh: {a1: 1, a2: 2, a3: 0}",
        "quadratic: {d: 0.5}");
  check("", "0.05, 0.01, 0.5\n", "mooney_rivlin: {c10: 0.05, c01: 0.01}", "quadratic: {d: 0.5}");
  check(", POLYNOMIAL, N=2", "1, 2, 3, 0, 5, 0.5, 0\n",
        "yeoh: {a1: 1, a2: 3, a3: 0}, yeoh_I2: {b1: 2, b2: 5, b3: 0}", "quadratic: {d: 0.5}");
  // the twelve numbers of N = 3 stand in two lines
  check(", N=3", "1, 2, 3, 0, 5, 6, 0, 0\n9, 0.5, 0, 0\n",
        "yeoh: {a1: 1, a2: 3, a3: 6}, yeoh_I2: {b1: 2, b2: 5, b3: 9}", "quadratic: {d: 0.5}");
  // and what the first of them leaves out at its end is 0
  check(", N=3", "1, 2, 3, 0, 5, 6\n9, 0.5\n",
        "yeoh: {a1: 1, a2: 3, a3: 6}, yeoh_I2: {b1: 2, b2: 5, b3: 9}", "quadratic: {d: 0.5}");
  check(", OGDEN, N=2", "0.05, 10, 0.02, -4, 0.5\n",
        "ogden: {mu1: 0.01, alpha1: 10, mu2: -0.01, alpha2: -4}", "quadratic: {d: 0.5}");
  check(", ARRUDA-BOYCE", "0.05, 1.3, 0.5\n", "arruda_boyce: {mu: 0.05, locking_stretch: 1.3}",
        "simo_taylor: {d: 0.5}");
  // without D1, d follows from the shear modulus 2 C10
  CHECK(keys_of_material(", NEO HOOKE", "0.05\n") ==
        "{matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.02}}}; D1 is 0, "
        "incompressible: d makes the bulk modulus 1000 times the shear modulus");
}

TEST_CASE(
    "hyperelastic materials of an .inp that have no counterpart are left out with the reason") {
  const auto check = [](const std::string& parameters, const std::string& data,
                        const std::string& why) {
    CHECK(note_of_material(parameters, data) == "left out: the material M of all: " + why);
  };
  check(", MARLOW", "1, 2\n", "*HYPERELASTIC, MARLOW");
  check(", YEOH, TEST DATA INPUT", "", "*HYPERELASTIC, TEST DATA INPUT");
  check(", NEO HOOKE, MODULI=INSTANTANEOUS", "1, 2\n", "*HYPERELASTIC, MODULI=INSTANTANEOUS");
  check(", OGDEN, N=4", "1, 2\n", "N=4, more than 3 terms");
  check(", OGDEN, N=two", "1, 2\n", "N=two, more than 3 terms");
  check(", OGDEN", "1, 0, 0.5\n", "alpha is 0");
  check(", N=2", "1, 2, 3, 4, 5, 0.5, 0\n", "a product of both invariants is not 0");
  check(", YEOH", "1, 2, 3, 0.5, 0.25, 0\n", "D2 is not 0");
  check(", YEOH", "1, 2\n", "*HYPERELASTIC has 2 numbers instead of 6");
  check(", NEO HOOKE", "", "*HYPERELASTIC has 0 numbers instead of 2");
  check(", NEO HOOKE", "0.05, 0.01, 20\n0.04, 0.01, 40\n",
        "*HYPERELASTIC depends on temperature or a field");
  check(", NEO HOOKE", "0.05\n0.04\n", "*HYPERELASTIC depends on temperature or a field");
  check(", NEO HOOKE", "0.05, -0.01\n", "D1 is negative");
  check(", NEO HOOKE", "-0.05, 0\n", "D1 is 0 and there is no shear modulus at rest");
  check(", NEO HOOKE", "a, 0.01\n", "found \"a, 0.01\" in line 17");
}

TEST_CASE("each instance of a part has its material, under the name of its body") {
  std::vector<std::string> notes;
  const Mesh mesh =
      read(part("P", "*Elset, elset=s\n1\n*Solid section, elset=s, material=m\n") +
               "*Assembly, name=A\n*Instance, name=a, part=P\n*End instance\n"
               "*Instance, name=b, part=P\n5, 0, 0\n*End instance\n*End assembly\n"
               "*Material, name=m\n*Density\n1e-9\n*Hyperelastic, neo hooke\n0.05, 0.01\n"
               "*Material, name=unused\n*Elastic\n1, 0.3\n",
           notes);
  const std::string keys =
      "{material: {matrix: {neo_hooke: {a1: 0.05}}, volume: {quadratic: {d: 0.01}}}}";
  CHECK(mesh.bodies == std::vector<std::string>{"a.s", "b.s"});
  CHECK(notes ==
        std::vector<std::string>{
            "the material m of a_s for a solve config, with the numbers of the file: materials: "
            "{a_s: " +
                keys + "}",
            "the material m of b_s for a solve config, with the numbers of the file: materials: "
            "{b_s: " +
                keys + "}",
            "left out, as they are no mesh: *DENSITY, *ELASTIC, *MATERIAL"});
}

}  // namespace inp_parts_tests

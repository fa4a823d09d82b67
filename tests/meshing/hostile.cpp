// Mesh files of strangers: each is refused quickly, with its line where it is a text, and nothing
// of it is executed or written.
#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "core/base/traps.hpp"
#include "meshing/exchange.hpp"
#include "meshing/gmsh/gmsh_session.hpp"
#include "support/block.hpp"

using namespace langer;

namespace {

namespace fs = std::filesystem;

// One for each process: test cases run at the same time.
fs::path fresh_folder(const std::string& name) {
  const std::string own = name + "_" + std::to_string(getpid());
  const fs::path path = fs::path(BINARY_DIR) / "test_files" / "hostile_meshes" / own;
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    files.insert(entry.path().string());
  return files;
}

// The message of a refusal; checks that it came quickly and that no file came or went.
std::string refusal(const fs::path& path, const std::function<void()>& read) {
  const std::set<std::string> before = files_in(path.parent_path());
  const auto start = std::chrono::steady_clock::now();
  std::string message = "read without a word";
  try {
    read();
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    message = failure.what();
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  CHECK(files_in(path.parent_path()) == before);
  return message;
}

std::string refusal_of_msh(const std::string& name, const std::string& bytes) {
  const fs::path path = fresh_folder(name) / "mail.msh";
  std::ofstream(path, std::ios::binary) << bytes;
  std::vector<std::string> notes;
  std::string message = refusal(path, [&] { read_msh(path.string(), notes); });
  // the place first: the folder's name is of no interest
  const std::string begin = path.parent_path().string() + "/";
  CHECK(message.starts_with(begin));
  return message.substr(begin.size());
}

template <class Value>
std::string raw(Value value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  return std::string(bytes, sizeof value);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

// a script that leaves a file if anybody runs it
std::string script(const fs::path& folder) {
  const std::string file = (folder / "ran").string();
  return "SystemCall \"touch " + file + "\";\nPrintf(\"x\") > \"" + file + "\";\n";
}

const std::string format = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";
const std::string nodes =
    "$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n" + corners + "$EndNodes\n";
const std::string elements = "$Elements\n1 1 1 1\n3 1 5 1\n1 1 2 3 4 5 6 7 8\n$EndElements\n";

const std::string format_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string nodes_2 =
    "$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n$EndNodes\n";
const std::string elements_2 = "$Elements\n1\n1 5 2 1 1 1 2 3 4 5 6 7 8\n$EndElements\n";

const std::string binary_2 = "$MeshFormat\n2.2 1 8\n" + raw(1) + "\n$EndMeshFormat\n";
const std::string binary_4 = "$MeshFormat\n4.1 1 8\n" + raw(1) + "\n$EndMeshFormat\n";

}  // namespace

TEST_CASE("the cubes that the hostile files are made from are read") {
  const fs::path folder = fresh_folder("cubes");
  std::vector<std::string> notes;
  std::ofstream(folder / "4.msh") << format + nodes + elements;
  CHECK(read_msh((folder / "4.msh").string(), notes).n_cells() == 1);
  std::ofstream(folder / "2.msh") << format_2 + nodes_2 + elements_2;
  const Mesh mesh = read_msh((folder / "2.msh").string(), notes);
  CHECK(mesh.bodies == std::vector<std::string>{"volume_1"});
  // lines of Windows
  std::string windows;
  for (const char c : format + nodes + elements) {
    if (c == '\n') windows += '\r';
    windows += c;
  }
  std::ofstream(folder / "windows.msh", std::ios::binary) << windows;
  CHECK(read_msh((folder / "windows.msh").string(), notes).n_cells() == 1);
}

TEST_CASE("a script in the clothes of a mesh is refused, not run") {
  const fs::path folder = fresh_folder("scripts");
  const std::string run = script(folder);
  const std::string no_section =
      "mail.msh:1:1: this is no section of a mesh of Gmsh; expected $MeshFormat";
  CHECK(refusal_of_msh("comment", "// looks like nothing\n" + run).starts_with(no_section));
  CHECK(refusal_of_msh("bare", run).starts_with(no_section));
  CHECK(refusal_of_msh("geometry", "Merge \"/etc/passwd\";\n" + run).starts_with(no_section));
  CHECK(refusal_of_msh("include", "Include \"other.geo\";\n").starts_with(no_section));
  CHECK(refusal_of_msh("opt", "General.Terminal = 1;\n" + run).starts_with(no_section));
  CHECK(refusal_of_msh("dollar", "$ \n" + run).starts_with(no_section));
  CHECK(refusal_of_msh("behind", format + run)
            .starts_with("mail.msh:4:1: this is no section of a mesh of Gmsh; expected a section"));
  CHECK(refusal_of_msh("inside", format + "$Nodes\n" + run).starts_with("mail.msh:5:1: found"));
  CHECK(refusal_of_msh("at_end", format + nodes + elements + run).starts_with("mail.msh:29:1:"));
  CHECK(refusal_of_msh("step", "ISO-10303-21;\nHEADER;\n").starts_with(no_section));
  CHECK(refusal_of_msh("stl", "solid a\nfacet normal 0 0 1\n").starts_with(no_section));
  CHECK(refusal_of_msh("empty", "").find("no $MeshFormat") != std::string::npos);
  CHECK(refusal_of_msh("late", nodes + format).find("$Nodes before $MeshFormat") !=
        std::string::npos);
  CHECK(refusal_of_msh("zeros", std::string(5000, '\0')).starts_with(no_section));
  CHECK_FALSE(fs::exists(folder / "ran"));
}

TEST_CASE("a number that leads outside the file is refused with its line") {
  const std::string range = "expected a number from 1 to 2147483647";
  for (const char* tag : {"2147483648", "-1", "0", "-9223372036854775808", "4294967297"}) {
    CAPTURE(tag);
    const std::string found = std::string("found ") + tag + " for ";
    const std::string in_element =
        replaced(elements, "1 1 2 3 4 5 6 7 8", std::string("1 1 2 3 4 5 6 ") + tag + " 8");
    CHECK(refusal_of_msh("element_4", format + nodes + in_element)
              .starts_with("mail.msh:27:15: " + found + "an element's node; " + range));
    const std::string in_node = replaced(nodes, "\n8\n0 0 0", std::string("\n") + tag + "\n0 0 0");
    CHECK(refusal_of_msh("node_4", format + in_node + elements)
              .starts_with("mail.msh:14:1: " + found + "a node's number; " + range));
    const std::string message = refusal_of_msh(
        "element_2",
        format_2 + nodes_2 + replaced(elements_2, "7 8\n", std::string("7 ") + tag + "\n"));
    CHECK(message.starts_with("mail.msh:17:25: found " + std::string(tag)));
  }
  const std::string unknown = replaced(elements, "7 8\n", "7 999\n");
  CHECK(refusal_of_msh("unknown", format + nodes + unknown)
            .starts_with("mail.msh:27:17: element 1 has the node 999, which is not there"));
  CHECK(refusal_of_msh("twice", format + replaced(nodes, "\n8\n0 0 0", "\n7\n0 0 0") + elements)
            .starts_with("mail.msh:14:1: node 7 is there twice"));
  CHECK(refusal_of_msh("order", format + elements + nodes)
            .starts_with("mail.msh:4:10: elements before the nodes"));
  CHECK(refusal_of_msh("same_nodes", format_2 + nodes_2 +
                                         "$Elements\n2\n1 5 2 1 1 1 2 3 4 5 6 7 8\n"
                                         "2 5 2 2 1 1 2 3 4 5 6 7 8\n$EndElements\n")
            .find("cells 1 and 2 have the same nodes") != std::string::npos);
}

TEST_CASE("a count beyond the file is refused before anything of its size is allocated") {
  for (const char* n : {"9223372036854775807", "1000000000000", "4294967296", "-5"}) {
    CAPTURE(n);
    const std::string number(n);
    const std::string found = "found " + number + " for the number of";
    const auto is_refused = [&](const std::string& name, const std::string& bytes) {
      CHECK(refusal_of_msh(name, bytes).find(found) != std::string::npos);
    };
    is_refused("nodes", format + "$Nodes\n1 " + number + " 1 8\n");
    is_refused("node_blocks", format + "$Nodes\n" + number + " 8 1 8\n");
    is_refused("nodes_in_block", format + "$Nodes\n1 1 1 1\n3 1 0 " + number + "\n");
    is_refused("elements", format + nodes + "$Elements\n1 " + number + " 1 1\n");
    is_refused("elements_in_block", format + nodes + "$Elements\n1 1 1 1\n3 1 5 " + number + "\n");
    is_refused("entities", format + "$Entities\n0 0 0 " + number + "\n1 0 0 0 1 1 1 0 0\n");
    is_refused("groups", format + "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 " + number + "\n");
    is_refused("names", format + "$PhysicalNames\n" + number + "\n");
    is_refused("nodes_2", format_2 + "$Nodes\n" + number + "\n");
    is_refused("tags_2",
               format_2 + nodes_2 + "$Elements\n1\n1 5 " + number + " 1 1 1 2 3 4 5 6 7 8\n");
  }
  for (const std::int64_t n : {std::int64_t{1} << 62, std::int64_t{1} << 33, std::int64_t{-1}}) {
    CAPTURE(n);
    const std::string found = "found " + std::to_string(n) + " for the number of";
    CHECK(refusal_of_msh("binary_nodes", binary_4 + "$Nodes\n" + raw(std::int64_t{1}) + raw(n) +
                                             std::string(200, 1))
              .find(found) != std::string::npos);
    CHECK(refusal_of_msh("binary_points", binary_4 + "$Entities\n" + raw(n) + raw(std::int64_t{0}) +
                                              raw(std::int64_t{0}) + raw(std::int64_t{0}) +
                                              std::string(200, '\0'))
              .find(found) != std::string::npos);
  }
  CHECK(refusal_of_msh("binary_block_2", binary_2 + "$Nodes\n1\n" + raw(1) + raw(0.) + raw(0.) +
                                             raw(0.) + "\n$EndNodes\n$Elements\n100000\n" + raw(5) +
                                             raw(2000000000) + raw(2))
            .find("found 100000 for the number of elements") != std::string::npos);
}

TEST_CASE("a small file that names its elements in very many groups is refused") {
  std::string entity = "1 0 0 0 1 1 1 2000";
  for (int tag = 1; tag <= 2000; ++tag) entity += " " + std::to_string(tag);
  std::string many = "$Elements\n1 500 1 500\n3 1 5 500\n";
  for (int e = 1; e <= 500; ++e) many += std::to_string(e) + " 1 2 3 4 5 6 7 8\n";
  const std::string message = refusal_of_msh(
      "groups", format + "$Entities\n0 0 0 1\n" + entity + " 0\n$EndEntities\n" + nodes + many);
  CHECK(message.find("more elements than the file has bytes") != std::string::npos);
}

TEST_CASE("a count below what the section holds is refused, not cut off") {
  CHECK(refusal_of_msh("nodes", format_2 + replaced(nodes_2, "\n8\n", "\n7\n") + elements_2)
            .starts_with("mail.msh:13:1: found \"8 0 1 1\"; expected $EndNodes"));
  const std::string two = replaced(elements, "8\n$End", "8\n2 1 2 3 4 5 6 7 8\n$End");
  CHECK(refusal_of_msh("elements", format + nodes + two)
            .starts_with("mail.msh:28:1: found \"2 1 2 3 4 5 6 7 8\"; expected $EndElements"));
  CHECK(refusal_of_msh("sum", format + replaced(nodes, "1 8 1 8", "1 9 1 9") + elements)
            .find("found 8 nodes in the blocks") != std::string::npos);
}

TEST_CASE("coordinates that are no finite numbers are refused with their line") {
  for (const char* x : {"nan", "inf", "-inf", "1e999", "NAN(7)", "zero", "0x1p3", "1,5"}) {
    CAPTURE(x);
    const std::string place = "\n" + std::string(x) + " 1 0\n";
    CHECK(refusal_of_msh("text", format + replaced(nodes, "\n1 1 0\n", place) + elements)
              .starts_with("mail.msh:17:1: found \"" + std::string(x) + "\" for a coordinate"));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(refusal_of_msh("binary", binary_2 + "$Nodes\n1\n" + raw(1) + raw(0.) + raw(nan) + raw(0.))
            .find("a coordinate is not finite") != std::string::npos);
}

TEST_CASE("binary data that end early, are of another machine or of other numbers are refused") {
  const fs::path folder = fresh_folder("binary");
  const std::string path = (folder / "whole.msh").string();
  for (const double version : {2.2, 4.1}) {
    {
      const NoTraps in_gmsh;
      const GmshSession session;
      gmsh::model::addDiscreteEntity(3, 1);
      gmsh::model::mesh::addNodes(3, 1, {1, 2, 3, 4}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
      gmsh::model::mesh::addElementsByType(1, 4, {1}, {1, 2, 3, 4});
      gmsh::model::addPhysicalGroup(3, {1});
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
      gmsh::option::setNumber("Mesh.Binary", 1);
      gmsh::write(path);
    }
    const std::string whole = read_file(path);
    std::vector<std::string> notes;
    CHECK(read_msh(path, notes).n_cells() == 1);
    // every beginning of the file but those that lack the last line's end
    for (std::size_t length = 0; length + 13 < whole.size(); ++length) {
      std::ofstream(path, std::ios::binary) << whole.substr(0, length);
      CAPTURE(length);
      CHECK_THROWS_AS(read_msh(path, notes), Failure);
    }
  }
  const std::string begin = "$MeshFormat\n4.1 1 8\n";
  CHECK(refusal_of_msh("big", begin + raw(1 << 24) + "\n$EndMeshFormat\n").find("big endian") !=
        std::string::npos);
  CHECK(refusal_of_msh("other", begin + raw(7) + "\n$EndMeshFormat\n").find("found 7") !=
        std::string::npos);
  CHECK(refusal_of_msh("short", "$MeshFormat\n4.1 0 4\n$EndMeshFormat\n")
            .starts_with("mail.msh:2:7: found numbers of 4 bytes"));
  CHECK(refusal_of_msh("version", "$MeshFormat\n9.7 0 8\n$EndMeshFormat\n")
            .starts_with("mail.msh:2:"));
  CHECK(refusal_of_msh("version_4", "$MeshFormat\n4 1 8\n" + raw(1) + "\n$EndMeshFormat\n")
            .starts_with("mail.msh:2:5: binary data in format 4.0"));
  CHECK(refusal_of_msh("no_end", "$MeshFormat\n4.1 0 8\n" + nodes)
            .starts_with("mail.msh:3:1: found \"$Nodes\"; expected $EndMeshFormat"));
  CHECK(refusal_of_msh("open", format + "$Comments\nno end\n")
            .starts_with("mail.msh:4:1: the section $Comments has no end"));
}

TEST_CASE("names that would disturb what is written from them are refused with their line") {
  const auto message = [&](const std::string& name) {
    return refusal_of_msh(
        "name", format + "$PhysicalNames\n1\n3 1 " + name + "\n$EndPhysicalNames\n" + nodes);
  };
  const std::string place = "mail.msh:6:5: ";
  CHECK(message("\"a \"b\" c\"").starts_with(place + "found the name"));
  CHECK(message("\"a\tb\"").starts_with(place + "found the name"));
  CHECK(message("\"a\033[2Jb\"").starts_with(place + "found the name \"a?[2Jb\""));
  CHECK(message("\"a\nb\"").starts_with(place));
  CHECK(message("\"a").starts_with(place));
  CHECK(message("bare").starts_with(place + "found bare; expected a name between double quotes"));
  CHECK(message("").starts_with("mail.msh:6:5: found no name"));
  CHECK(message("\"" + std::string(100000, 'a') + "\"").starts_with(place + "found a name of"));
  const std::string cells = format_2 +
                            "$PhysicalNames\n2\n2 1 \"side\"\n2 2 \"side\"\n"
                            "$EndPhysicalNames\n" +
                            nodes_2 +
                            "$Elements\n3\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 3 2 1 1 1 2 3 4\n"
                            "3 3 2 2 1 5 6 7 8\n$EndElements\n";
  CHECK(refusal_of_msh("same_name", cells).find("two groups of surfaces have the name \"side\"") !=
        std::string::npos);
}

TEST_CASE("types of elements outside the format's list are refused with their line") {
  for (const char* type : {"0", "-3", "34", "35", "140", "2147483647"}) {
    CAPTURE(type);
    const std::string line = std::string("\n3 1 ") + type + " 1\n";
    CHECK(refusal_of_msh("type", format + nodes + replaced(elements, "\n3 1 5 1\n", line))
              .starts_with("mail.msh:26:5: found the type "));
  }
  CHECK(refusal_of_msh("dimension", format + nodes + replaced(elements, "\n3 1 5", "\n2 1 5"))
            .find("in an entity of dimension 2") != std::string::npos);
  CHECK(refusal_of_msh("dimension_4", format + nodes + replaced(elements, "\n3 1 5", "\n4 1 5"))
            .find("found the dimension 4") != std::string::npos);
}

TEST_CASE("a very long line, many sections and deep rows of brackets end at once") {
  CHECK(refusal_of_msh("brackets", std::string(1 << 20, '{')).starts_with("mail.msh:1:1: "));
  CHECK(refusal_of_msh("word", format + "$Nodes\n" + std::string(1 << 20, '9'))
            .starts_with("mail.msh:5:1: found \"999"));
  std::string sections = format;
  for (int i = 0; i < 100000; ++i) sections += "$A\n$EndA\n";
  CHECK(refusal_of_msh("sections", sections).find("no cells") != std::string::npos);
}

TEST_CASE("settings of gmsh beside a mesh, a surface and a STEP file are never read") {
  const fs::path folder = fresh_folder("settings");
  const std::string path = (folder / "valid").string();
  const auto add_settings = [&](const std::string& file) {
    for (const char* end : {".opt", ".geo", ".pos"}) std::ofstream(file + end) << script(folder);
    for (const char* name : {".gmshrc", ".gmsh-options", "gmsh-options", ".gmsh-session"})
      std::ofstream(folder / name) << script(folder);
  };
  setenv("HOME", folder.c_str(), 1);
  setenv("GMSH_HOME", folder.c_str(), 1);
  std::vector<std::string> notes;
  std::ofstream(path + ".msh") << format + nodes + elements;
  add_settings(path + ".msh");
  CHECK(read_msh(path + ".msh", notes).n_cells() == 1);
  {
    const NoTraps in_gmsh;
    const GmshSession session;
    gmsh::model::occ::addBox(0, 0, 0, 2, 2, 2);
    gmsh::model::occ::synchronize();
    gmsh::write(path + ".step");
    gmsh::option::setNumber("Mesh.MeshSizeMax", 1);
    gmsh::model::mesh::generate(2);
    gmsh::write(path + ".stl");
  }
  add_settings(path + ".step");
  add_settings(path + ".stl");
  const std::set<std::string> before = files_in(folder);
  CHECK(read_solid(path + ".step", {false, 1, CellType::hex8}, notes).n_cells() > 0);
  CHECK(read_solid(path + ".stl", {true, 1, CellType::tet15}, notes).n_cells() > 0);
  CHECK(files_in(folder) == before);
  CHECK_FALSE(fs::exists(folder / "ran"));
}

TEST_CASE("gmsh is given nothing but what is STEP, whatever the file is called") {
  const fs::path folder = fresh_folder("step");
  std::vector<std::string> notes;
  for (const std::string& bytes :
       {script(folder), format + nodes + elements, std::string("solid a\nendsolid a\n"),
        std::string("DBRep_DrawableShape\n"), std::string(), std::string(1000, '\0'),
        std::string("x ISO-10303-21;\n")}) {
    const fs::path path = folder / "part.step";
    std::ofstream(path, std::ios::binary) << bytes;
    CHECK(refusal(path,
                  [&] {
                    read_solid(path.string(), {false, 1, CellType::hex8}, notes);
                  }) ==
          path.string() +
              ": this is no STEP file; expected a STEP file, which begins with ISO-10303-21");
  }
  const fs::path path = folder / "bad.step";
  for (const char* rest : {"", "HEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n",
                           "DATA;\n#1=CARTESIAN_POINT('',(1.E400,nan,0.));\n#2=#2;\n",
                           "((((((((((((((((((((((((((((("}) {
    std::ofstream(path, std::ios::binary) << "ISO-10303-21;\n" << rest;
    const std::string message = refusal(path, [&] {
      read_solid(path.string(), {false, 1, CellType::hex8}, notes);
    });
    CHECK(message.starts_with(path.string() + ": "));
  }
  CHECK_FALSE(fs::exists(folder / "ran"));
}

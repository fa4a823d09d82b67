#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/lower_case.hpp"
#include "meshing/block.hpp"
#include "meshing/exchange.hpp"

namespace langer {

namespace {

// The ending of a file's name, in lower case.
std::string kind_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) return "";
  return lower_case(path.substr(dot + 1));
}

std::string tame(const std::string& name, std::vector<std::string>& notes) {
  const std::string s = usable_name(name);
  if (s != name) notes.push_back(fmt::format("\"{}\" is called {} here", name, s));
  return s;
}

template <class Sets>
void tame_names(Sets& sets, std::vector<std::string>& notes) {
  Sets renamed;
  for (auto& [name, set] : sets) renamed[tame(name, notes)] = std::move(set);
  sets = std::move(renamed);
}

}  // namespace

std::string usable_name(std::string name) {
  for (char& c : name) {
    if (c == ' ' || c == '\t' || c == '/' || c == '.') c = '_';
  }
  return name;
}

bool FromFile::is_inp() const { return kind_of(file.path) == "inp"; }

std::vector<Complaint> FromFile::complaints() const {
  const std::string kind = kind_of(file.path);
  if (seal && kind != "stl")
    return {{"seal", "found together with a ." + kind, "a surface of triangles, .stl", ""}};
  if (kind == "msh" || kind == "inp") {
    if (edge)
      return {{"edge", "found together with a mesh", "no edge: the file has its own cells", ""}};
    return {};
  }
  if (kind == "step" || kind == "stp" || kind == "stl") {
    if (!edge) return {{"edge", "none", "the length of the cells in mm", ""}};
    return {};
  }
  return {{"path", "found \"" + file.path + "\"",
           "a mesh, .msh of Gmsh or .inp of Abaqus or CalculiX, a .step or an .stl",
           "other surfaces (.ply, .obj): save them as .stl; other meshes: as .msh by gmsh"}};
}

namespace {

// Meshes are read; solids are meshed by Gmsh with elements of the length `edge`, which counts after
// scaling.
Mesh read_by_kind(const FromFile& from, CellType cells, std::vector<std::string>& notes) {
  const std::string& path = from.file.path;
  const std::string kind = kind_of(path);
  if (kind == "msh") return read_msh(path, notes);
  if (kind == "inp") return read_inp(path, notes);
  SolidOptions options{kind == "stl", *from.edge / from.scale, cells, 0, from.scale};
  if (from.seal) options.seal = *from.seal / from.scale;
  return read_solid(path, options, notes);
}

}  // namespace

Mesh mesh_of(const FromFile& from, CellType cells, std::vector<std::string>& notes) {
  const std::string& path = from.file.path;
  Mesh mesh = read_by_kind(from, cells, notes);
  if (mesh.type != cells)
    throw Failure(Exit::config,
                  Error{{},
                        "cells",
                        fmt::format("found {}", names(cells)[static_cast<int>(cells)]),
                        fmt::format("{}, the elements of {}",
                                    names(mesh.type)[static_cast<int>(mesh.type)], path),
                        ""});
  for (Vec3& x : mesh.X) x *= from.scale;
  std::vector<std::string> said;
  tame_names(mesh.facet_sets, said);
  tame_names(mesh.node_sets, said);
  for (std::string& body : mesh.bodies) body = tame(body, said);
  for (const std::string& note : said)
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  if (std::set<std::string>(mesh.bodies.begin(), mesh.bodies.end()).size() != mesh.bodies.size())
    throw Failure(
        Exit::input,
        Error{{from.file.path}, "", "two bodies of one name", "bodies of different names", ""});
  return mesh;
}

Box box(const Geometry& geometry) {
  return std::visit(
      [](const auto& g) {
        if constexpr (std::is_same_v<std::decay_t<decltype(g)>, FromFile>)
          return Box{};
        else if constexpr (requires { g.spans(); })
          return g.spans();
        else
          return Box{g.origin, g.size};
      },
      geometry);
}

bool is_section(const Geometry& geometry) {
  return std::holds_alternative<SectionBox>(geometry) ||
         std::holds_alternative<IndentedDisc>(geometry);
}

std::vector<Complaint> contradictions(const FromFile&, const Points&) { return {}; }

}  // namespace langer

// Small things to write and read back, and what tests of files share.
#pragma once

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "mechanics/mesh/mesh.hpp"
#include "results/store/identity.hpp"

namespace langer::example {

// a folder of its own for each test, empty at its begin
inline std::string folder(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(BINARY_DIR) / "test_files" / name;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path.string();
}

inline Identity identity() {
  Identity id;
  id.stage = "mesh";
  id.config = "block:\n  size: [2, 1, 1]\n";
  id.config_hash = fnv1a(id.config);
  id.inputs = {{"material", "0123456789abcdef"}, {"mesh", "fedcba9876543210"}};
  id.command = "langer-mesh bar.yaml -o mesh.h5";
  return id;
}

// two unit cubes along x, frames turned by 30 degrees about y in the second
inline Mesh bar() {
  Mesh mesh;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i) mesh.X.emplace_back(i, j, k);
  for (int e = 0; e < 2; ++e)
    for (int n : {0, 1, 4, 3, 6, 7, 10, 9}) mesh.connectivity.push_back(e + n);
  mesh.body = {0, 1};
  mesh.bodies = {"skin", "fat"};
  mesh.frames = {Mat3::Identity(), Mat3::Identity()};
  const double c = std::sqrt(3.0) / 2, s = 0.5;
  mesh.frames[1] << c, 0, s, 0, 1, 0, -s, 0, c;
  mesh.node_sets = {{"x_min", {0, 3, 6, 9}}, {"M", {4}}};
  mesh.facet_sets = {{"x_min", {{0, 0}}}, {"y_max", {{0, 3}, {1, 3}}}};
  return mesh;
}

inline bool same(const Mesh& a, const Mesh& b) {
  const auto facets = [](const Mesh& m) {
    std::map<std::string, std::vector<std::pair<int, int>>> pairs;
    for (const auto& [name, set] : m.facet_sets)
      for (const Facet& f : set) pairs[name].emplace_back(f.cell, f.local);
    return pairs;
  };
  return a.type == b.type && a.X == b.X && a.connectivity == b.connectivity && a.body == b.body &&
         a.bodies == b.bodies && a.frames == b.frames && a.node_sets == b.node_sets &&
         facets(a) == facets(b);
}

inline std::string bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_bytes(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

}  // namespace langer::example

// Keys that choose: what stands beside an include replaces what is included, and is never summed
// with it.
#include <doctest/doctest.h>

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scene/model/solve_config_io.hpp"

using namespace langer;

namespace included_tests {

namespace fs = std::filesystem;

namespace {

// files in a folder of their own, each a name and a text
struct Folder {
  fs::path path = fs::temp_directory_path() / ("langer_included_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
  }
  Tree tree(const std::string& name) const { return load_yaml((path / name).string()); }
};

template <class Config>
Config read(Tree tree) {
  return read_config<Config>(std::move(tree)).config;
}

template <class Config>
std::string said(Tree tree) {
  try {
    read_config<Config>(std::move(tree));
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "accepted";
}

std::string terms(const Material& m) {
  std::string all;
  for (const MatrixTerm& term : m.matrix)
    all += (all.empty() ? "" : " ") +
           std::visit([](const auto& t) { return std::string(t.key); }, term);
  return all;
}

const std::string rest = "volume: {quadratic: {d: 1e-3}}\n";
const std::string moved =
    "supports: [{on: y_min, hold: [y]}]\nloads: [{on: y_max, displacement: {y: 1}}]\n";

}  // namespace

TEST_CASE("A matrix beside an include replaces the included one, whatever the two are") {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> laws{
      {"neo_hooke", "{a1: 0.3}"},
      {"yeoh", "{a1: 0.2, a2: 0.1}"},
      {"mooney_rivlin", "{c10: 0.1, c01: 0.1}"},
      {"gent", "{mu: 0.3, Jm: 40}"}};
  for (const auto& [below, b] : laws)
    for (const auto& [above, a] : laws) {
      folder.write("law.yaml", fmt::format("matrix: {{{}: {}}}\n{}", below, b, rest));
      folder.write("top.yaml", fmt::format("include: law.yaml\nmatrix: {{{}: {}}}\n", above, a));
      CHECK(terms(read<Material>(folder.tree("top.yaml"))) == above);
      // the same a level deeper, and through a file in between
      folder.write(
          "scene.yaml",
          fmt::format("material: {{include: law.yaml, matrix: {{{}: {}}}}}\n", above, a) + moved);
      CHECK(terms(*read<SolveConfig>(folder.tree("scene.yaml")).material) == above);
      folder.write("base.yaml", "material: {include: law.yaml}\n" + moved);
      folder.write("over.yaml",
                   fmt::format("include: base.yaml\nmaterial: {{matrix: {{{}: {}}}}}\n", above, a));
      CHECK(terms(*read<SolveConfig>(folder.tree("over.yaml")).material) == above);
      folder.write("other.yaml", fmt::format("matrix: {{{}: {}}}\n{}", above, a, rest));
      folder.write("swap.yaml", "include: base.yaml\nmaterial: {include: other.yaml}\n");
      CHECK(terms(*read<SolveConfig>(folder.tree("swap.yaml")).material) == above);
      folder.write("list.yaml", "include: [law.yaml, other.yaml]\n");
      CHECK(terms(read<Material>(folder.tree("list.yaml"))) == above);
    }
}

TEST_CASE(
    "Numbers of included alternatives change, a part of a sum is refused with a cure that works") {
  const Folder folder;
  folder.write("law.yaml", "matrix: {yeoh: {a1: 0.2, a2: 0.1}, neo_hooke: {a1: 0.3}}\n" + rest);
  folder.write("top.yaml", "include: law.yaml\nmatrix: {yeoh: {a1: 0.5}, neo_hooke: {}}\n");
  const Material m = read<Material>(folder.tree("top.yaml"));
  CHECK(terms(m) == "yeoh neo_hooke");
  CHECK(std::get<Yeoh>(m.matrix[0]).a1 == 0.5);
  CHECK(std::get<Yeoh>(m.matrix[0]).a2 == 0.1);
  folder.write("part.yaml", "include: law.yaml\nmatrix: {yeoh: {a1: 0.5}}\n");
  const std::string told = said<Material>(folder.tree("part.yaml"));
  CAPTURE(told);
  CHECK(told.find("part.yaml:2:1: matrix: found yeoh together with an included yeoh, neo_hooke") !=
        std::string::npos);
  CHECK(told.find("[{yeoh: {...}}]") != std::string::npos);
  folder.write("cured.yaml", "include: law.yaml\nmatrix: [{yeoh: {a1: 0.5}}]\n");
  CHECK(terms(read<Material>(folder.tree("cured.yaml"))) == "yeoh");
  folder.write("mixed.yaml",
               "include: law.yaml\nmatrix: {yeoh: {a1: 0.5}, gent: {mu: 1, Jm: 10}}\n");
  CHECK(said<Material>(folder.tree("mixed.yaml")).find("found yeoh, gent together with") !=
        std::string::npos);
  // a sum in one file is a sum
  CHECK(terms(read<Material>(folder.tree("law.yaml"))) == "yeoh neo_hooke");
}

TEST_CASE("Every key that chooses takes the choice beside the include") {
  const Folder folder;
  const auto of = [&](const std::string& below, const std::string& above) {
    folder.write("base.yaml", moved + below);
    folder.write("top.yaml", "include: base.yaml\n" + above);
    return read<SolveConfig>(folder.tree("top.yaml"));
  };
  const std::string motion = ", on: y_max, motion: [{t: 1, to: [0, -1, 0]}]";
  const SolveConfig indenter =
      of("contacts: {tip: {rigid: {sphere: {radius: 1, centre: [0, 2, 0]}}" + motion + "}}\n",
         "contacts: {tip: {rigid: {plane: {point: [0, 1, 0], normal: [0, -1, 0]}}}}\n");
  CHECK(std::holds_alternative<Plane>(indenter.contacts.at("tip").rigid.value()));
  CHECK(std::get<Sphere>(
            of("contacts: {tip: {rigid: {sphere: {radius: 1, centre: [0, 2, 0]}}" + motion + "}}\n",
               "contacts: {tip: {rigid: {sphere: {radius: 3}}}}\n")
                .contacts.at("tip")
                .rigid.value())
            .radius == 3);
  CHECK(std::holds_alternative<KinsolOptions>(
      of("solver: {newton: {relative: 1e-9}}\n", "solver: {kinsol: {}}\n").solver));
  CHECK(std::holds_alternative<PointField>(
      *of("fibre_field: {formula: {alpha: \"3\"}}\n", "fibre_field: {points: {file: a.csv}}\n")
           .fibre_field));
  const SolveConfig mesh = of(
      "mesh: {geometry: {block: {size: [1, 1, 1], divisions: [2, 2, 2]}}, sets: {s: {of: top, within: {cylinder: {axis: y, radius: 2}}}}}\n",
      "mesh: {geometry: {indented_block: {size: [30, 4, 30], radius: 2.5, depth: 1, edge: 0.5}}}\n");
  CHECK(std::holds_alternative<IndentedBlock>(mesh.mesh->geometry));
}

TEST_CASE(
    "--set and sweeps change what is there; they add nothing to a sum and nothing that was replaced") {
  const Folder folder;
  folder.write("law.yaml", "matrix: {neo_hooke: {a1: 0.3}}\n" + rest);
  folder.write("top.yaml", "include: law.yaml\nmatrix: {yeoh: {a1: 0.2}}\n");
  const auto with = [&](const std::string& file, const std::string& key, const std::string& value) {
    Tree tree = folder.tree(file);
    set_value(tree, key, parse_yaml(value, "--set"));
    return tree;
  };
  CHECK(std::get<NeoHooke>(read<Material>(with("law.yaml", "matrix.neo_hooke.a1", "0.7")).matrix[0])
            .a1 == 0.7);
  CHECK(std::get<Yeoh>(read<Material>(with("top.yaml", "matrix.yeoh.a1", "0.7")).matrix[0]).a1 ==
        0.7);
  CHECK(terms(read<Material>(with("top.yaml", "matrix", "{gent: {mu: 1, Jm: 10}}"))) == "gent");
  for (const char* file : {"law.yaml", "top.yaml"}) {
    const std::string told = said<Material>(with(file, "matrix.gent", "{mu: 1, Jm: 10}"));
    CAPTURE(told);
    CHECK(told.find("gent added to") != std::string::npos);
    CHECK(told.find("--set 'matrix={gent: {...}}'") != std::string::npos);
  }
  CHECK(said<Material>(with("top.yaml", "matrix.neo_hooke.a1", "0.7"))
            .find("neo_hooke added to yeoh") != std::string::npos);
  // of maps that do not choose nothing is refused
  CHECK(terms(read<Material>(with("top.yaml", "volume.quadratic.d", "0.7"))) == "yeoh");
}

}  // namespace included_tests

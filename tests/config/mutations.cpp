// Every shipped config and pipeline with one thing wrong, a few thousand times: never a crash,
// never a hang; where it must be refused it is, and every refusal names the file, a line and what
// it is about.
//   key twice, key misspelt, value not a number, infinite, huge, negative, of another type, missing
// As deep as it goes without solving: configs are read with all their rules, meshes made (those of
// few cells), scenes composed, measured tests read, pipelines expanded with the configs of their
// steps.
#include <doctest/doctest.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "identification/setup/fit_config_io.hpp"
#include "layers/layers_config.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/expand.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/scene.hpp"
#include "scene/model/scene_bodies.hpp"
#include "scene/model/solve_config_io.hpp"
#include "support/slow_build.hpp"

using namespace langer;
namespace fs = std::filesystem;

namespace {

const std::string project_root = SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// a key or a list item that stands in this very file, and where its value is if that is a scalar
struct Spot {
  std::string key;                    // "" for a list item
  std::string path;                   // contacts.sphere.motion[0].t
  int line = 0;                       // from 1
  std::size_t at = 0;                 // of the key or item in the text
  std::size_t value = 0, length = 0;  // of a scalar in the text; length 0: none
  bool number = false;
};

bool is_number(const std::string& s) {
  double x;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  return error == std::errc{} && end == s.data() + s.size();
}

void collect(const Tree& tree, const std::string& path, const std::string& file,
             const std::string& text, const std::vector<std::size_t>& lines,
             std::vector<Spot>& spots) {
  const auto add = [&](const Tree& value, const std::string& key, const std::string& here) {
    if (value.place.file == file && value.place.line > 0) {
      const std::size_t line = lines[static_cast<std::size_t>(value.place.line - 1)];
      Spot spot{key, here, value.place.line,
                line + static_cast<std::size_t>(value.place.column - 1)};
      const bool there =
          text.compare(spot.at, key.size(), key) == 0;  // not quoted, not behind an alias
      std::size_t at = spot.at + key.size();
      if (!key.empty()) at = text.find_first_not_of(' ', at + 1);
      if (there && value.kind == Tree::Kind::scalar && !value.scalar.empty() &&
          at != std::string::npos) {
        if (text[at] == '"' || text[at] == '\'') ++at;
        if (text.compare(at, value.scalar.size(), value.scalar) == 0)
          spot.value = at, spot.length = value.scalar.size(),
          spot.number = !value.quoted && is_number(value.scalar);
      }
      if (there) spots.push_back(spot);
    }
    collect(value, here, file, text, lines, spots);
  };
  for (const Tree::Entry& e : tree.map) add(e.value, e.key, join(path, e.key));
  for (std::size_t i = 0; i < tree.list.size(); ++i) add(tree.list[i], "", item(path, i));
}

enum class Must { refuse_here, refuse, not_crash };

struct Mutation {
  std::string what, text;
  Must must = Must::not_crash;
  int line = 0;
};

// Names that a config gives may be any. Pipelines say where what was meant is missed.
Must must_where_misspelt(const Spot& spot) {
  std::string parent =
      spot.path.substr(0, std::max(spot.path.size(), spot.key.size() + 1) - spot.key.size() - 1);
  parent = parent.substr(parent.rfind('.') + 1);
  static const std::set<std::string> of_names{"sets",       "points",   "maps",    "renders",
                                              "figures",    "contacts", "compare", "materials",
                                              "summary_at", "nodes",    "sweep",   "variants"};
  if (of_names.count(parent)) return Must::not_crash;
  // beside the one that an included file gives, a misspelt alternative is a second one: said of the
  // whole choice
  if (spot.path == "geometry.block") return Must::not_crash;
  return spot.path.starts_with("nodes.") ? Must::refuse : Must::refuse_here;
}

// the part that messages name: b of the setting a.b
std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

std::vector<Mutation> mutations(const Spot& spot, const std::string& text) {
  std::vector<Mutation> all;
  const auto with = [&](std::size_t at, std::size_t length, const std::string& in) {
    return text.substr(0, at) + in + text.substr(at + length);
  };
  const std::size_t begin = text.rfind('\n', spot.at) + 1;
  const std::string before = text.substr(begin, spot.at - begin);
  const bool flow = before.find_first_of("{[") != std::string::npos;
  if (!spot.key.empty()) {
    const std::string again =
        flow ? spot.key + ": 0, " : spot.key + ": 0\n" + std::string(before.size(), ' ');
    all.push_back(
        {"twice", with(spot.at, 0, again), Must::refuse_here, spot.line + (flow ? 0 : 1)});
    all.push_back({"misspelt", with(spot.at, spot.key.size(), spot.key + "x"),
                   must_where_misspelt(spot), spot.line});
  }
  if (spot.length == 0) return all;
  const auto value = [&](const std::string& what, const std::string& in,
                         Must must = Must::not_crash) {
    all.push_back({what, with(spot.value, spot.length, in), must, spot.line});
  };
  const bool quoted = text[spot.value - 1] == '"' || text[spot.value - 1] == '\'';
  if (quoted) {
    value("another text", "no such thing");
    return all;
  }
  for (const char* word : {".nan", "nan", "inf", "-.inf", "1e400"})
    value(word, word, spot.number ? Must::refuse_here : Must::not_crash);
  for (const char* word : {"1e308", "-1e308", "99999999999999999999", "2000000000", "0", "-1",
                           "1e-300", "[1, 2]", "{a: 1}", "abc", "~", "true", "''"})
    value(word, word);
  if (spot.number) {
    const std::string number = text.substr(spot.value, spot.length);
    value("negative", number[0] == '-' ? number.substr(1) : "-" + number);
    value("with a comma", "1,5");
  }
  if (!spot.key.empty() && !flow) value("deleted", "");
  return all;
}

using Check = std::function<void(Tree)>;

struct Tally {
  int files = 0, found = 0, mutations = 0, refused = 0;
  std::set<std::string> accepted;  // what had to be refused and was not
  double slowest = 0;
  std::string slowest_name;
};

// Of a long file every so many-th: prime to the twenty of each spot, so that every spot and every
// kind of mutation is among them.
int one_of(std::size_t mutations) {
  constexpr std::size_t most = 1500;
  for (int every : {1, 3, 7, 9, 11, 13, 17})
    if (mutations <= most * every) return every;
  return 19;
}

void run(const fs::path& path, const Check& check, Tally& tally) {
  const std::string file = path.string(), text = text_of(path), base = path.parent_path().string();
  INFO("file: " << file);
  std::vector<std::size_t> lines{0};
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') lines.push_back(i + 1);
  std::vector<Spot> spots;
  collect(parse_yaml(text, file, base), "", file, text, lines, spots);
  CHECK_NOTHROW(check(parse_yaml(text, file, base)));
  CHECK(!spots.empty());
  ++tally.files;
  std::size_t all = 0;
  for (const Spot& spot : spots) all += mutations(spot, text).size();
  const int every = test::stride * one_of(all);
  for (const Spot& spot : spots)
    for (const Mutation& m : mutations(spot, text)) {
      if (tally.found++ % every) continue;
      ++tally.mutations;
      const std::string name = fmt::format(
          "{}:{}: {} {}", fs::relative(file, project_root).string(), spot.line, spot.path, m.what);
      const auto start = std::chrono::steady_clock::now();
      bool refused = false, here = false, about = false, named = true;
      std::string said;
      try {
        check(parse_yaml(m.text, file, base));
      } catch (const Failure& failure) {
        refused = true;
        said = failure.what();
        named = !failure.errors().empty() &&
                (failure.code() == Exit::config || failure.code() == Exit::input);
        for (const Error& e : failure.errors()) {
          // an error of the data themselves names the data's file
          named =
              named && !e.where.file.empty() && (e.where.line > 0 || failure.code() == Exit::input);
          here = here || (e.where.file == file && e.where.line == m.line &&
                          (e.key + e.found).find(last_part(spot.key)) != std::string::npos);
          about = about || (e.key + e.found).find(last_part(spot.key)) != std::string::npos;
        }
      } catch (const std::exception& e) {
        said = e.what();
        FAIL_CHECK(name << ": not a refusal, but " << said);
      }
      const double seconds =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      if (seconds > tally.slowest) tally.slowest = seconds, tally.slowest_name = name;
      tally.refused += refused;
      if (!named) FAIL_CHECK(name << ": refused without file or line: " << said);
      if ((m.must == Must::refuse && !(refused && about)) ||
          (m.must == Must::refuse_here && !(refused && here)))
        tally.accepted.insert(name + (refused ? ": said elsewhere: " + said : ": accepted"));
    }
}

void report(const std::string& what, const Tally& tally) {
  std::string all;
  for (const std::string& name : tally.accepted) all += name + "\n";
  MESSAGE(what << ": " << tally.files << " files, " << tally.mutations << " mutations, "
               << tally.refused << " refused, slowest " << tally.slowest << " s ("
               << tally.slowest_name << ")");
  INFO(all);
  CHECK(tally.accepted.empty());
  CHECK(tally.slowest < 20);
}

std::vector<fs::path> yaml_files(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(project_root) / folder))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("mutations of the shipped configs of fit sensitivity post and gather") {
  Tally tally;
  for (const std::string stage : {"fit", "sensitivity", "post", "gather"})
    for (const fs::path& path : yaml_files("configs/" + stage))
      run(
          path, [&](Tree tree) { effective_config(*find_stage(stage), std::move(tree), "."); },
          tally);
  for (const fs::path& path : yaml_files("configs/material"))
    run(
        path, [&](Tree tree) { read_config<Material>(std::move(tree)); }, tally);
  report("configs", tally);
}

TEST_CASE("mutations of the shipped configs of fit with their data") {
  Tally tally;
  for (const fs::path& path : yaml_files("configs/fit"))
    run(
        path,
        [&](Tree tree) {
          const auto loaded = read_config<FitConfig>(std::move(tree));
          measured_tests(loaded.config);
          free_parameters(loaded.config);
        },
        tally);
  report("fits", tally);
}

TEST_CASE("mutations of the shipped configs of mesh with the mesh made") {
  Tally tally;
  for (const fs::path& path : yaml_files("configs/mesh")) {
    const auto original = read_config<MeshConfig>(load_yaml(path.string()));
    const bool small = make_mesh(original.config, original.where).mesh.n_cells() < 1000;
    run(
        path,
        [&](Tree tree) {
          const auto loaded = read_config<MeshConfig>(std::move(tree));
          if (small) make_mesh(loaded.config, loaded.where);
        },
        tally);
  }
  report("meshes", tally);
}

TEST_CASE("mutations of the shipped configs of layers with the layers made") {
  Tally tally;
  for (const fs::path& path : yaml_files("configs/layers")) {
    run(
        path,
        [&](Tree tree) {
          const auto loaded = read_config<LayersConfig>(std::move(tree));
          layers_at_rest(loaded.config, {}, loaded.where);
        },
        tally);
  }
  report("layers", tally);
}

// in few enough cells for thousands of scenes, where the geometry has as few
Mesh coarse_mesh(MeshConfig config, const std::function<Place(const std::string&)>& where) {
  Mesh mesh = make_mesh(config, where).mesh;
  for (int i = 0; mesh.n_cells() > 600 && i < 6; ++i) try {
      scale_cells(config.geometry, 1.6);
      mesh = make_mesh(config, where).mesh;
    } catch (const Failure&) {
      break;
    }
  return mesh;
}

TEST_CASE("mutations of the shipped configs of solve with the scene composed") {
  std::vector<Mesh> shipped;
  for (const char* name :
       {"smoke", "cube_1_8", "scratch", "suction", "twist", "prestretch", "indentation_coarse"}) {
    const auto loaded =
        read_config<MeshConfig>(load_yaml(project_root + "/configs/mesh/" + name + ".yaml"));
    shipped.push_back(coarse_mesh(loaded.config, loaded.where));
  }
  const Material material =
      read_config<Material>(load_yaml(project_root + "/configs/material/abdomen_hgo_yeoh.yaml"))
          .config;
  Tally tally;
  int composed = 0;
  for (const fs::path& path : yaml_files("configs/solve")) {
    const auto compose = [&](Tree tree, const Mesh& mesh) {
      auto loaded = read_config<SolveConfig>(std::move(tree));
      expand_bodies(loaded.config, loaded.where.tree);
      make_scene(loaded.config, mesh, loaded.config.material ? loaded.config.material : material,
                 loaded.where);
    };
    const Mesh* fitting = nullptr;
    std::vector<Mesh> meshes = shipped;
    const auto own = read_config<SolveConfig>(load_yaml(path.string()));
    if (own.config.mesh) meshes = {coarse_mesh(*own.config.mesh, own.where)};
    // Several bodies have meshes of their own: thousands of scenes would take too long. Names of
    // bodies and of their sets are tested by tests/mortar.
    if (!own.config.bodies.empty()) continue;
    for (const Mesh& mesh : meshes) try {
        if (!fitting) compose(load_yaml(path.string()), mesh), fitting = &mesh;
      } catch (const Failure&) {
      }
    composed += fitting != nullptr;
    run(
        path,
        [&](Tree tree) {
          if (fitting)
            compose(std::move(tree), *fitting);
          else
            read_config<SolveConfig>(std::move(tree));
        },
        tally);
  }
  MESSAGE(composed << " scenes composed");
  CHECK(composed >= 30);
  report("scenes", tally);
}

TEST_CASE("mutations of the shipped pipelines expanded with the configs of their steps") {
  std::map<std::string, Tree> known;
  const auto read = [&](const std::string& path) {
    const fs::path from_root = fs::path(project_root) / path;
    const auto found = known.find(from_root.string());
    if (found != known.end()) return found->second;
    return known[from_root.string()] = load_yaml(from_root.string());
  };
  std::set<std::size_t>
      accepted;  // steps, by their texts: what a mutation leaves as it was is not read again
  Tally tally;
  for (const fs::path& path : yaml_files("pipelines")) {
    run(
        path,
        [&](Tree tree) {
          for (const pipeline::Step& step : pipeline::expand(pipeline::read_pipeline(tree), read)) {
            const std::size_t text =
                std::hash<std::string>()(step.stage->name + to_text(step.config));
            if (accepted.count(text)) continue;
            effective_config(*step.stage, step.config, ".");
            accepted.insert(text);
          }
        },
        tally);
  }
  report("pipelines", tally);
}

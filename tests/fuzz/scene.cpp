// Text -> a scene: read, written and read again as the same, then composed on a block and on a
// section.
#include "scene/model/scene.hpp"
#include "core/config/reader.hpp"
#include "core/config/writer.hpp"
#include "fuzz.hpp"
#include "scene/model/make_mesh.hpp"
#include "scene/model/scene_bodies.hpp"

namespace {

using namespace langer;

Mesh mesh_of(const std::string& text) {
  const auto loaded = read_config<MeshConfig>(parse_yaml(text, "mesh.yaml", ""));
  return make_mesh(loaded.config, loaded.where).mesh;
}

const Mesh& block() {
  static const Mesh mesh = mesh_of(
      "geometry: {block: {origin: [-2, 0, -2], size: [4, 2, 4], divisions: [4, 2, 4]}}\nbodies: [{name: below, thickness: 1}, {name: "
      "above, thickness: 1}]\npoints: {apex: [0, 2, 0]}\nsets: {hole: {of: top, within: {cylinder: {axis: y, radius: 1}}}, ring: {of: "
      "top, within: {cylinder: {axis: y, radius: 2, beyond: 1}}}}\n");
  return mesh;
}

const Mesh& section() {
  static const Mesh mesh = mesh_of(
      "geometry: {section: {of: axisymmetric, size: [4, 2], divisions: [4, 2]}}\nbodies: [{name: below, thickness: 1}, {name: above, "
      "thickness: 1}]\npoints: {apex: [0, 2, 0]}\nsets: {hole: {of: top, within: {cylinder: {axis: y, radius: 1}}}, ring: {of: top, "
      "within: {cylinder: {axis: y, radius: 2, beyond: 1}}}}\n");
  return mesh;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto read = [&] {
    return read_config<SolveConfig>(parse_yaml(text, "input.yaml", "/nonexistent"));
  };
  fuzz::reads_or_refuses("input.yaml", [&] {
    const std::string written = to_text(to_tree(read().config));
    if (to_text(to_tree(read_config<SolveConfig>(parse_yaml(written, "input.yaml", "")).config)) !=
        written)
      std::abort();
  });
  for (const Mesh* mesh : {&block(), &section()})
    fuzz::reads_or_refuses("input.yaml", [&] {
      auto loaded = read();
      // Bodies have meshes of their own, and a fuzzed one may be large. The rest of them is
      // composed on these.
      expand_bodies(loaded.config, loaded.where.tree);
      Material skin;
      skin.matrix = {NeoHooke{0.01}};
      skin.volume = QuadraticVolume{1e-3};
      make_scene(loaded.config, *mesh, loaded.config.material ? *loaded.config.material : skin,
                 loaded.where);
    });
  return 0;
}

// mesh.h5 as edited by others -> a mesh whose indices all lead somewhere.
#include "edited_h5.hpp"
#include "results/store/mesh_file.hpp"
#include "sound_mesh.hpp"
#include "store/example.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  static const std::string path = fuzz::scratch("mesh.h5");
  static const std::string good = [] {
    write_mesh(path, example::bar(), example::identity());
    return fuzz::unsealed(path);
  }();
  fuzz::write_edited(good, path, {data, size});
  fuzz::reads_or_refuses(path, [&] {
    const Mesh mesh = read_mesh(path).mesh;
    fuzz::need(static_cast<int>(mesh.frames.size()) == mesh.n_cells());
    fuzz::need_sound(mesh);
  });
  std::filesystem::remove(path);
  return 0;
}

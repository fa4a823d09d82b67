// Bytes -> a mesh of Gmsh whose indices all lead somewhere.
#include "fuzz.hpp"
#include "meshing/msh_mesh.hpp"
#include "meshing/parse_msh.hpp"
#include "sound_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  fuzz::reads_or_refuses("input.msh", [&] {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    std::vector<std::string> notes;
    const Mesh mesh = mesh_of(parse_msh(bytes, "input.msh"), "input.msh", notes);
    fuzz::need(mesh.n_cells() > 0);
    fuzz::need_sound(mesh);
  });
  return 0;
}

// Bytes as a crashed or hijacked gmsh might send them -> a mesh that is sound, or a refusal.
#include <stdexcept>

#include "fuzz.hpp"
#include "meshing/gmsh/packed_model.hpp"
#include "meshing/msh_mesh.hpp"
#include "meshing/split_tetrahedra.hpp"
#include "sound_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  fuzz::reads_or_refuses("input.step", [&] {
    MshModel model;
    try {
      model = unpacked({reinterpret_cast<const char*>(data), size});
    } catch (const std::runtime_error&) {
      return;
    }
    std::vector<std::string> notes;
    const Mesh mesh = mesh_of(model, "input.step", notes);
    fuzz::need_sound(mesh);
    if (mesh.type == CellType::tet15)
      fuzz::need_sound(mesh_of(split_into_hexahedra(model), "input.step", notes));
  });
  return 0;
}

// Text -> a mesh of Abaqus or CalculiX whose indices all lead somewhere.
#include "fuzz.hpp"
#include "meshing/exchange.hpp"
#include "sound_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  fuzz::reads_or_refuses("input.inp", [&] {
    std::vector<std::string> notes;
    const Mesh mesh =
        parse_inp(std::string(reinterpret_cast<const char*>(data), size), "input.inp", notes);
    fuzz::need(mesh.n_cells() > 0);
    fuzz::need_sound(mesh);
  });
  return 0;
}

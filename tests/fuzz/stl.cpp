// Bytes -> a surface of triangles whose corners all lead somewhere, at positions that are numbers.
#include "fuzz.hpp"
#include "meshing/closed_surface.hpp"
#include "meshing/read_surface.hpp"
#include "sound_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  fuzz::reads_or_refuses("input.stl", [&] {
    const Triangles surface =
        parse_surface(std::string(reinterpret_cast<const char*>(data), size), "input.stl");
    const int n = static_cast<int>(surface.points.size());
    fuzz::need(!surface.corners.empty());
    for (const Vec3& x : surface.points) fuzz::need(x.allFinite());
    for (const auto& [a, b, c] : surface.corners)
      fuzz::need(a >= 0 && a < n && b >= 0 && b < n && c >= 0 && c < n && a != b && b != c &&
                 c != a);
  });
  // as a solid: whatever its triangles, they enclose one or are refused
  fuzz::reads_or_refuses("input.stl", [&] {
    const Triangles surface = parse_surface(std::string(reinterpret_cast<const char*>(data), size),
                                            "input.stl", FlatTriangles::allowed);
    require_closed(surface, "input.stl");
    fuzz::need(surface.corners.size() >= 2);
    fuzz::need(enclosed_volume(surface) >= 0);
  });
  return 0;
}

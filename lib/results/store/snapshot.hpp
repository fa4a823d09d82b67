// A snapshot: one state of a mesh with fields, as static VTKHDF that every ParaView since 5.11
// opens. docs/schema.md
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "results/store/identity.hpp"

namespace langer {

// A field of points or elements. Its components are 1 (scalar), 3 (vector), 6 (symmetric tensor in
// the order 11 22 33 12 23 13, which is also VTK's) or 9 (tensor by rows).
struct Field {
  std::string name, unit;
  int components = 1;
  std::vector<double> values;
};

// A field whose values are all the same.
inline Field field(std::string name, std::string unit, int components, std::size_t rows,
                   double value = 0) {
  return {std::move(name), std::move(unit), components,
          std::vector<double>(rows * static_cast<std::size_t>(components), value)};
}
// Sets the components of one row.
void put(Field& f, std::size_t row, const auto& values) {
  for (int i = 0; i < f.components; ++i)
    f.values[row * static_cast<std::size_t>(f.components) + static_cast<std::size_t>(i)] =
        values[i];
}

// Writes the positions of the mesh: add the displacement to them beforehand for a deformed
// picture. `time` is that of the state, in FieldData/TimeValue. The first scalar, vector and
// symmetric tensor are marked as VTK's active fields.
void write_snapshot(const std::string& path, const Mesh& mesh,
                    const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields,
                    const Identity& identity, double time = 0);

}  // namespace langer

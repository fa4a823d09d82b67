// A snapshot: one state of a mesh with fields, as static VTKHDF that every ParaView since 5.11
// opens.  docs/schema.md
#pragma once

#include <string>
#include <vector>

#include "mechanics/mesh/mesh.hpp"
#include "results/store/identity.hpp"

namespace langer {

// components per point or cell: 1, 3 (vector), 6 (symmetric tensor in our order 11 22 33 12 23 13,
// VTK's too), 9 (rows)
struct Field {
  std::string name, unit;
  int components = 1;
  std::vector<double> values;
};

inline Field field(std::string name, std::string unit, int components, std::size_t rows,
                   double value = 0) {
  return {std::move(name), std::move(unit), components,
          std::vector<double>(rows * static_cast<std::size_t>(components), value)};
}
void put(Field& f, std::size_t row, const auto& values) {
  for (int i = 0; i < f.components; ++i)
    f.values[row * static_cast<std::size_t>(f.components) + static_cast<std::size_t>(i)] =
        values[i];
}

// the mesh's own positions are written: shift them by the displacement beforehand for a deformed
// picture time: of the state, in FieldData/TimeValue; the first scalar, vector and symmetric tensor
// are marked as VTK's active ones
void write_snapshot(const std::string& path, const Mesh& mesh,
                    const std::vector<Field>& point_fields, const std::vector<Field>& cell_fields,
                    const Identity& identity, double time = 0);

}  // namespace langer

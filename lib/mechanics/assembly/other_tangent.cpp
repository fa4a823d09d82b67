// Tangents of a body under other constraints than those of its equilibrium.
#include <utility>

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/assembly/folded_cell.hpp"

namespace langer {

OtherTangent Assembler::tangent_under(Dofs dofs) const {
  Pattern pattern = make_pattern(body_.mesh(), body_.moving_nodes(), dofs, body_.own_cells());
  return {std::move(dofs), std::move(pattern)};
}

bool Assembler::assemble_under(const VecX& u, std::span<OtherTangent> others) const {
  for (OtherTangent& other : others) other.K.assign(other.pattern.nnz(), 0);
  PacketElement out(body_.n_nodes(), body_.n_pressures());
  for (std::size_t b = 0; b < packets_.blocks().size(); ++b) {
    packets_.evaluate(b, u, pressures_, viscous_, true, out);
    if (!(smallest(out.J_min) > 0)) return false;
    const ElementPackets::Block& block = packets_.blocks()[b];
    for (int lane = 0; lane < block.n; ++lane) {
      const int e = block.cells[lane];
      for (OtherTangent& other : others) {
        FoldedCell(other.pattern, other.dofs, e, body_.nodes(e)).add(out, lane, other.K);
      }
    }
  }
  if (loads_.empty()) return true;
  const auto displacements = [&](int e) {
    return body_.displacements(u, e);
  };
  const auto add = [&](int e, const ElementNodes&, const MatX* stiffness) {
    if (!stiffness) return;
    for (OtherTangent& other : others) {
      FoldedCell(other.pattern, other.dofs, e, body_.nodes(e)).add(*stiffness, other.K);
    }
  };
  loads_.each(t_loads_, displacements, true, add);
  return true;
}

}  // namespace langer

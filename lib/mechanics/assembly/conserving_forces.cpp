#include "mechanics/assembly/conserving_forces.hpp"

#include "mechanics/element/conserving_solid.hpp"

namespace langer {

void ConservingForces::begin(const VecX& u0) {
  u0_ = u0;
  skew_.resize(static_cast<std::size_t>(body_.mesh().n_cells()));
}

void ConservingForces::evaluate(const ElementPackets::Block& block, const VecX& u_m,
                                const PressureField& pressures, bool with_tangent,
                                PacketElement& out) {
  const int n_dofs = body_.n_dofs();
  const int n_pressures = body_.n_pressures();
  ConservingElement one;
  std::vector<double> p(static_cast<std::size_t>(n_pressures));
  for (int l = 0; l < block.n; ++l) {
    const int e = block.cells[l];
    for (int k = 0; k < n_pressures; ++k) p[k] = pressures.modal_pressure(e, k);
    const ElementNodes start = body_.displacements(u0_, e);
    const ElementNodes end = 2 * body_.displacements(u_m, e) - start;
    const bool valid = conserving_solid(body_.formulation(), body_.material(e),
                                        pressures.bubble_modulus(e), body_.geometry(e),
                                        body_.fibres(e), start, end, p.data(), with_tangent, one);
    out.W.set(l, one.W);
    out.J_min.set(l, one.J_min);
    if (!valid) continue;

    for (int k = 0; k < n_pressures; ++k) {
      out.J_minus_1[k].set(l, one.J_minus_1[k]);
      for (int i = 0; i < n_dofs; ++i) out.dJ_du(k)[i].set(l, one.dJ_du[k][i]);
    }
    for (int i = 0; i < n_dofs; ++i) out.f[i].set(l, one.f[i]);
    if (!with_tangent) continue;
    int entry = 0;
    for (int i = 0; i < n_dofs; ++i) {
      for (int j = 0; j <= i; ++j) {
        out.K[entry].set(l, 0.5 * (one.K(i, j) + one.K(j, i)));
        ++entry;
      }
    }
    skew_[static_cast<std::size_t>(e)] = 0.5 * (one.K - one.K.transpose());
  }
  // Lanes that repeat an element must not decide on the smallest J.
  for (int l = block.n; l < Packet::lanes; ++l) out.J_min.set(l, out.J_min[0]);
}

VecX ConservingForces::skew_times(const VecX& du) const {
  VecX out = VecX::Zero(body_.dofs().n);
  VecX q(body_.n_dofs());
  for (int e : body_.own_cells()) {
    const ElementNodes moved = body_.displacements(du, e);
    for (int i = 0; i < body_.n_dofs(); ++i) q[i] = moved(i / 3, i % 3);
    const VecX f = skew_[static_cast<std::size_t>(e)] * q;
    const auto nodes = body_.nodes(e);
    for (int a = 0; a < body_.n_nodes(); ++a) {
      body_.add_force(out, nodes[a], e, f.segment<3>(3 * a));
    }
  }
  return out;
}

}  // namespace langer

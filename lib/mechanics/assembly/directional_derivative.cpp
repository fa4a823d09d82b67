// Derivatives of the balance of forces in a direction, and forces of other material parameters:
// what direct differentiation needs from a body.
#include <cmath>
#include <utility>

#include "mechanics/assembly/assembler.hpp"

namespace langer {

Assembler::Forces Assembler::forces_of(std::vector<Material> materials, Directions directions,
                                       const VecX& u) {
  // Everything that the assembly of other materials changes is kept, and put back afterwards.
  const std::vector<Material> own_materials = body_.materials();
  const Directions own_directions = body_.directions();
  const PressureField::State pressures = pressures_.state();
  const Sums sums = sums_;

  set_materials(std::move(materials), std::move(directions));
  pressures_from(u);
  assemble(u, false);
  Forces out{sums_.f, sums_.W};

  set_materials(own_materials, own_directions);
  pressures_.restore(pressures);
  sums_ = sums;
  return out;
}

VecX Assembler::nonsymmetric_part(const VecX& u, const VecX& v, double* W) {
  VecX out;
  if (W) *W = 0;
  if (body_.formulation() == Formulation::linear_dilatation) out = bubble_part(u, v, W);
  if (!loads_.follow()) return out;
  if (out.size() == 0) return VecX(-skew_pressures(u, v));
  return VecX(out - skew_pressures(u, v));
}

VecX Assembler::bubble_part(const VecX& u, const VecX& v, double* W_change) {
  const std::vector<double> change = pressures_.bubble_modulus_change(v);
  if (change.empty()) return VecX::Zero(body_.dofs().n);
  const Forces out = bubble_change(u, change);
  if (W_change) *W_change = out.W;
  return out.f;
}

// Forces and energy are linear in the bubble moduli: one assembly with changed moduli gives the
// derivative. The change is scaled to the size of the moduli, so that rounding stays small.
Assembler::Forces Assembler::bubble_change(const VecX& u, const std::vector<double>& change) {
  double largest = 0;
  for (double one : change) largest = std::max(largest, std::abs(one));
  if (largest == 0) return {VecX::Zero(body_.dofs().n), 0};
  const PressureField::State state = pressures_.state();
  double size = 0;
  for (double modulus : state.bubble_modulus) size = std::max(size, modulus);
  const Sums sums = sums_;

  pressures_.add_to_bubble_moduli(size / largest, change);
  assemble(u, false);
  const double share = largest / size;
  const Forces out{share * (sums_.f - sums.f), share * (sums_.W - sums.W)};

  pressures_.restore(state);
  sums_ = sums;
  return out;
}

VecX Assembler::skew_pressures(const VecX& u, const VecX& du) const {
  VecX out = VecX::Zero(body_.dofs().n);
  const auto displacements_of = [this](const VecX& values) {
    return [this, &values](int e) {
      return body_.displacements(values, e);
    };
  };
  const auto add = [&](int e, const ElementNodes& change) {
    add_forces(e, change, out);
  };
  loads_.each_skew(t_loads_, displacements_of(u), displacements_of(du), add);
  return out;
}

// S v, with the stiffness S of the loads that K() contains.
VecX Assembler::loads_times(const VecX& u, const VecX& v) const {
  VecX out = VecX::Zero(body_.dofs().n);
  const auto displacements = [&](int e) {
    return body_.displacements(u, e);
  };
  const auto add = [&](int e, const ElementNodes&, const MatX* stiffness) {
    if (!stiffness) return;
    const ElementNodes q = body_.displacements(v, e);
    const auto nodes = body_.nodes(e);
    for (int a = 0; a < body_.n_nodes(); ++a) {
      Vec3 f = Vec3::Zero();
      for (int b = 0; b < body_.n_nodes(); ++b) {
        const Mat3 K = stiffness->block<3, 3>(3 * a, 3 * b);
        f += K * q.row(b).transpose();
      }
      body_.add_force(out, nodes[a], e, f);
    }
  };
  loads_.each(t_loads_, displacements, true, add);
  return out;
}

std::vector<VecX> Assembler::prescribed_rows_times(const VecX& u,
                                                   const std::vector<VecX>& v) const {
  const Dofs& dofs = body_.dofs();
  std::vector<VecX> out(v.size(), VecX::Zero(dofs.n));
  std::vector<char> prescribed(static_cast<std::size_t>(dofs.n), 0);
  for (const Prescribed& p : dofs.prescribed) prescribed[static_cast<std::size_t>(p.dof)] = 1;

  const auto has_prescribed = [&](const ElementPackets::Block& block) {
    for (int l = 0; l < block.n; ++l) {
      for (int node : body_.nodes(block.cells[l])) {
        for (int k = 0; k < 3; ++k) {
          if (prescribed[static_cast<std::size_t>(3 * dofs.node(node) + k)]) return true;
        }
      }
    }
    return false;
  };
  PacketElement element(body_.n_nodes(), body_.n_pressures());
  for (std::size_t b = 0; b < packets_.blocks().size(); ++b) {
    const ElementPackets::Block& block = packets_.blocks()[b];
    if (!has_prescribed(block)) continue;
    packets_.evaluate(b, u, pressures_, viscous_, true, element);
    for (int l = 0; l < block.n; ++l) {
      const int e = block.cells[l];
      const auto nodes = body_.nodes(e);
      for (std::size_t j = 0; j < v.size(); ++j) {
        const ElementNodes q = body_.displacements(v[j], e);
        VecX f = VecX::Zero(body_.n_dofs());
        int entry = 0;
        for (int i = 0; i < body_.n_dofs(); ++i) {
          for (int m = 0; m <= i; ++m) {
            f[i] += element.K[entry][l] * q(m / 3, m % 3);
            if (m < i) f[m] += element.K[entry][l] * q(i / 3, i % 3);
            ++entry;
          }
        }
        for (int a = 0; a < body_.n_nodes(); ++a) {
          body_.add_force(out[j], nodes[a], e, f.segment<3>(3 * a));
        }
      }
    }
  }
  if (loads_.follow()) {
    for (std::size_t j = 0; j < v.size(); ++j) out[j] += loads_times(u, v[j]);
  }
  for (VecX& f : out) {
    for (int dof = 0; dof < dofs.n; ++dof) {
      if (!prescribed[static_cast<std::size_t>(dof)]) f[dof] = 0;
    }
  }
  return out;
}

}  // namespace langer

// The cell of solid.hpp for eight elements of one material at once: same integrals over the
// reference volume, with stress and tangent pushed forward to the deformed state, where the strain
// operator is sparse.   [A23] eqs 28-33
//   K_ab = integral B_a^T c B_b + (g_a . tau g_b) I dV0,   g_a = F^-T dN_a/dX,  tau = F S F^T,  c = push-forward of D
// Handles sums of terms in I1_bar and of up to four active fibre families. For all others
// packet_form() is false, and solid() computes the elements one by one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/tensor/packet.hpp"
#include "core/tensor/voigt.hpp"
#include "mechanics/element/solid.hpp"

namespace langer {

// The geometry of eight elements: gradients dN_dX[n_dofs g + 3 a + k], weights, modes[n_modes g +
// k], volume, and the fibre directions a0[family][k].
struct PacketGeometry {
  int n_nodes = 0, n_gauss = 0;
  std::vector<Packet> dN_dX, w, mode;
  Packet V;
};
struct PacketFibre {
  Packet a[3];
};

// The terms of viscous branches in an increment of eight elements (CellMemory): H[6 g + p]
struct PacketMemory {
  Amplified amplified;
  const Packet* H;
};

struct PacketElement {
  PacketElement(int n_nodes, int n_pressures);
  int n_dofs;
  std::vector<Packet> f;
  std::vector<Packet> K;  // lower triangle by rows: entry (i, j <= i) at i (i + 1) / 2 + j
  Packet W, J_min;
  std::vector<Packet> J_minus_1;  // as SolidElement has them
  std::vector<Packet> gradients;
  Packet* dJ_du(int k) { return gradients.data() + k * n_dofs; }
  const Packet* dJ_du(int k) const { return gradients.data() + k * n_dofs; }
};

bool packet_form(const Material& material);

PacketGeometry packed(const ElementGeometry* const geometry[Packet::lanes]);

// u[3 a + k]; p_tangent: one packet for each dilatation, or nullptr. Check J_min > 0 before using
// the rest.
void packet_solid(Formulation formulation, const Material& material, const Packet& local,
                  const PacketGeometry& geometry, const PacketFibre* fibres, const Packet* u,
                  const Packet* p_tangent, bool with_tangent, PacketElement& out,
                  const PacketMemory* memory = nullptr);

// Isochoric Kirchhoff stress of eight points of one material with the same fibre directions; F by
// rows, tau in the order of voigt.hpp.
void packet_stress(const Material& material, const Packet F[9], const Packet& J,
                   std::span<const Vec3> a, Packet tau[6]);

// J - 1 at each Gauss point of displaced elements
void packet_dilatations(const PacketGeometry& geometry, const Packet* u, Packet* J_minus_1);

}  // namespace langer

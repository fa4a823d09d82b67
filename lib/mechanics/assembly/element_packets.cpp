#include "mechanics/assembly/element_packets.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace langer {

// A packet computes eight elements of one body at once, one in each lane of the vector unit. The
// last packet of a body repeats its last element in the lanes that are left.
ElementPackets::ElementPackets(const BodyModel& body, Kernel kernel)
    : body_(body), requested_(kernel), kernel_(kernel) {
  choose_kernel();
  make_blocks();
}

// Some materials have no packet form; then all elements are computed one by one.
void ElementPackets::choose_kernel() {
  kernel_ = requested_;
  for (const Material& material : body_.materials()) {
    if (!packet_form(material)) kernel_ = Kernel::one_by_one;
  }
}

void ElementPackets::update_materials() {
  choose_kernel();
  pack_fibres();
}

// Blocks of eight elements of one material, and their geometry with a lane for each element.
void ElementPackets::make_blocks() {
  const Mesh& mesh = body_.mesh();
  std::vector<std::vector<int>> elements_of(std::max<std::size_t>(1, mesh.bodies.size()));
  for (int e : body_.own_cells()) elements_of[mesh.body.empty() ? 0 : mesh.body[e]].push_back(e);

  for (const auto& elements : elements_of) {
    for (std::size_t first = 0; first < elements.size(); first += Packet::lanes) {
      Block block;
      block.n = static_cast<int>(std::min<std::size_t>(Packet::lanes, elements.size() - first));
      const ElementGeometry* geometry[Packet::lanes];
      for (int l = 0; l < Packet::lanes; ++l) {
        block.cells[l] = elements[first + std::min(l, block.n - 1)];
        geometry[l] = &body_.geometry(block.cells[l]);
      }
      blocks_.push_back(block);
      geometry_.push_back(packed(geometry));
    }
  }
  pack_fibres();
}

void ElementPackets::pack_fibres() {
  fibres_.resize(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    fibres_[b].resize(body_.fibres(blocks_[b].cells[0]).size());
    for (int l = 0; l < Packet::lanes; ++l) {
      for (std::size_t k = 0; k < fibres_[b].size(); ++k) {
        for (int i = 0; i < 3; ++i) {
          fibres_[b][k].a[i].set(l, body_.fibres(blocks_[b].cells[l])[k][i]);
        }
      }
    }
  }
}

// What the viscous branches add to the stress, which is constant during a step.
void ElementPackets::pack_history(const ViscousState& viscous) {
  if (!viscous.present() || kernel_ != Kernel::packets) return;
  history_.resize(blocks_.size());
  const int n_gauss = body_.mesh().cell().n_gauss;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (!viscous.present(blocks_[b].cells[0])) continue;
    history_[b].resize(6 * static_cast<std::size_t>(n_gauss));
    for (int l = 0; l < Packet::lanes; ++l) {
      for (int g = 0; g < n_gauss; ++g) {
        const Vec6 H = viscous.points()->H(blocks_[b].cells[l], g);
        for (int p = 0; p < 6; ++p) {
          history_[b][static_cast<std::size_t>(6 * g + p)].set(l, H[p]);
        }
      }
    }
  }
}

// The displacements of a block. Elements with hanging nodes get those of their own nodes, which
// follow from the nodes around.
void ElementPackets::load(const Block& block, const VecX& u, Packet* q) const {
  const int n_nodes = body_.n_nodes();
  for (int l = 0; l < Packet::lanes; ++l) {
    const int e = block.cells[l];
    if (body_.tied(e)) {
      const ElementNodes q_e = body_.displacements(u, e);
      for (int a = 0; a < n_nodes; ++a) {
        for (int k = 0; k < 3; ++k) q[3 * a + k].set(l, q_e(a, k));
      }
      continue;
    }
    const auto nodes = body_.nodes(e);
    for (int a = 0; a < n_nodes; ++a) {
      for (int k = 0; k < 3; ++k) q[3 * a + k].set(l, u[3 * nodes[a] + k]);
    }
  }
}

void ElementPackets::evaluate(std::size_t b, const VecX& u, const PressureField& pressures,
                              const ViscousState& viscous, bool with_tangent,
                              PacketElement& out) const {
  if (kernel_ == Kernel::packets) {
    evaluate_packet(b, u, pressures, viscous, with_tangent, out);
  } else {
    evaluate_one_by_one(blocks_[b], u, pressures, viscous, with_tangent, out);
  }
}

void ElementPackets::evaluate_packet(std::size_t b, const VecX& u, const PressureField& pressures,
                                     const ViscousState& viscous, bool with_tangent,
                                     PacketElement& out) const {
  const Block& block = blocks_[b];
  const int first = block.cells[0];
  Packet q[most_dofs];
  Packet p[most_gauss];
  Packet bubble;
  load(block, u, q);
  for (int l = 0; l < Packet::lanes; ++l) {
    const int e = block.cells[l];
    bubble.set(l, pressures.bubble_modulus(e));
    for (int k = 0; k < body_.n_pressures(); ++k) p[k].set(l, pressures.modal_pressure(e, k));
  }
  PacketMemory memory{};
  const bool is_viscous = viscous.present(first);
  if (is_viscous) memory = PacketMemory{viscous.points()->amplified(first), history_[b].data()};
  packet_solid(body_.formulation(), body_.material(first), bubble, geometry_[b], fibres_[b].data(),
               q, p, with_tangent, out, is_viscous ? &memory : nullptr);
}

void ElementPackets::evaluate_one_by_one(const Block& block, const VecX& u,
                                         const PressureField& pressures,
                                         const ViscousState& viscous, bool with_tangent,
                                         PacketElement& out) const {
  const int n_dofs = body_.n_dofs();
  const int n_pressures = body_.n_pressures();
  SolidElement one;
  std::vector<double> p(n_pressures);
  for (int l = 0; l < block.n; ++l) {
    const int e = block.cells[l];
    for (int k = 0; k < n_pressures; ++k) p[k] = pressures.modal_pressure(e, k);
    std::optional<CellMemory> memory;
    if (viscous.present(e)) memory = viscous.points()->memory(e);
    const bool valid =
        solid(body_.formulation(), body_.material(block.cells[0]), pressures.bubble_modulus(e),
              body_.geometry(e), body_.fibres(e), body_.displacements(u, e), p.data(), with_tangent,
              one, memory ? &*memory : nullptr);
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
        out.K[entry].set(l, one.K(i, j));
        ++entry;
      }
    }
  }
  // Lanes that repeat an element must not decide on the smallest J.
  for (int l = block.n; l < Packet::lanes; ++l) out.J_min.set(l, out.J_min[0]);
}

// The smallest volume ratio at any Gauss point: a line search asks before it computes stresses.
double ElementPackets::smallest_J(const VecX& u) const {
  double J_min = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Packet q[most_dofs];
    Packet J_minus_1[most_gauss];
    load(blocks_[b], u, q);
    packet_dilatations(geometry_[b], q, J_minus_1);
    for (int g = 0; g < geometry_[b].n_gauss; ++g) {
      J_min = std::min(J_min, 1 + smallest(J_minus_1[g]));
    }
  }
  return J_min;
}

}  // namespace langer

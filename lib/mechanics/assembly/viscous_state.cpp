// Increments of a viscous body: what it remembers at their beginning, and how its branches follow.
#include "mechanics/assembly/equilibrium.hpp"

namespace langer {

void Equilibrium::begin_increment(double seconds) {
  if (!viscous_) return;
  viscous_->begin(seconds);
  if (kernel_ != Kernel::packets) return;
  packet_H_.resize(blocks_.size());
  const int n_gauss = mesh_.cell().n_gauss;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (!viscous_->has(blocks_[b].cells[0])) continue;
    packet_H_[b].resize(6 * static_cast<std::size_t>(n_gauss));
    for (int l = 0; l < Packet::lanes; ++l)
      for (int g = 0; g < n_gauss; ++g) {
        const Vec6 H = viscous_->H(blocks_[b].cells[l], g);
        for (int p = 0; p < 6; ++p) packet_H_[b][static_cast<std::size_t>(6 * g + p)].set(l, H[p]);
      }
  }
}

double Equilibrium::end_increment(const VecX& u) {
  if (!viscous_) return 0;
  for (int e = 0; e < mesh_.n_cells(); ++e)
    viscous_->end(e, material(e), geometry_[e], fibres(e), element_displacements(u, e));
  return viscous_->error();
}

void Equilibrium::accept_increment(const VecX& u0, const VecX& u) {
  if (!viscous_) return;
  for (int e = 0; e < mesh_.n_cells(); ++e)
    viscous_->accept(e, geometry_[e], element_displacements(u0, e), element_displacements(u, e));
  viscous_->accepted();
}

double Equilibrium::viscous_work() const {
  double sum = 0;
  for (int e = 0; viscous_ && e < mesh_.n_cells(); ++e)
    for (int g = 0; viscous_->has(e) && g < geometry_[e].n_gauss(); ++g)
      sum += geometry_[e].w[g] * viscous_->work(e, g);
  return sum;
}

}  // namespace langer

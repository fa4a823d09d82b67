#include "mechanics/assembly/assembler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/in_order.hpp"

namespace langer {

Assembler::Assembler(const Mesh& mesh, std::vector<Material> materials, Directions directions,
                     Formulation formulation, Dofs dofs, int threads, Kernel kernel,
                     const std::vector<double>& cell_share, std::optional<Division> division,
                     Loads loads)
    : body_(mesh, std::move(materials), std::move(directions), formulation, std::move(dofs),
            cell_share, std::move(division)),
      packets_(body_, kernel),
      pressures_(body_),
      viscous_(body_),
      tangent_(body_, packets_.blocks()),
      threads_(threads),
      conserving_(body_) {
  sums_.f = VecX::Zero(body_.dofs().n);
  sums_.K_du = sums_.f;
  if (!loads.empty()) set_loads(std::move(loads));
  begin_increment(0);
}

void Assembler::set_loads(Loads loads) {
  loads_ = std::move(loads);
  sums_.f_ext = VecX::Zero(body_.dofs().n);
}

void Assembler::begin_increment(double seconds) {
  viscous_.begin(seconds);
  packets_.pack_history(viscous_);
}

void Assembler::begin_small_movements(const std::function<double(const ViscousBranch&)>& follow) {
  viscous_.begin_small_movements(follow);
  packets_.pack_history(viscous_);
}

bool Assembler::assemble(const VecX& u, bool with_tangent, const VecX* du_prescribed) {
  // A thread evaluates a chunk of blocks before it waits for its turn to add them; the chunk stays
  // in its cache.
  int chunk = 8;
  if (threads_ == 1) {
    chunk = 1;
  } else if (body_.mesh().cell().second_order()) {
    chunk = 2;
  }
  const int n = static_cast<int>(packets_.blocks().size());
  const int n_chunks = (n + chunk - 1) / chunk;

  sums_.f.setZero();
  sums_.K_du.setZero();
  if (with_tangent) tangent_.begin();
  sums_.W = 0;
  sums_.J_min = std::numeric_limits<double>::infinity();
  sums_.floor = 0;

  std::vector<PacketElement> out(static_cast<std::size_t>(chunk) * threads_,
                                 PacketElement(body_.n_nodes(), body_.n_pressures()));
  const auto first = [chunk](int c) {
    return c * chunk;
  };
  const auto last = [n, chunk](int c) {
    return std::min(n, (c + 1) * chunk);
  };
  in_order(
      threads_, n_chunks,
      [&](int worker, int c) {
        for (int b = first(c); b < last(c); ++b) {
          PacketElement& element = out[worker * chunk + b - first(c)];
          const auto block = static_cast<std::size_t>(b);
          if (conserving_.active()) {
            conserving_.evaluate(packets_.blocks()[block], u, pressures_, with_tangent, element);
          } else {
            packets_.evaluate(block, u, pressures_, viscous_, with_tangent, element);
          }
        }
      },
      [&](int worker, int c) {
        for (int b = first(c); b < last(c); ++b) {
          const PacketElement& element = out[worker * chunk + b - first(c)];
          sums_.J_min = std::min(sums_.J_min, smallest(element.J_min));
          if (sums_.J_min > 0) {
            add_block(static_cast<std::size_t>(b), element, u, with_tangent, du_prescribed);
          }
        }
      });
  if (body_.division()) sum_over_ranks(with_tangent);
  sums_.floor = std::sqrt(sums_.floor);
  if (!loads_.empty() && sums_.J_min > 0) add_loads(u, with_tangent, du_prescribed);
  if (added_ && sums_.J_min > 0) {
    sums_.f += added_->force(u);
    if (with_tangent) tangent_.add(added_->tangent());
    if (with_tangent && du_prescribed) sums_.K_du += added_->tangent_times(*du_prescribed);
  }

  const bool valid = sums_.J_min > 0 && std::isfinite(sums_.W) && sums_.f.allFinite();
  if (valid) {
    pressures_.set_evaluated_at(u);
  } else {
    pressures_.set_evaluated_at(VecX());
  }
  return valid;
}

void Assembler::add_block(std::size_t b, const PacketElement& element, const VecX& u,
                          bool with_tangent, const VecX* du_prescribed) {
  const ElementPackets::Block& block = packets_.blocks()[b];
  for (int l = 0; l < block.n; ++l) {
    const int e = block.cells[l];
    add_internal_force(e, element, l);
    sums_.W += element.W[l];
    pressures_.store_dilatations(e, element, l);
    const double floor = rounding_error(e, u);
    sums_.floor += floor * floor;
    if (!with_tangent) continue;
    tangent_.add(e, element, l);
    if (du_prescribed) add_prescribed_effect(e, element, l, *du_prescribed);
  }
}

void Assembler::add_internal_force(int e, const PacketElement& element, int lane) {
  const auto nodes = body_.nodes(e);
  if (body_.tied(e)) {
    for (int a = 0; a < body_.n_nodes(); ++a) {
      const Vec3 force(element.f[3 * a][lane], element.f[3 * a + 1][lane],
                       element.f[3 * a + 2][lane]);
      body_.add_force(sums_.f, nodes[a], e, force);
    }
    return;
  }
  for (int a = 0; a < body_.n_nodes(); ++a) {
    for (int i = 0; i < 3; ++i) sums_.f[3 * nodes[a] + i] += element.f[3 * a + i][lane];
  }
}

// Rounding of u reaches the pressure through the gradient of the dilatation, and the force through
// it once more.
double Assembler::rounding_error(int e, const VecX& u) const {
  const auto nodes = body_.nodes(e);
  const int n_nodes = body_.n_nodes();
  double slope = 0;
  for (int k = 0; k < body_.n_pressures(); ++k) {
    const double* dJ = pressures_.gradient(e, k);
    if (!body_.tied(e)) {
      for (int i = 0; i < body_.n_dofs(); ++i) slope = std::max(slope, std::abs(dJ[i]));
      continue;
    }
    for (int a = 0; a < n_nodes; ++a) {
      Vec3 sum = Vec3::Zero();  // over the nodes up to a that move with the same unknowns
      for (int b = 0; b <= a; ++b) {
        if (body_.dofs().node(nodes[b]) == body_.dofs().node(nodes[a])) {
          sum += body_.dofs().tie[nodes[b]].T.transpose() * Vec3(dJ + 3 * b);
        }
      }
      slope = std::max(slope, sum.lpNorm<Eigen::Infinity>());
    }
  }
  double moved = 0;
  for (int a : nodes) {
    moved = std::max(moved, u.segment<3>(3 * body_.dofs().node(a)).lpNorm<Eigen::Infinity>());
  }
  return std::numeric_limits<double>::epsilon() * body_.bulk_modulus(e) * moved * slope * slope *
         body_.geometry(e).V;
}

// K du of one element, du being the displacement of prescribed unknowns that is still to be made.
void Assembler::add_prescribed_effect(int e, const PacketElement& element, int lane,
                                      const VecX& du_prescribed) {
  const ElementNodes du_nodes = body_.displacements(du_prescribed, e);
  if (du_nodes.isZero(0)) return;
  const int n_dofs = body_.n_dofs();
  std::array<double, most_dofs> du;
  std::array<double, most_dofs> K_du{};
  for (int i = 0; i < n_dofs; ++i) du[i] = du_nodes(i / 3, i % 3);
  int entry = 0;
  for (int i = 0; i < n_dofs; ++i) {
    for (int j = 0; j <= i; ++j) {
      K_du[i] += element.K[entry][lane] * du[j];
      if (j < i) K_du[j] += element.K[entry][lane] * du[i];
      ++entry;
    }
  }
  const auto nodes = body_.nodes(e);
  for (int a = 0; a < body_.n_nodes(); ++a) {
    body_.add_force(sums_.K_du, nodes[a], e, Vec3(&K_du[3 * a]));
  }
}

void Assembler::add_loads(const VecX& u, bool with_tangent, const VecX* du_prescribed) {
  sums_.f_ext.setZero();
  const auto displacements = [&](int e) {
    return body_.displacements(u, e);
  };
  const auto add = [&](int e, const ElementNodes& force, const MatX* stiffness) {
    add_forces(e, force, sums_.f_ext);
    if (stiffness) add_load_stiffness(e, *stiffness, du_prescribed);
  };
  loads_.each(t_loads_, displacements, with_tangent, add);
}

// Adds the nodal forces of an element (nodes, 3) to those of the body.
void Assembler::add_forces(int e, const ElementNodes& force, VecX& to) const {
  const auto nodes = body_.nodes(e);
  for (int a = 0; a < body_.n_nodes(); ++a) {
    body_.add_force(to, nodes[a], e, force.row(a).transpose());
  }
}

VecX Assembler::unit_pressure(int volume, const VecX& u) const {
  VecX out = VecX::Zero(body_.dofs().n);
  const auto add = [&](int e, const ElementNodes& force, const MatX*) {
    add_forces(e, force, out);
  };
  const auto displacements = [&](int e) {
    return body_.displacements(u, e);
  };
  loads_.each_unit(volume, displacements, add);
  return out;
}

double Assembler::swept_volume(int volume, const VecX& u) const {
  return loads_.swept_volume(volume, [&](int e) { return body_.displacements(u, e); });
}

VecX Assembler::load_forces(double t, const VecX& u) const {
  VecX out = VecX::Zero(body_.dofs().n);
  const auto add = [&](int e, const ElementNodes& force, const MatX*) {
    add_forces(e, force, out);
  };
  const auto displacements = [&](int e) {
    return body_.displacements(u, e);
  };
  loads_.each(t, displacements, false, add);
  return out;
}

void Assembler::add_load_stiffness(int e, const MatX& stiffness, const VecX* du_prescribed) {
  const auto nodes = body_.nodes(e);
  const int n_nodes = body_.n_nodes();
  tangent_.add(e, stiffness);
  if (!du_prescribed) return;
  const ElementNodes du = body_.displacements(*du_prescribed, e);
  if (du.isZero(0)) return;
  for (int a = 0; a < n_nodes; ++a) {
    Vec3 K_du = Vec3::Zero();
    for (int b = 0; b < n_nodes; ++b) {
      const Mat3 K = stiffness.block<3, 3>(3 * a, 3 * b);
      K_du += K * du.row(b).transpose();
    }
    body_.add_force(sums_.K_du, nodes[a], e, K_du);
  }
}

void Assembler::sum_over_ranks(bool with_tangent) {
  const Ranks* ranks = body_.division()->ranks;
  sums_.J_min = ranks->smallest(sums_.J_min);
  if (!(sums_.J_min > 0)) return;
  VecX all(sums_.f.size() + 2 + (with_tangent ? sums_.K_du.size() : 0));
  all << sums_.f, sums_.W, sums_.floor, sums_.K_du.head(all.size() - sums_.f.size() - 2);
  ranks->sum(all.data(), static_cast<std::size_t>(all.size()));
  sums_.f = all.head(sums_.f.size());
  sums_.W = all[sums_.f.size()];
  sums_.floor = all[sums_.f.size() + 1];
  if (with_tangent) sums_.K_du = all.tail(sums_.K_du.size());
}

double Assembler::smallest_J(const VecX& u) const {
  const double J_min = packets_.smallest_J(u);
  if (body_.division()) return body_.division()->ranks->smallest(J_min);
  return J_min;
}

void Assembler::pressures_from(const VecX& u) {
  if (!pressures_.evaluated_at(u) && !assemble(u, false)) return;
  pressures_.follow_dilatations();
}

void Assembler::extrapolate_pressures(const VecX& u_before, double s) {
  const std::vector<double> now = pressures_.state().p;
  pressures_from(u_before);
  pressures_.extrapolate(now, s);
}

void Assembler::begin_conserving(const VecX& u0) {
  conserving_.begin(u0);
  pressures_.set_evaluated_at(VecX());
}

void Assembler::set_materials(std::vector<Material> materials, Directions directions) {
  body_.set_materials(std::move(materials), std::move(directions));
  packets_.update_materials();
}

}  // namespace langer

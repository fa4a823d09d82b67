#include "mechanics/assembly/dofs.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/mesh/hanging.hpp"

namespace langer {

bool Prescribed::keeps_rate(double before, double now, double next) const {
  const auto steady = [&](const History& h) {
    return h.keeps_rate(before, now, next);
  };
  return steady({value, factor}) && (!turn || steady(turn->angle));
}

bool ties_nodes(const Dofs& dofs) {
  for (std::size_t i = 0; i < dofs.tie.size(); ++i) {
    if (dofs.tie[i].of != static_cast<int>(i) || !dofs.tie[i].T.isDiagonal(0)) return true;
  }
  return false;
}

Vec3 displacement(const Dofs& dofs, const VecX& u, int node) {
  if (dofs.tie.empty()) return u.segment<3>(3 * node);
  return dofs.tie[node].T * u.segment<3>(3 * dofs.tie[node].of);
}

DofsResult number_dofs(int n_nodes, std::vector<Prescribed> prescribed, std::vector<Image> tie,
                       const std::vector<HangingNode>& hanging) {
  DofsResult result;
  std::erase_if(prescribed,
                [&](const Prescribed& p) { return hanging_at(hanging, p.dof / 3) != nullptr; });
  Dofs& dofs = result.dofs;
  dofs.n = 3 * n_nodes;
  std::ranges::sort(prescribed, {}, &Prescribed::dof);
  for (const Prescribed& p : prescribed) {
    if (!dofs.prescribed.empty() && dofs.prescribed.back().dof == p.dof) {
      const Prescribed& other = dofs.prescribed.back();
      if (!other.moves_as(p) && result.conflict < 0) result.conflict = p.dof;
      continue;
    }
    dofs.prescribed.push_back(p);
  }
  dofs.equation.assign(dofs.n, 0);
  dofs.tie = std::move(tie);
  for (std::size_t i = 0; i < dofs.tie.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (dofs.tie[i].of != static_cast<int>(i) || dofs.tie[i].T(k, k) == 0)
        dofs.equation[3 * i + static_cast<std::size_t>(k)] = -1;
  for (const Prescribed& p : dofs.prescribed) dofs.equation[p.dof] = -1;
  for (const HangingNode& h : hanging)
    for (int k = 0; k < 3; ++k) dofs.equation[3 * h.node + k] = -1;
  for (int i = 0; i < dofs.n; ++i)
    if (dofs.equation[i] == 0) {
      dofs.equation[i] = dofs.n_free();
      dofs.free.push_back(i);
    }
  return result;
}

}  // namespace langer

#include "assembly/dofs.hpp"

#include <algorithm>
#include <cmath>

namespace langer {

bool Prescribed::goes_on(double before, double now, double next) const {
  const auto steady = [&](const History& h) { return h.goes_on(before, now, next); };
  return steady({value, factor}) && (!turn || steady(turn->angle));
}

DofsResult number_dofs(int n_nodes, std::vector<Prescribed> prescribed, std::vector<Image> tie) {
  DofsResult result;
  Dofs& dofs = result.dofs;
  dofs.n = 3 * n_nodes;
  std::sort(prescribed.begin(), prescribed.end(), [](const auto& a, const auto& b) { return a.dof < b.dof; });
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
  for (int i = 0; i < dofs.n; ++i)
    if (dofs.equation[i] == 0) {
      dofs.equation[i] = dofs.n_free();
      dofs.free.push_back(i);
    }
  return result;
}

}  // namespace langer

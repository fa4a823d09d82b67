#include "scene/model/hanging_constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace langer {

namespace {

using ByDof = std::map<int, const Prescribed*>;

// Whether the mean of those that it hangs on is prescribed as it is; turned places are linear in
// those at rest.
bool agrees(const HangingNode& h, int k, const Prescribed& own, const ByDof& by_dof) {
  double along = 0, across = 0, size = 0;
  for (int node : h.of) {
    const auto found = by_dof.find(3 * node + k);
    if (found == by_dof.end()) return false;
    const Prescribed& its = *found->second;
    if (its.turn.has_value() != own.turn.has_value()) return false;
    if (!own.turn && !its.moves_as(own)) return false;
    if (!own.turn) continue;
    if (its.value != own.value || !same_factor(its.factor, own.factor) ||
        !(its.turn->angle == own.turn->angle))
      return false;
    along += 0.25 * its.turn->along;
    across += 0.25 * its.turn->across;
    size = std::max(size, its.turn->radius());
  }
  return !own.turn || std::hypot(along - own.turn->along, across - own.turn->across) <= 1e-9 * size;
}

}  // namespace

std::vector<Complaint> not_on_cut_cells(const SolveConfig& config) {
  std::vector<Complaint> out;
  for (std::size_t i = 0; i < config.loads.size(); ++i)
    if (config.loads[i].on_surface())
      out.push_back(
          {fmt::format("loads[{}]", i), "found a force on a surface", "imposed displacements", ""});
  for (const auto& [name, contact] : config.contacts)
    if (contact.adhesion)
      out.push_back({"contacts." + name + ".adhesion", "found adhesion", "none", ""});
  const bool uncertain = config.uncertainty.value_or(UncertaintyBy::none) != UncertaintyBy::none;
  if (uncertain || !config.sensitivity.empty())
    out.push_back({uncertain ? "uncertainty" : "sensitivity", "found derivatives", "none", ""});
  return out;
}

std::vector<Error> hanging_errors(const SolveConfig& config, const Mesh& mesh,
                                  const std::vector<Prescribed>& prescribed,
                                  const std::function<Place(const std::string&)>& where) {
  std::vector<Error> errors;
  if (mesh.hanging.empty()) return errors;
  for (const Complaint& c : not_on_cut_cells(config))
    errors.push_back({where(c.key), c.key, c.found + ", next to cells that are cut", c.expected,
                      "a mesh without `cuts`"});
  ByDof by_dof;
  for (const Prescribed& p : prescribed) by_dof[p.dof] = &p;
  for (const HangingNode& h : mesh.hanging)
    for (int k = 0; k < 3; ++k) {
      const auto own = by_dof.find(3 * h.node + k);
      if (own == by_dof.end() || agrees(h, k, *own->second, by_dof)) continue;
      const Vec3& X = mesh.X[static_cast<std::size_t>(h.node)];
      errors.push_back(
          {where("supports"), "supports",
           fmt::format(
               "({:g}, {:g}, {:g}) is held or moved along {}, and is the middle of an edge or a facet of a "
               "larger cell that is not, as a whole",
               X[0], X[1], X[2], "xyz"[k]),
           "sets that end between facets",
           "cut the cells on both sides of the set's border, or none"});
      return errors;
    }
  return errors;
}

}  // namespace langer

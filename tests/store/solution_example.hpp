// A made-up run on the two cubes of example.hpp: every number of a step is a known function of the
// step.
#pragma once

#include "example.hpp"
#include "results/store/solution_file.hpp"

namespace langer::example {

inline SolutionHeader header(bool contact) {
  SolutionHeader h;
  h.mesh = bar();
  h.material.matrix = {Yeoh{0.269, 0.376, 0.415}};
  h.material.fibres = {{HgoFibre{-0.317, 0.319}, 30, FibreSwitch::I4_bar}};
  h.material.volume = QuadraticVolume{1e-3};
  h.formulation = "mean_dilatation";
  if (contact) h.contact_nodes = {{"indenter", {3, 4, 5}}};
  if (contact)
    h.indenter_surfaces["indenter"] = {{{0, 1, 0}, {0, 1, 0.1}, {1, 1.5, 1.0 / 3}, {0.5, 2, 0}},
                                       {{0, 1, 2}, {2, 1, 3}}};
  h.identity = identity();
  h.identity.stage = "solve";
  return h;
}

inline StepRecord step(int i, bool contact) {
  StepRecord r;
  r.t = 0.1 * (i + 1), r.increment = 0.1, r.iterations = 3 + i % 2, r.residual = 1e-9 * (i + 1);
  for (int n = 0; n < 12; ++n) {
    r.u.emplace_back(i, n, -0.5 * i * n);
    r.reaction.emplace_back(1, i, n / 3.0);
  }
  r.cell_fields = {{"J", {1.0 + i, 2.0 + i}}, {"von_mises", {0.1 * i, 0.2 * i}}};
  r.scalars = {{"penetration", 1e-12 * i}};
  if (!contact) return r;
  r.u_ind = {0, -0.1 * i, 0}, r.force_ind = {0.01, 1.0 * i, 0};
  r.contacts["indenter"] = {{{0, 1, 0}, {0, 2.0 * i, 0}, {0, 0, 0}}, {1, 2, 0}, {0, 0, 0.5}};
  return r;
}

inline bool same(const StepRecord& a, const StepRecord& b) {
  bool contacts = a.contacts.size() == b.contacts.size();
  for (const auto& [name, c] : a.contacts) {
    const auto found = b.contacts.find(name);
    contacts = contacts && found != b.contacts.end() && c.r == found->second.r &&
               c.status == found->second.status && c.gap == found->second.gap;
  }
  return contacts && a.t == b.t && a.increment == b.increment && a.iterations == b.iterations &&
         a.residual == b.residual && a.u == b.u && a.reaction == b.reaction &&
         a.cell_fields == b.cell_fields && a.scalars == b.scalars && a.u_ind == b.u_ind &&
         a.force_ind == b.force_ind;
}

}  // namespace langer::example

#include "mechanics/solve/cell_stability.hpp"

#include <vector>

#include "core/tensor/dense.hpp"

namespace langer {

namespace {

// What decides the tangent of a cell: its shape, its movement and its fibres, all of them without
// the place of the cell.
struct CellState {
  ElementNodes shape, u;
  std::vector<Vec3> fibres;
  int body = 0;
};

bool are_alike(const CellState& a, const CellState& b) {
  constexpr double same = 1e-10;
  if (a.body != b.body || a.fibres != b.fibres) return false;
  const double size = a.shape.norm();
  return (a.shape - b.shape).norm() <= same * size && (a.u - b.u).norm() <= same * size;
}

CellState state_of_cell(const Assembler& body, const VecX& u, int e) {
  CellState state;
  state.shape = element_nodes(body.mesh(), e);
  state.shape.rowwise() -= state.shape.row(0).eval();
  state.u = body.element_displacements(u, e);
  state.u.rowwise() -= state.u.row(0).eval();
  state.fibres.assign(body.fibres(e).begin(), body.fibres(e).end());
  if (!body.mesh().body.empty()) state.body = body.mesh().body[static_cast<std::size_t>(e)];
  return state;
}

bool resists(const Assembler& body, const VecX& u, int e) {
  // rigid movements leave zeros, which rounding turns to either side
  constexpr double rounding = 1e-11;
  SolidElement cell;
  const bool admissible =
      solid(body.formulation(), body.material(e), 0, body.geometry(e), body.fibres(e),
            body.element_displacements(u, e), nullptr, true, cell);
  if (!admissible) return false;
  const VecX eigenvalues = symmetric_eigenvalues(cell.K);
  return eigenvalues.minCoeff() >= -rounding * eigenvalues.cwiseAbs().maxCoeff();
}

}  // namespace

bool every_cell_resists(const Assembler& body, const VecX& u) {
  if (body.viscous() || body.loads().follow() || body.division()) return false;
  if (body.formulation() == Formulation::linear_dilatation) return false;
  constexpr std::size_t kinds_kept = 8;  // a graded block has many, next to each other
  std::vector<CellState> known;
  for (int e = 0; e < body.mesh().n_cells(); ++e) {
    const CellState state = state_of_cell(body, u, e);
    bool seen = false;
    for (const CellState& other : known) seen = seen || are_alike(state, other);
    if (seen) continue;
    if (!resists(body, u, e)) return false;
    if (known.size() == kinds_kept) known.erase(known.begin());
    known.push_back(state);
  }
  return true;
}

}  // namespace langer

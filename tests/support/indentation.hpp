// The paper's indentation as a scene in memory: block 30 x 4 x 30 mm, bottom fixed, sphere of
// radius 2.5 mm.
#pragma once

#include <cmath>
#include <functional>

#include "mechanics/nonlinear/kinsol.hpp"
#include "mechanics/nonlinear/load_path.hpp"
#include "mechanics/solve/increment.hpp"
#include "support/block.hpp"
#include "support/directions.hpp"

namespace langer::test {

struct Indentation {
  int nx = 18, ny = 5, nz = 18;
  double h = 0.35;   // spacing at the centre [mm]; 0: even
  double depth = 1;  // [mm]
  double mu = 0.34;
  double radius = 2.5;
  std::optional<Indenter> shape;  // in place of the sphere
  double reach = 2.6;             // candidates within this radius
  std::vector<Waypoint> motion;   // in place of straight down to `depth`
  double step = 0.1;              // [mm]
  CellType cells = CellType::hex8;
  std::optional<Formulation> formulation;  // none: as suits the cells
  int threads = 1;
  bool extrapolate = true;
  bool quarter = false;     // x >= 0, z >= 0 with symmetry planes; the force is then a quarter
  bool loose_base = false;  // the bottom may glide in x
  double lift = 0;          // of the bottom against the indenter [mm]
  ContactBy contact_by = ContactBy::by_cost;
  NewtonOptions newton;
  const Ranks* ranks = nullptr;         // that share the cells
  std::optional<KinsolOptions> kinsol;  // in place of newton
  std::function<void(Assembler&, const Increment&, const LoadPathOptions&)>
      before;                                                     // told before the first step
  std::function<void(const Increment&, const Assembler&)> after;  // told after each step

  struct Step {
    double depth, force;
    int iterations;
    ContactDefect defect;
  };
  struct Result {
    Mesh mesh;
    VecX u;
    PathReport path;
    std::vector<Step> steps;
    int n_indefinite = 0;
    Increment::Cost cost;
    LinearSolver::Size size;
    double J_min = 1;
    double u_y(double x, double z) const {  // at the top node there
      for (int i : mesh.node_sets.at("y_max"))
        if (std::hypot(mesh.X[i][0] - x, mesh.X[i][2] - z) < 1e-9) return u[3 * i + 1];
      return std::nan("");
    }
  };

  Result run(const Material& material, const std::function<void(const Step&)>& seen = {}) const {
    Result result;
    auto x = h > 0 ? graded(15, nx, h) : even(-15, 15, nx),
         z = h > 0 ? graded(15, nz, h) : even(-15, 15, nz);
    if (quarter) x.erase(x.begin(), x.begin() + nx / 2), z.erase(z.begin(), z.begin() + nz / 2);
    result.mesh = block(x, even(0, 4, ny), z);
    if (cells != CellType::hex8) result.mesh = raised_block(result.mesh, cells);
    std::vector<Prescribed> held;
    for (int i : result.mesh.node_sets["y_min"])
      for (int k = 0; k < 3; ++k)
        if (k > 0 || !loose_base) held.push_back({3 * i + k, k == 1 ? lift : 0});
    if (quarter)
      for (const auto& [face, axis] : {std::pair{"x_min", 0}, {"z_min", 2}})
        for (int i : result.mesh.node_sets[face]) held.push_back({3 * i + axis, 0});
    RigidContact contact{
        "sphere", shape ? *shape : Indenter(Sphere{radius, {0, 4 + radius, 0}}), mu, {}, motion};
    if (motion.empty()) contact.motion = {{1, Vec3(0, -depth, 0)}};
    for (int i : result.mesh.node_sets["y_max"])
      if (std::hypot(result.mesh.X[i][0], result.mesh.X[i][2]) < reach) contact.nodes.push_back(i);
    std::optional<Division> division;
    if (ranks)
      division =
          Division{ranks, ranks->divide(result.mesh.connectivity, nodes_per_cell(result.mesh.type),
                                        result.mesh.n_nodes())};
    Assembler body = equilibrium(
        result.mesh, {material}, formulation.value_or(usual_formulation(cells)),
        number_dofs(result.mesh.n_nodes(), held).dofs, threads, Kernel::packets, division);
    IncrementOptions options;
    options.threads = threads, options.extrapolate = extrapolate, options.contact_by = contact_by,
    options.linear_by = newton.linear;

    Increment increment(body, {contact}, options);
    LoadPathOptions path;
    path.first = path.largest = step / depth;
    if (before) before(body, increment, path);
    std::vector<double> stops;
    for (const Waypoint& w : contact.motion) stops.push_back(w.t);
    result.path = load_path(
        path, 0, {}, stops,
        [&](double t) {
          increment.begin(t);
          return kinsol ? langer::kinsol(increment.problem(), increment.free_balance(),
                                         increment.trial(), *kinsol)
                        : langer::newton(increment.problem(), increment.trial(), newton);
        },
        [&](double t, double, double, const SolveReport& report) {
          increment.accept();
          if (after) after(increment, body);
          const ContactDefect defect = increment.defects()[0];
          result.steps.push_back({t * depth, -defect.force[1], report.iterations, defect});
          if (seen) seen(result.steps.back());
          return true;
        });
    result.u = increment.accepted().u;
    result.n_indefinite = increment.n_indefinite();
    result.cost = increment.cost(), result.size = increment.size();
    result.J_min = body.J_min();
    return result;
  }
};

}  // namespace langer::test

#include "mechanics/solve/forecast.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/memory.hpp"
#include "core/base/stopwatch.hpp"
#include "mechanics/element/point_check.hpp"
#include "mechanics/solve/cell_stability.hpp"

extern "C" void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*,
                       const double*, const int*, const double*, const int*, const double*, double*,
                       const int*);

namespace langer {

namespace {

double measured_multiplication_rate() {
  constexpr int n = 500;
  const std::vector<double> a(n * n, 0.5), b(n * n, 0.25);
  std::vector<double> c(n * n, 0);
  const double one = 1;
  const auto multiply = [&] {
    dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &one, c.data(), &n);
  };
  multiply();  // wakes the library
  const double start = cpu_seconds();
  double now = start;
  int products = 0;
  for (; now - start < 0.05; now = cpu_seconds(), ++products) multiply();
  return 2.0 * n * n * n * products / (now - start);
}

}  // namespace

double multiplication_rate() {
  static const double rate = measured_multiplication_rate();
  return rate;
}

double forecast_bytes(const LinearSolver::Size& size) {
  return resident_bytes() + size.factor_bytes;
}

namespace {

// candidates inside their indenters, were the body not to give way, where most of them are
double most_covered(const Mesh& mesh, const std::vector<RigidContact>& contacts,
                    std::vector<double> times) {
  double most = 0;
  times.push_back(1);
  for (double t : times) {
    double covered = 0;
    for (const RigidContact& contact : contacts)
      for (int node : contact.nodes)
        covered +=
            shape_at(contact.shape, mesh.X[node] - indenter_displacement(contact, t)).gap < 0;
    most = std::max(most, covered);
  }
  return most;
}

// small supernodes and the scatter between them: 0.3 of the product's rate at 0.1 GFLOP, 0.51 at
// 7, 0.74 at 600
double efficiency(double flops) {
  return std::clamp(0.42 + 0.05 * std::log(std::max(1e-9 * flops, 1e-9)), 0.15, 0.85);
}

void with_factor(double rate, Forecast& out) {
  out.factor = out.size.flops / (efficiency(out.size.flops) * rate);
  // forward and back through the factor, as fast as memory gives it: 8 bytes each at 10 GB/s
  out.solving = 2 * 8 * out.size.factor_nonzeros / 10e9;
}

// The distance from the first candidate to the nearest other one [mm].
double spacing(const Mesh& mesh, const RigidContact& contact) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < contact.nodes.size(); ++i)
    least = std::min(least, (mesh.X[contact.nodes[i]] - mesh.X[contact.nodes[0]]).norm());
  return least;
}

// Whether a bond is stiffer than what it pulls at. Then bonds let go one ring of candidates after
// the other, each in a jump; softer ones let go in few jumps.
bool jumps_by_rings(const Assembler& body, const std::vector<RigidContact>& contacts) {
  constexpr double stiff = 0.4;  // 0.15 and 0.3: few jumps; 0.48 and 0.6: many (pull_off)
  const double mu = shear_modulus(body.material(0));
  return std::ranges::any_of(contacts, [&](const RigidContact& contact) {
    return contact.adhesion &&
           contact.adhesion->stiffness * spacing(body.mesh(), contact) > stiff * mu;
  });
}

// In increments that are cut back: measured on pull_off and pull_off_thin, of 10 steps each. With
// many jumps 75 steps and 1560 + 580 iterations, with few 24 and 90 + 70.
void with_bonds(bool by_rings, Forecast& out) {
  if (!by_rings) {
    out.steps = static_cast<int>(2.6 * out.steps);
    out.iterations = 5.0 * out.steps;
    out.again = 3.0 * out.steps;
    return;
  }
  out.steps = static_cast<int>(7.5 * out.steps);
  out.iterations = 21.0 * out.steps;
  out.again = 8.0 * out.steps;
}

// Multigrid made anew in every third iteration where candidates come and go, else once in an
// increment; 15 products with them, 12 without: measured on an indentation and on tension
void without_factor(const MixedSolver& mixed, bool contact, double rate, Forecast& out) {
  const LinearSolver::Size schur = mixed.schur_size();
  const double anew = 1.5e-7 * out.size.nonzeros + schur.flops / (efficiency(schur.flops) * rate);
  out.factor = (contact ? 0.35 : 0.2) * anew;
  out.solving = (contact ? 15 : 12) * (170 * out.size.nonzeros + 32 * schur.factor_nonzeros) / 15e9;
}

}  // namespace

Forecast forecast(Assembler& body, const LinearSolver::Size& size,
                  const std::vector<RigidContact>& contacts, const LoadPathOptions& path,
                  const std::vector<double>& stops, const CorrectionsBy& by) {
  Forecast out;
  out.size = size;
  const VecX rest = VecX::Zero(body.dofs().n);
  body.assemble(rest, true);
  const auto least_seconds = [&](bool with_tangent) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 2; ++i) {  // the caches may be cold before
      const double start = cpu_seconds();
      body.assemble(rest, with_tangent);
      least = std::min(least, cpu_seconds() - start);
    }
    return least;
  };
  const double forces = least_seconds(false);
  out.forces = 1.5 * forces;  // with the pressures, and the volumes before a step is taken
  out.assembly = least_seconds(true) + forces;
  out.bytes = forecast_bytes(size);
  const double rate = multiplication_rate();
  if (by.mixed)
    without_factor(*by.mixed, !contacts.empty(), rate, out);
  else
    with_factor(rate, out);
  // Their stiffness has a skew part, which is evaluated for each of some more solutions: measured.
  if (body.loads().follow()) out.assembly *= 2.5;
  const double covered = most_covered(body.mesh(), contacts, stops);
  if (by.mixed) {
    out.bytes += 8 * out.size.nonzeros;  // the tangent in the candidates' axes
  } else if (by.in_tangent) {  // the tangent turned into the candidates' axes, and once more with
                               // what they do
    out.contact = 30 * out.size.nonzeros / 1e9 + 2 * out.solving;
    out.bytes += 2 * 8 * out.size.nonzeros;
  } else {
    // Full matrices over the contacts. While they grow one after the other two thirds of those
    // covered come to be, over the path 0.43 of the entries; 290 operations for each n^3 where all
    // of them close at once: measured.
    out.contact = std::max(4e4 * std::pow(covered, 2), 290 * std::pow(covered, 3)) / rate;
    double candidates = 0;
    for (const RigidContact& contact : contacts)
      candidates += static_cast<double>(contact.nodes.size());
    out.bytes += 8 * 9 * (6 * covered * covered + 2 * covered * candidates);
  }
  out.contact += by.surfaces;
  if (by.surface_nodes > 0) {
    // solutions of GMRES, or 7 operations for each n^3 in a condensed law: measured on blocks of
    // 80 to 2000 nodes in contact
    out.contact += by.in_tangent ? 10 * out.solving : 7 * std::pow(3 * by.surface_nodes, 3) / rate;
  }
  if (body.division()) body.division()->ranks->sum(&out.bytes, 1);
  const bool friction =
      std::any_of(contacts.begin(), contacts.end(), [](const RigidContact& c) { return c.mu > 0; });
  // 2.3 iterations in steps of 0.01 of the path, 3.7 in steps of 0.1; with tangents used again 1.3
  // and 2.4, and 6 to 8 corrections with them, and with friction 3.8 in steps of 0.25: measured on
  // the indentation
  const auto attempt = [&](double) {
    SolveReport report;
    report.outcome = Outcome::converged;
    report.iterations = 4;
    return report;
  };
  const bool reuses = by.reuses && !by.mixed;
  const auto accepted = [&](double, double taken, double, const SolveReport&) {
    if (by.in_motion || by.surfaces > 0) {  // measured on the shipped scenes
      out.iterations += by.in_motion ? 1 : 2;
      out.again += by.in_motion ? 2.5 : 3;
      return true;
    }
    const double decades = std::log10(taken / 0.1);
    double usual = 2.0;
    double most = 2.6;
    double again = 5.5;
    double per_decade = 1.1;
    if (friction) {
      usual = 2.4;
      most = 4.0;
      again = 7;
      if (decades > 0) per_decade = 3.5;
    }
    if (contacts.empty())  // measured on tension, suction and twist
      again = std::clamp(4.5 + 2.5 * decades, 2.0, 7.0);
    if (reuses) {
      out.iterations += std::clamp(usual + per_decade * decades, 1.3, most);
      out.again += again;
    } else {
      out.iterations += std::clamp(3.7 + 1.4 * decades, 2.3, 4.0) + (by.mixed ? 2.5 : 0);
    }
    return true;
  };
  out.steps = load_path(path, 0, {}, stops, attempt, accepted).steps;
  out.bonds = std::any_of(contacts.begin(), contacts.end(),
                          [](const RigidContact& c) { return c.adhesion.has_value(); });
  if (out.bonds) with_bonds(jumps_by_rings(body, contacts), out);
  out.files = 0.01 + out.steps * (1.8e-3 + 1.5e-7 * body.mesh().n_nodes());
  return out;
}

MeshChecks forecast_of_mesh(Assembler& mesh, const LinearSolver::Size& size, const VecX& u,
                            int n_steps, int n_examined) {
  MeshChecks out;
  mesh.assemble(u, false);  // wakes the memory
  double start = cpu_seconds();
  mesh.assemble(u, false);
  out.assembly = cpu_seconds() - start;
  // a step is balanced when it is examined and when it is written, and twice more at the beginning
  out.seconds = (2 * n_steps + 4) * out.assembly;
  out.seconds += n_steps * 3e-7 * mesh.mesh().n_nodes();
  if (n_examined == 0) return out;

  // strong ellipticity in all Gauss points, from some of the cells
  constexpr int sample = 500;
  const int cells = std::min(sample, mesh.mesh().n_cells());
  PointCheck points;
  start = cpu_seconds();
  for (int e = 0; e < cells; ++e)
    check_points(mesh.material(e), mesh.geometry(e), mesh.fibres(e),
                 mesh.element_displacements(u, e), points);
  out.points = (cpu_seconds() - start) * mesh.mesh().n_cells() / std::max(cells, 1);

  start = cpu_seconds();
  const bool needs_factor = !every_cell_resists(mesh, u);
  out.points += cpu_seconds() - start;
  if (needs_factor) {
    Forecast of_factor;
    of_factor.size = size;
    with_factor(multiplication_rate(), of_factor);
    start = cpu_seconds();
    mesh.assemble(u, true);
    out.factor = of_factor.factor + cpu_seconds() - start;
    out.bytes = size.factor_bytes;
  }
  out.seconds += n_examined * (out.points + out.factor);
  return out;
}

}  // namespace langer

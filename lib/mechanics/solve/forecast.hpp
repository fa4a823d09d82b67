// A forecast of memory and time, before a run begins.
//
// Memory follows from the symbolic analysis of the tangent. Time is a number of operations over
// their speed:
//   iteration   assembly of this body, timed once; flops of the factor; entries of the factor read
//               twice for a solution; n^3 of the contact problem
//   path        iterations that an increment of its length usually needs, times the increments
// The speed of this machine is that of a dense matrix product, measured in 0.05 s. The numbers of
// iterations were measured on indentations (make bench-forecasts compares forecasts with runs).
#pragma once

#include "mechanics/assembly/assembler.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/linear/linear.hpp"
#include "mechanics/linear/mixed.hpp"
#include "mechanics/nonlinear/load_path.hpp"

namespace langer {

struct Forecast {
  LinearSolver::Size size;
  double bytes = 0;  // largest memory of the whole run
  double assembly = 0, factor = 0,
         solving = 0;  // CPU seconds per iteration, one thread; factor: or what stands in its place
  double forces = 0;   // CPU seconds of the assembly in a correction without a new tangent
  int steps = 0;       // if none is cut back
  double iterations = 0;  // about; each with a tangent
  double again = 0;       // corrections with their tangents
  double contact = 0;     // CPU seconds per iteration and per correction
  double files = 0;       // CPU seconds of start and files, all steps
  bool bonds = false;     // increments are short while bonds of an adhesion let go
  double per_iteration() const { return assembly + factor + solving; }
  double seconds() const {
    return iterations * (per_iteration() + contact) + again * (forces + solving + contact) + files;
  }
};

// bytes alone, without timing anything
double forecast_bytes(const LinearSolver::Size& size);

// How corrections are found. reuses: with a tangent that is there already, too; in_tangent: contact
// stands in it (Increment::contact_in_tangent, bodies_in_tangent); mixed: without a factor, none
// otherwise; in_motion: with inertia, in increments that the waves set; surfaces: CPU seconds of
// the contact of deformable surfaces in an iteration, without what solutions or a condensed law
// take; surface_nodes: on both sides of those
struct CorrectionsBy {
  bool reuses = false, in_tangent = false;
  const MixedSolver* mixed = nullptr;
  bool in_motion = false;
  double surfaces = 0, surface_nodes = 0;
};

// Of a body divided among ranks: the memory of all, the time of each; all of them call it.
// Assembles `body` at rest once and multiplies matrices for some hundredths of a second.
Forecast forecast(Assembler& body, const LinearSolver::Size& size,
                  const std::vector<RigidContact>& contacts, const LoadPathOptions& path,
                  const std::vector<double>& stops, const CorrectionsBy& by);

// What comes on top where one hexahedron stands for a body that deforms alike everywhere: every
// step is balanced on the mesh, and its stability may be examined there.
struct MeshChecks {
  double seconds = 0;                           // of CPU, all steps
  double bytes = 0;                             // of a factor of the mesh, if there is one
  double assembly = 0, points = 0, factor = 0;  // CPU seconds of one
  // of a body that symmetry reduces: tangents that are factorized after each step, of all movements
  int signatures = 0;
};
// u: (3 n) a state of the path; n_steps of it, of which n_examined are examined. Assembles `mesh`.
MeshChecks forecast_of_mesh(Assembler& mesh, const LinearSolver::Size& size, const VecX& u,
                            int n_steps, int n_examined);

// flops per CPU second of a dense matrix product on one thread, measured at the first call
double multiplication_rate();

}  // namespace langer

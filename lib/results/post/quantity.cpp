#include "results/post/quantity.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/base/text.hpp"
#include "core/tensor/stress.hpp"
#include "results/post/curves.hpp"

namespace langer {

namespace {

// A text as template argument.
template <std::size_t n>
struct Text {
  char text[n];
  constexpr Text(const char (&s)[n]) { std::copy(s, s + n, text); }
};

// The value of a history that the solver wrote; 0 in the unloaded state.
template <Text name>
double history(const StepState& s) {
  return value_or(s.histories, name.text, 0);
}

// The force against the direction of the travel. Without travel there is no direction, and its
// length is returned.
double force(const StepState& s) {
  const double travel = s.u_ind.norm();
  if (travel > 0) return -s.force_ind.dot(s.u_ind / travel);
  return s.force_ind.norm();
}

// All columns. The order is that of `langer describe columns`: quantities of the state, of the
// indenter, of the contact, of nodes, of node sets and of the whole body.
// clang-format off
constexpr QuantityLine lines[]{
    {"t", "-", "path parameter", "place on the path from 0 to 1, at which the step was accepted",
     [](const StepState& s) { return s.t; }},
    {"time", "s", "time", "since the beginning of the path, where path.seconds gives its duration",
     history<"time">, {.history = "time"}},
    {"increment", "-", "increment of the path parameter", "of t, with which the step was found",
     [](const StepState& s) { return s.increment; }},
    {"newton_iterations", "-", "Newton iterations of the step",
     "tangents that the step factorized; modified-Newton iterations do not count",
     [](const StepState& s) { return double(s.iterations); }},
    {"residual", "-", "relative residual",
     "norm of the residual over that of the reactions, at the accepted state; never negative",
     [](const StepState& s) { return s.residual; }},
    {"negative_eigenvalues", "-", "negative eigenvalues of the constrained tangent",
     "their number; more than 0: the equilibrium is unstable; -1: the tangent is singular to the"
     " last digit",
     history<"negative_eigenvalues">, {.history = "negative_eigenvalues"}},
    {"shear_stiffness_min", "MPa", "minimum acoustic eigenvalue",
     "minimum over all Gauss points and directions; negative where strong ellipticity is lost",
     history<"shear_stiffness_min">, {.history = "shear_stiffness_min"}},
    {"unstable_volume", "-", "fraction of the volume without strong ellipticity",
     "fraction of the reference volume where shear_stiffness_min is negative, 0 to 1",
     history<"unstable_volume">, {.history = "unstable_volume"}},
    {"outside_fit", "-", "fraction of the volume beyond the fitted tests",
     "fraction of the reference volume whose invariants lie beyond the fitted tests, 0 to 1",
     history<"outside_fit">, {.history = "outside_fit"}},
    {"driving_force", "N mm", "work per unit of the path",
     "of imposed displacements; positive where they do work on the body",
     history<"driving_force">, {.history = "driving_force"}},
    {"load_factor", "-", "load factor",
     "of a path with arc lengths: what multiplies all loads and imposed displacements",
     history<"load_factor">, {.history = "load_factor"}},
    {"load_pressure", "MPa", "pressure of the given volume",
     "of the one surface that is given a volume; positive into the body",
     history<"load_pressure">, {.history = "load_pressure"}},
    {"applied_pressure", "MPa", "applied pressure",
     "of the load with the largest pressure; positive into the body, so that suction is negative",
     history<"applied_pressure">},
    {"pumped_volume", "mm^3", "pumped volume",
     "swept since rest by the surface that is given a volume; positive into the body; in a section "
     "that of the whole circle or slab",
     history<"pumped_volume">, {.history = "pumped_volume"}},
    {"energy", "N mm", "stored energy",
     "stored in the whole body, 0 at rest; in a section that of the whole circle or slab",
     history<"energy">, {.history = "energy"}},
    {"kinetic_energy", "N mm", "kinetic energy",
     "of a body in motion, and of an indenter with mass; never negative",
     history<"kinetic_energy">, {.history = "kinetic_energy"}},
    {"energy_balance", "N mm", "energy gained by the time scheme",
     "change of kinetic, stored and lost energy since the beginning without the work done from "
     "outside; negative where the scheme loses",
     history<"energy_balance">, {.history = "energy_balance"}},
    {"viscous_work", "N mm", "work against viscous branches",
     "since rest: dissipated, or stored in the branches until they relax; in a section that of "
     "the whole circle or slab",
     history<"viscous_work">, {.history = "viscous_work"}},
    {"adhesion_stored", "N mm", "energy stored in adhesive bonds",
     "of indenters and surfaces that adhere; never negative",
     history<"adhesion_stored">, {.contact = true, .history = "adhesion_stored"}},
    {"adhesion_dissipated", "N mm", "energy dissipated by adhesion",
     "since rest, by bonds that broke; less if they have healed",
     history<"adhesion_dissipated">, {.contact = true, .history = "adhesion_dissipated"}},
    {"energy_released", "N mm", "energy released in jumps",
     "since rest, by bonds that break suddenly: the part that they cannot dissipate, including "
     "the friction of the jump",
     history<"energy_released">, {.contact = true, .history = "energy_released"}},
    {"bonded_area", "mm^2", "bonded area",
     "reference area times the intensity of its bonds: the area that has touched and has not "
     "separated",
     history<"bonded_area">, {.contact = true, .history = "bonded_area"}},
    {"pull_off", "N", "greatest pull so far",
     "of the bonds on an indenter towards the body, or between two bodies, along the normal of the "
     "contact; the greatest of all contacts; never negative",
     [](const StepState& s) { return s.sums.pull_off; },
     {.contact = true, .shapes = true, .history = "adhesion_stored"}},
    {"work", "N mm", "work of the indenter and of imposed displacements",
     "done on the body since rest; positive where indenter and imposed displacements act against"
     " its resistance",
     [](const StepState& s) { return s.sums.work; }, {.shapes = true}},
    {"dissipated", "N mm", "energy dissipated by friction", "since rest; never negative",
     [](const StepState& s) { return s.sums.dissipated; }, {.shapes = true}},
    {"balance", "-", "work neither stored nor dissipated, relative",
     "(work - energy - viscous_work - dissipated - energy stored and dissipated by adhesion) "
     "over the largest work so far: error of the increments",
     [](const StepState& s) { return s.sums.balance; }, {.shapes = true, .history = "energy"}},
    {"hysteresis", "N mm", "work of a cycle",
     "done by indenter and imposed displacements since the first indenter last advanced after a "
     "return; at the end of a cycle its energy loss",
     [](const StepState& s) { return s.sums.hysteresis; },
     {.contact = true, .indenter = true, .shapes = true}},
    {"relaxation", "-", "force over its greatest so far",
     "magnitude of the force on the first indenter over the greatest so far: 1 while it grows, "
     "below 1 in a hold",
     [](const StepState& s) { return s.sums.relaxation; },
     {.contact = true, .indenter = true, .shapes = true}},
    {"u_ind", "mm", "indenter travel",
     "length of the displacement of the indenter from its start; never negative",
     [](const StepState& s) { return s.u_ind.norm(); }, {.contact = true}},
    {"u_ind_x", "mm", "indenter travel along x", "positive along +x",
     [](const StepState& s) { return s.u_ind[0]; }, {.contact = true}},
    {"u_ind_y", "mm", "indenter travel along y",
     "positive along +y, out of the body where it is pressed from above",
     [](const StepState& s) { return s.u_ind[1]; }, {.contact = true}},
    {"u_ind_z", "mm", "indenter travel along z", "positive along +z",
     [](const StepState& s) { return s.u_ind[2]; }, {.contact = true}},
    {"path", "mm", "path of the indenter",
     "distance that the indenter has travelled, back and forth counted twice; never negative",
     [](const StepState& s) { return s.sums.path; },
     {.contact = true, .indenter = true, .shapes = true}},
    {"force", "N", "force resisting the indenter",
     "positive where the body resists the travel; at rest, where there is no direction, its "
     "magnitude",
     force, {.contact = true}},
    {"force_x", "N", "force on the indenter along x",
     "of the body on the indenter, positive along +x",
     [](const StepState& s) { return s.force_ind[0]; }, {.contact = true}},
    {"force_y", "N", "force on the indenter along y",
     "of the body on the indenter, positive along +y: upwards where it is pressed from above",
     [](const StepState& s) { return s.force_ind[1]; }, {.contact = true}},
    {"force_z", "N", "force on the indenter along z",
     "of the body on the indenter, positive along +z",
     [](const StepState& s) { return s.force_ind[2]; }, {.contact = true}},
    {"contact_nodes", "-", "nodes in contact",
     "number of candidates in contact, sticking or slipping",
     [](const StepState& s) { return double(s.stick + s.slip); }, {.contact = true}},
    {"stick_nodes", "-", "sticking nodes", "number",
     [](const StepState& s) { return double(s.stick); }, {.contact = true}},
    {"slip_nodes", "-", "slipping nodes", "number",
     [](const StepState& s) { return double(s.slip); }, {.contact = true}},
    {"contact_area", "mm^2", "area of contact",
     "deformed area of the nodes that touch any indenter, accurate to half an element around its"
     " rim; in a section that of the whole circle or slab; never negative",
     history<"contact_area">, {.contact = true}},
    {"contact_radius", "mm", "radius of contact",
     "of a circle of the area of contact; never negative",
     history<"contact_radius">, {.contact = true}},
    {"contact_pressure_max", "MPa", "greatest contact pressure",
     "of the nodes in contact: force along the normal over deformed area; positive into the body",
     history<"contact_pressure_max">, {.contact = true}},
    {"penetration", "mm", "largest penetration",
     "greatest depth of a node inside the indenter, or gap at a node with a reaction; never "
     "negative",
     history<"penetration">, {.contact = true, .history = "penetration"}},
    {"cone", "-", "distance from the friction cone",
     "greatest of |r_t| - friction r_n and of -r_n, over the largest reaction; never negative",
     history<"cone">, {.contact = true, .history = "cone"}},
    {"complementarity", "-", "contact complementarity residual",
     "residual of the contact conditions, over the largest reaction times motion; never negative",
     history<"complementarity">, {.contact = true, .history = "complementarity"}},
    {"u_x", "mm", "displacement u_x", "mean over the nodes, positive along +x",
     [](const Vec3& u) { return u[0]; }},
    {"u_y", "mm", "displacement u_y", "mean over the nodes, positive along +y",
     [](const Vec3& u) { return u[1]; }},
    {"u_z", "mm", "displacement u_z", "mean over the nodes, positive along +z",
     [](const Vec3& u) { return u[2]; }},
    {"sigma_xx", "MPa", "Cauchy stress σ_{xx}", "positive in tension",
     [](const VecX& row, int) { return row[0]; }},
    {"sigma_yy", "MPa", "Cauchy stress σ_{yy}", "positive in tension",
     [](const VecX& row, int) { return row[1]; }},
    {"sigma_zz", "MPa", "Cauchy stress σ_{zz}", "positive in tension",
     [](const VecX& row, int) { return row[2]; }},
    {"sigma_xy", "MPa", "Cauchy stress σ_{xy}",
     "positive where the face of normal +x is drawn along +y",
     [](const VecX& row, int) { return row[3]; }},
    {"sigma_yz", "MPa", "Cauchy stress σ_{yz}",
     "positive where the face of normal +y is drawn along +z",
     [](const VecX& row, int) { return row[4]; }},
    {"sigma_xz", "MPa", "Cauchy stress σ_{xz}",
     "positive where the face of normal +x is drawn along +z",
     [](const VecX& row, int) { return row[5]; }},
    {"sigma_1", "MPa", "greatest principal stress", "positive in tension",
     [](const VecX& row, int) { return principal_stresses(sigma_of(row))[0]; }},
    {"sigma_2", "MPa", "middle principal stress", "positive in tension",
     [](const VecX& row, int) { return principal_stresses(sigma_of(row))[1]; }},
    {"sigma_3", "MPa", "least principal stress", "positive in tension",
     [](const VecX& row, int) { return principal_stresses(sigma_of(row))[2]; }},
    {"von_mises", "MPa", "von Mises stress", "of the averaged Cauchy stress; never negative",
     [](const VecX& row, int) { return von_mises(sigma_of(row)); }},
    {"pressure", "MPa", "mean stress",
     "tr(sigma)/3, the mean stress: positive in tension, the opposite of a hydrostatic pressure",
     [](const VecX& row, int) { return mean_stress(sigma_of(row)); }},
    {"J", "-", "volume ratio J",
     "det F, deformed over reference volume; 1 at rest; at nodes within the values at the Gauss "
     "points of their elements",
     [](const VecX& row, int) { return J_of(row); }},
    {"fibre_stretch", "-", "fibre stretch",
     "sqrt(I4_bar), isochoric; 1 at rest, above 1 in tension",
     fibre_stretch_of, {.fibres = true}},
    {"contact_pressure", "MPa", "contact pressure",
     "force of an indenter along the normal over the deformed area of the node; positive into "
     "the body",
     [](const ContactNode& c) { return c.pressure; }, {.contact = true}},
    {"contact_friction", "MPa", "frictional traction",
     "magnitude of the force across the normal over the deformed area of the node; never "
     "negative",
     [](const ContactNode& c) { return c.friction; }, {.contact = true}},
    {"slip", "mm", "slip",
     "distance of the node along what it touches in increments with contact at both ends, back and "
     "forth counted twice; never negative",
     [](const ContactNode& c) { return c.slip; }, {.contact = true, .shapes = true}},
    {"contact_status", "-", "status of contact", "-1 not a candidate, 0 open, 1 stick, 2 slip",
     [](const ContactNode& c) { return double(c.status); }, {.contact = true}},
    {"eps_xx", "-", "strain ε_{xx}",
     "engineering: mean u_x of the set over the length; positive where it moves along +x",
     [](const SetState& s) { return s.u[0] / s.length; }, {.extent = 0}},
    {"eps_yy", "-", "strain ε_{yy}",
     "engineering: mean u_y of the set over the length; positive where it moves along +y",
     [](const SetState& s) { return s.u[1] / s.length; }, {.extent = 1}},
    {"eps_zz", "-", "strain ε_{zz}",
     "engineering: mean u_z of the set over the length; positive where it moves along +z",
     [](const SetState& s) { return s.u[2] / s.length; }, {.extent = 2}},
    {"reaction_x", "N", "reaction along x",
     "sum over the set of the force on the body from supports and contact, positive along +x",
     [](const SetState& s) { return s.reaction[0]; }},
    {"reaction_y", "N", "reaction along y",
     "sum over the set of the force on the body from supports and contact, positive along +y",
     [](const SetState& s) { return s.reaction[1]; }},
    {"reaction_z", "N", "reaction along z",
     "sum over the set of the force on the body from supports and contact, positive along +z",
     [](const SetState& s) { return s.reaction[2]; }},
    {"velocity_x", "mm/s", "velocity along x", "mean over the set, of a body in motion",
     [](const SetState& s) { return s.velocity[0]; }, {.history = "kinetic_energy"}},
    {"velocity_y", "mm/s", "velocity along y", "mean over the set, of a body in motion",
     [](const SetState& s) { return s.velocity[1]; }, {.history = "kinetic_energy"}},
    {"velocity_z", "mm/s", "velocity along z", "mean over the set, of a body in motion",
     [](const SetState& s) { return s.velocity[2]; }, {.history = "kinetic_energy"}},
    {"acceleration_x", "mm/s^2", "acceleration along x", "mean over the set, of a body in motion",
     [](const SetState& s) { return s.acceleration[0]; }, {.history = "kinetic_energy"}},
    {"acceleration_y", "mm/s^2", "acceleration along y", "mean over the set, of a body in motion",
     [](const SetState& s) { return s.acceleration[1]; }, {.history = "kinetic_energy"}},
    {"acceleration_z", "mm/s^2", "acceleration along z", "mean over the set, of a body in motion",
     [](const SetState& s) { return s.acceleration[2]; }, {.history = "kinetic_energy"}},
    {"swept_volume", "mm^3", "swept volume",
     "between the surface of the set now and at rest, positive outwards: the volume of a dome; "
     "in a section that of the whole circle or slab",
     [](const SetState& s) { return s.swept; }, {.facets = true}},
    {"von_mises_max", "MPa", "greatest von Mises stress",
     "of the nodal averages, as in figures and in the error estimate; never negative",
     [](const Extremes& all) { return all.von_mises; }},
    {"von_mises_max_x", "mm", "x of the greatest von Mises stress", "place in the reference state",
     [](const Extremes& all) { return all.place[0]; }},
    {"von_mises_max_y", "mm", "y of the greatest von Mises stress", "place in the reference state",
     [](const Extremes& all) { return all.place[1]; }},
    {"von_mises_max_z", "mm", "z of the greatest von Mises stress", "place in the reference state",
     [](const Extremes& all) { return all.place[2]; }},
    {"pressure_min", "MPa", "least mean stress",
     "tr(sigma)/3 over all Gauss points: negative in compression",
     [](const Extremes& all) { return all.pressure_min; }},
    {"pressure_max", "MPa", "greatest mean stress",
     "tr(sigma)/3 over all Gauss points: positive in tension",
     [](const Extremes& all) { return all.pressure_max; }},
    {"fibre_stretch_max", "-", "greatest fibre stretch",
     "sqrt(I4_bar) over all Gauss points and families; 1 at rest",
     [](const Extremes& all) { return all.fibre_stretch; }, {.fibres = true}},
    {"J_min", "-", "smallest J", "det F over all Gauss points; 1 at rest",
     [](const Extremes& all) { return all.J; }},
};
// clang-format on

}  // namespace

std::span<const QuantityLine> quantity_lines() { return lines; }

Quantity quantity(std::string_view word) {
  const auto found = std::ranges::find(lines, word, &QuantityLine::word);
  if (found == std::end(lines))
    throw std::logic_error("no quantity is called " + std::string(word));
  return static_cast<Quantity>(found - lines);
}

std::vector<const char*> names(Quantity) {
  std::vector<const char*> words;
  for (const QuantityLine& line : lines) words.push_back(line.word);
  return words;
}

}  // namespace langer

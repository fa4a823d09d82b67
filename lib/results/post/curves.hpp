// Curves: one number per state for each chosen quantity.
//   u, reaction   of a state: (n) per node; force_ind is the force on the indenter
//   u_ind         length of the indenter's displacement
//   force         -force_ind . u_ind/|u_ind|, positive where the body resists; at zero
//                 displacement, where there is no direction, the length of force_ind
//   work, dissipated, balance, path   see post/energy_columns.hpp
//   quotient      of two other columns of one unit, by name; NaN where the second is 0
//   eps_xx        mean displacement of a set along x, over `length` (by default the extent of the
//                 mesh along x)
// A name that does not exist in the mesh or in the solution is a complaint with the key that has
// it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "results/post/energy_columns.hpp"
#include "results/post/nodal_fields.hpp"
#include "results/post/quantity.hpp"

namespace langer {

// One column as the user asks for it.
struct ColumnChoice {
  std::optional<Quantity> quantity;
  std::optional<std::string> history, at, name, zero_at;
  std::optional<std::array<std::string, 2>> quotient;
  std::optional<double> length;
  int family = 1;
  static void fields(auto& v) {
    v(&ColumnChoice::quantity, "quantity", unit::none, "what to measure");
    v(&ColumnChoice::history, "history", unit::none,
      "instead of a quantity: a number that the solver wrote for every step");
    v(&ColumnChoice::quotient, "quotient", unit::none,
      "instead of a quantity: names of two other columns, the first over the second");
    v(&ColumnChoice::at, "at", unit::none,
      "observation point or node set; needed by quantities of nodes, points and sets");
    v(&ColumnChoice::name, "name", unit::none,
      "name of the column without its unit; by default the quantity, and _ and the place");
    v(&ColumnChoice::length, "length", unit::mm,
      "of a strain: reference length; by default the extent of the mesh", positive);
    v(&ColumnChoice::zero_at, "zero_at", unit::none,
      "state that the column is measured from, such as the end of a stage: its value there is "
      "subtracted from all values. A row of the table, t=0.5 or u_ind=0.5; the path must stop "
      "there");
    v(&ColumnChoice::family, "family", unit::none, "of a fibre stretch: which fibre family, from 1",
      at_least(1));
  }
  std::vector<Complaint> complaints() const;
};
std::string column_name(const ColumnChoice& choice);  // without unit
bool is_column_name(const std::string& name);         // allowed in CSV, HDF5 paths and scripts
inline constexpr const char* column_letters = "letters, digits, _, + and - only";
std::vector<Complaint> quotient_complaints(const ColumnChoice& choice,
                                           const std::vector<ColumnChoice>& columns,
                                           const std::vector<ColumnChoice>& further);
std::string unit_of(const ColumnChoice& choice);
std::string label_of(const ColumnChoice& choice);  // of an axis, as gnuplot's enhanced text

// The columns, each followed by what the solver estimated for it: its error <name>_error, the
// column <name>_of_mesh where an accuracy was met by the limit of the meshes (of
// force, torques and reactions of moved sets), its standard deviation from the parameters, and
// its derivatives with respect to the numbers that `sensitivity` names, such as
// d_force_N_d_matrix_yeoh_a1.
std::vector<ColumnChoice> with_errors(const std::vector<ColumnChoice>& columns,
                                      const std::vector<std::string>& histories);
std::string error_of(const std::string& column);  // the name of that column
std::string of_mesh(const std::string& column);
// The names of columns that a figure draws as a band about a column. The first that exists is
// drawn: the standard deviation from the parameters (uncertainty: linear), or the error.
std::vector<std::string> bands_of(const std::string& column);

// A column with its nodes, facets and lengths found in the mesh.
struct Measure {
  std::string name, unit, label;
  std::optional<Quantity> quantity;
  std::string history;
  std::optional<std::array<std::string, 2>> quotient;
  std::vector<int> nodes;
  std::vector<Facet> facets;  // only for quantities that need them
  std::optional<std::string> zero_at;
  std::string key;  // of the column
  int family = 0;   // from 0
  double length = 1;
};

// What a solution offers, apart from the mesh.
struct Available {
  bool contact = false;                // an indenter, or surfaces that touch
  bool energy = true;                  // all that touches is known, so that its work is
  std::vector<std::string> histories;  // of the solver
  bool indenter = true;                // in a solution with contact
};

// Columns that were found, and the faults of the others.
struct Measures {
  std::vector<Measure> measures;
  std::vector<Complaint> complaints;  // keys like columns[2].at
};
Measures look_up(const std::vector<ColumnChoice>& choices, const std::string& key, const Body& body,
                 const Available& available);

// One accepted state, or the unloaded one.
struct StepState {
  double t = 0, increment = 0, residual = 0;
  int iterations = 0;
  std::vector<Vec3> u, reaction;
  std::vector<Vec3> velocity, acceleration;  // (n) of a body in motion, else empty
  Vec3 u_ind = Vec3::Zero(), force_ind = Vec3::Zero();
  int stick = 0, slip = 0;                  // nodes of all contacts
  std::map<std::string, double> histories;  // those that the unloaded state lacks are 0
  PathSums sums;
  std::vector<ContactNode> contact;  // (n), if a measure asks for it
};
StepState unloaded(const Mesh& mesh);

// One value per measure; a quotient names others of them. Gauss values that are missing in
// `gauss` are computed and added to it.
std::vector<double> measured(const Body& body, const std::vector<Measure>& measures, StressAt at,
                             const StepState& state, GaussValues& gauss);

// The value of a quantity of points, computed from a row of values (post/nodal_fields.hpp).
double value_of(Quantity quantity, const VecX& row, int family = 0);

}  // namespace langer

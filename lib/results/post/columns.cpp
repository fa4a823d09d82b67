#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "mechanics/mesh/section.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/post/curves.hpp"
#include "results/post/steps.hpp"
#include "results/store/solution_layout.hpp"

namespace langer {

namespace {

// The length of the undeformed mesh along an axis.
double extent(const Mesh& mesh, int axis) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& X : mesh.X) {
    low = std::min(low, X[axis]);
    high = std::max(high, X[axis]);
  }
  return high - low;
}

// Letters that need no quotes in CSV, HDF5 paths and scripts.
bool is_name_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '+' || c == '-';
}

// A list in words of the names that a message offers.
std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) append(list, ", ", name);
  return text_or(list, "none at all");
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
  return langer::did_you_mean(nearest(name, names));
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

// What a column shows, as the subject of a message.
std::string subject_of(const ColumnChoice& choice) {
  if (choice.quantity) return line_of(*choice.quantity).word;
  if (choice.history) return "a history";
  return "a quotient";
}

// The keys of a column that exclude each other, of which the config has two.
std::string conflict_of(const ColumnChoice& choice) {
  if (!choice.quotient) return "both a quantity and a history";
  if (!choice.quantity) return "both a history and a quotient";
  return "both a quantity and a quotient";
}

// Whether the quantity of a column is measured at a place.
bool has_place(const ColumnChoice& choice) {
  return choice.quantity && needs_place(line_of(*choice.quantity));
}

}  // namespace

// Faults that the config alone shows: missing or conflicting keys, and names that files cannot
// have.
std::vector<Complaint> ColumnChoice::complaints() const {
  const int ways = quantity.has_value() + history.has_value() + quotient.has_value();
  if (ways == 0)
    return {{"", "neither a quantity nor a history nor a quotient", "one of the three", ""}};
  if (ways > 1) return {{"", conflict_of(*this), "one of the two", ""}};

  std::vector<Complaint> found;
  const std::string column = column_name(*this);
  if (!is_column_name(column)) {
    const char* const key = name ? "name" : "at";
    found.push_back({key, "the column name \"" + column + "\"", column_letters, ""});
  }
  if (has_place(*this) && !at)
    found.push_back({"at", "missing", "the name of an observation point or node set",
                     fmt::format("{} is measured at a place", line_of(*quantity).word)});
  if (at && !has_place(*this))
    found.push_back(
        {"at", *at, "no place", fmt::format("{} belongs to the whole body", subject_of(*this))});
  if (zero_at && quotient)
    found.push_back({"zero_at", "found together with a quotient", "a quantity or a history", ""});
  if (zero_at && !quotient && !parse_step(*zero_at))
    found.push_back({"zero_at", *zero_at, "a row of the table, t=0.5 or u_ind=0.5", ""});
  return found;
}

bool is_column_name(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, is_name_letter);
}

// Both columns of a quotient must be in the config and have the same unit. A quotient of
// quotients is refused, because its value would depend on the order of the columns.
std::vector<Complaint> quotient_complaints(const ColumnChoice& choice,
                                           const std::vector<ColumnChoice>& columns,
                                           const std::vector<ColumnChoice>& further) {
  if (!choice.quotient) return {};
  std::vector<std::string> names, units, found_units;
  for (const auto* list : {&columns, &further})
    for (const ColumnChoice& c : *list)
      if (!c.quotient) {
        names.push_back(column_name(c));
        units.push_back(unit_of(c));
      }
  std::vector<Complaint> complaints;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string& name = (*choice.quotient)[i];
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end())
      found_units.push_back(units[static_cast<std::size_t>(found - names.begin())]);
    else
      complaints.push_back({fmt::format("quotient[{}]", i),
                            fmt::format("there is no column \"{}\"", name),
                            "one of " + list_of(names), did_you_mean(name, names)});
  }
  if (found_units.size() == 2 && found_units[0] != found_units[1])
    complaints.push_back({"quotient", fmt::format("{} over {}", found_units[0], found_units[1]),
                          "two columns of one unit", ""});
  return complaints;
}

// The name in the config, or the one that follows from quantity, place and fibre family.
std::string column_name(const ColumnChoice& choice) {
  if (choice.name) return *choice.name;
  if (choice.history) return *choice.history;
  if (choice.quotient) return (*choice.quotient)[0] + "_per_" + (*choice.quotient)[1];
  std::string name = line_of(*choice.quantity).word;
  if (choice.at) name += "_" + *choice.at;
  if (choice.family > 1) name += fmt::format("_{}", choice.family);
  return name;
}

std::string unit_of(const ColumnChoice& choice) {
  if (choice.quantity) return line_of(*choice.quantity).unit;
  if (choice.quotient) return "-";
  return solution::unit_of(*choice.history);
}

// The label of an axis. Names that users or the solver gave are printed literally, without
// subscripts.
std::string label_of(const ColumnChoice& choice) {
  if (choice.quotient) return literal((*choice.quotient)[0] + " / " + (*choice.quotient)[1]);
  if (choice.quantity) return line_of(*choice.quantity).label;
  return literal(*choice.history);
}

std::string error_of(const std::string& column) { return column + "_error"; }

std::string of_mesh(const std::string& column) { return column + "_of_mesh"; }

std::vector<std::string> bands_of(const std::string& column) {
  return {column + "_deviation", error_of(column)};
}

namespace {

// The begin of the names of a column's derivatives with respect to parameters
// (inverse/sensitivity.cpp): d_<column>_<unit>_d_. Empty if the solver computes none.
std::string derivative_prefix(std::string_view word, const ColumnChoice& c) {
  if (word == "energy") return "d_energy_N_mm_d_";
  if (word == "force" || word == "force_x" || word == "force_y" || word == "force_z")
    return "d_" + std::string(word) + "_N_d_";
  if (word.starts_with("torque_")) return "d_" + std::string(word) + "_N_mm_d_";
  if (word.starts_with("u_") && c.at) return "d_" + std::string(word) + "_" + *c.at + "_mm_d_";
  if (word.starts_with("reaction_") && c.at)
    return "d_reaction_" + *c.at + "_" + word.back() + "_N_d_";
  return "";
}

bool is_torque(const ColumnChoice& c) { return c.history && c.history->starts_with("torque_"); }

// The word of a column that may have an error estimate; empty for others.
std::string estimated_word(const ColumnChoice& c) {
  if (is_torque(c)) return *c.history;
  if (c.quantity) return line_of(*c.quantity).word;
  return "";
}

// A history that the solver wrote together with its estimated error, as of the force on one of
// several indenters.
bool has_error(const ColumnChoice& c, const std::vector<std::string>& histories) {
  return c.history && contains(histories, error_of(*c.history));
}

// The history with the estimated error of a column; empty if it has none. The travel of the
// indenter is u_ind, too, where one is controlled by its force.
std::string error_history(const ColumnChoice& c, const std::vector<std::string>& histories) {
  if (has_error(c, histories)) return error_of(*c.history);
  const std::string word = estimated_word(c);
  if (word == "u_ind") {
    const auto is_of_travel = [](const std::string& history) {
      return history.starts_with("travel_") && history.ends_with("_error");
    };
    const auto found = std::ranges::find_if(histories, is_of_travel);
    if (std::ranges::count_if(histories, is_of_travel) == 1) return *found;
  }
  if (is_torque(c) || word == "force" || word == "pull_off" || word == "von_mises_max")
    return error_of(word);
  if (word == "u_y" && column_name(c) == "apex_height") return error_of("apex_height");
  if (word.starts_with("reaction_") && c.at) return error_of("reaction_" + *c.at);
  return "";
}

// The history with the limit of a quantity over its value, from that with its error.
std::string limit_beside(const std::string& error) {
  return error.substr(0, error.size() - std::string("_error").size()) + "_limit_share";
}

}  // namespace

std::vector<ColumnChoice> with_errors(const std::vector<ColumnChoice>& columns,
                                      const std::vector<std::string>& histories) {
  std::vector<ColumnChoice> out;
  std::vector<std::string> names;
  for (const ColumnChoice& c : columns) names.push_back(column_name(c));
  for (const ColumnChoice& c : columns) {
    out.push_back(c);
    const std::string word = estimated_word(c);
    if (word.empty() && !has_error(c, histories)) continue;
    // Adds a column of a history, if the solver wrote it and no column has its name.
    const auto add = [&](const std::string& history, const std::string& name) {
      if (!contains(histories, history) || contains(names, name)) return;
      ColumnChoice further;
      further.history = history;
      further.name = name;
      out.push_back(further);
      names.push_back(name);
    };
    const std::string error = error_history(c, histories);
    add(error, error_of(column_name(c)));
    if (!error.empty()) add(limit_beside(error), of_mesh(column_name(c)));
    if (word == "force") add("force_deviation", column_name(c) + "_deviation");
    const std::string prefix = derivative_prefix(word, c);
    for (const std::string& history : histories)
      if (!prefix.empty() && history.starts_with(prefix)) add(history, history);
  }
  return out;
}

// Finds the nodes, facets and lengths that the columns name. What the mesh or the solution lacks
// is a complaint with the key that names it, so that all of them are reported at once.
Measures look_up(const std::vector<ColumnChoice>& choices, const std::string& key, const Body& body,
                 const Available& available) {
  Measures out;
  std::vector<std::string> sets;
  for (const auto& [name, nodes] : body.mesh().node_sets)
    if (!nodes.empty()) sets.push_back(name);
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const ColumnChoice& c = choices[i];
    const auto complain = [&](const char* part, std::string found, std::string expected,
                              std::string hint) {
      out.complaints.push_back({fmt::format("{}[{}].{}", key, i, part), std::move(found),
                                std::move(expected), std::move(hint)});
    };
    Measure m;
    m.name = column_name(c);
    m.unit = unit_of(c);
    m.label = label_of(c);
    m.quantity = c.quantity;
    m.quotient = c.quotient;
    m.zero_at = c.zero_at;
    m.key = fmt::format("{}[{}]", key, i);
    if (c.quotient) {
      out.measures.push_back(std::move(m));  // quotient_complaints() has checked its columns
      continue;
    }
    if (c.history) {
      m.history = *c.history;
      if (!contains(available.histories, m.history))
        complain("history", fmt::format("the solution has no history \"{}\"", m.history),
                 "one of " + list_of(available.histories),
                 did_you_mean(m.history, available.histories));
    } else {
      const QuantityLine& line = line_of(*c.quantity);
      // What the solution must have for this quantity.
      if (line.needs.contact && !available.contact)
        complain("quantity", fmt::format("{} of a solution without contact", line.word),
                 "a quantity that needs no indenter", "");
      if (line.needs.shapes && !available.energy)
        complain("quantity", fmt::format("{} needs the shapes of the indenters", line.word),
                 "a solution whose config this version can read, and deformable surfaces that do "
                 "not move with inertia",
                 "energy, kinetic_energy and energy_balance know these");
      if (line.needs.indenter && available.contact && available.energy && !available.indenter)
        complain("quantity",
                 fmt::format("{} of a solution whose surfaces are all deformable", line.word),
                 "a quantity that needs no indenter", "work, dissipated and balance are known");
      // Without contact the complaint above is enough.
      if (line.needs.history && (available.contact || !line.needs.contact) &&
          !contains(available.histories, line.needs.history))
        complain("quantity", fmt::format("the solution has no history \"{}\"", line.needs.history),
                 "one of " + list_of(available.histories), "");
      // The nodes of the place, and its facets if the quantity needs them.
      if (c.at && needs_place(line)) {
        const auto set = body.mesh().node_sets.find(*c.at);
        if (set == body.mesh().node_sets.end() || set->second.empty())
          complain("at", fmt::format("the mesh has no nodes called \"{}\"", *c.at),
                   "one of " + list_of(sets), did_you_mean(*c.at, sets));
        else
          m.nodes = set->second;
        if (line.needs.facets && !m.nodes.empty()) m.facets = surface_of(body.mesh(), *c.at);
        if (line.needs.facets && !m.nodes.empty() && m.facets.empty())
          complain("at", fmt::format("found \"{}\", a set without facets", *c.at),
                   "a set that covers facets", "");
      }
      // Fibre families are counted from 1 in configs.
      m.family = c.family - 1;
      if (is<OfPoint>(line) && line.needs.fibres && c.family > body.n_families())
        complain("family",
                 fmt::format("family {} of a material with {}", c.family, body.n_families()),
                 "a family that is there", "");
      if (is<OfBody>(line) && line.needs.fibres && body.n_families() == 0)
        complain("quantity", fmt::format("{} of a material without fibres", line.word),
                 "another quantity", "");
      // The reference length of a strain.
      if (line.needs.extent >= 0) {
        m.length = extent(body.mesh(), line.needs.extent);
        if (c.length) m.length = *c.length;
      }
    }
    out.measures.push_back(std::move(m));
  }
  return out;
}

}  // namespace langer

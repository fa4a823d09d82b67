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

double extent(const Mesh& mesh, int axis) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vec3& X : mesh.X) {
    low = std::min(low, X[axis]);
    high = std::max(high, X[axis]);
  }
  return high - low;
}

bool fits_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '+' || c == '-';
}

std::string known(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) append(list, ", ", name);
  return text_or(list, "none at all");
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = nearest(name, names);
  if (near.empty()) return "";
  return fmt::format("did you mean \"{}\"?", near);
}

}  // namespace

std::vector<Complaint> ColumnChoice::complaints() const {
  const int ways = quantity.has_value() + history.has_value() + quotient.has_value();
  if (ways == 0)
    return {{"", "neither a quantity nor a history nor a quotient", "one of the three", ""}};
  if (ways > 1)
    return {{"",
             fmt::format("both a {} and a {}", quantity ? "quantity" : "history",
                         quotient ? "quotient" : "history"),
             "one of the two", ""}};
  std::vector<Complaint> found;
  const std::string column = column_name(*this);
  if (!is_column_name(column))
    found.push_back(
        {name ? "name" : "at", "the column name \"" + column + "\"", column_letters, ""});
  if (quantity && needs_place(line_of(*quantity)) && !at)
    found.push_back({"at", "missing", "the name of an observation point or node set",
                     fmt::format("{} is measured at a place", line_of(*quantity).word)});
  if (at && !(quantity && needs_place(line_of(*quantity))))
    found.push_back({"at", *at, "no place",
                     fmt::format("{} belongs to the whole body", quantity  ? line_of(*quantity).word
                                                                 : history ? "a history"
                                                                           : "a quotient")});
  if (zero_at && (quotient || !parse_step(*zero_at)))
    found.push_back(
        {"zero_at", quotient ? "found beside a quotient" : *zero_at,
         quotient ? "a quantity or a history" : "a row of the table, t=0.5 or u_ind=0.5", ""});
  return found;
}

bool is_column_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), fits_a_name);
}

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
                            "one of " + known(names), did_you_mean(name, names)});
  }
  if (found_units.size() == 2 && found_units[0] != found_units[1])
    complaints.push_back({"quotient", fmt::format("{} over {}", found_units[0], found_units[1]),
                          "two columns of one unit", ""});
  return complaints;
}

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

std::string label_of(const ColumnChoice& choice) {
  if (choice.quotient) return literal((*choice.quotient)[0] + " / " + (*choice.quotient)[1]);
  if (choice.quantity) return line_of(*choice.quantity).label;
  return literal(*choice.history);
}

std::string error_of(const std::string& column) { return column + "_error"; }

std::vector<std::string> bands_of(const std::string& column) {
  return {column + "_deviation", error_of(column)};
}

namespace {
// what the names of its derivatives begin with (inverse/sensitivity.cpp); empty where there are
// none
std::string derivatives_of(std::string_view word, const ColumnChoice& c) {
  if (word == "energy") return "d_energy_N_mm_d_";
  if (word == "force" || word == "force_x" || word == "force_y" || word == "force_z")
    return "d_" + std::string(word) + "_N_d_";
  if (word.starts_with("torque_")) return "d_" + std::string(word) + "_N_mm_d_";
  if (word.starts_with("u_") && c.at) return "d_" + std::string(word) + "_" + *c.at + "_mm_d_";
  if (word.starts_with("reaction_") && c.at)
    return "d_reaction_" + *c.at + "_" + word.back() + "_N_d_";
  return "";
}
}  // namespace

std::vector<ColumnChoice> with_errors(const std::vector<ColumnChoice>& columns,
                                      const std::vector<std::string>& histories) {
  std::vector<ColumnChoice> out;
  std::vector<std::string> names;
  for (const ColumnChoice& c : columns) names.push_back(column_name(c));
  for (const ColumnChoice& c : columns) {
    out.push_back(c);
    const bool of_torque = c.history && c.history->starts_with("torque_");
    if (!c.quantity && !of_torque) continue;
    const std::string_view word =
        of_torque ? std::string_view(*c.history) : line_of(*c.quantity).word;
    const std::string history =
        error_of(of_torque                               ? *c.history
                 : word == "force"                       ? "force"
                 : word.starts_with("reaction_") && c.at ? "reaction_" + *c.at
                                                         : "");
    const auto add = [&](const std::string& taken, const std::string& name) {
      if (std::find(histories.begin(), histories.end(), taken) == histories.end()) return;
      if (std::find(names.begin(), names.end(), name) != names.end()) return;
      ColumnChoice further;
      further.history = taken;
      further.name = name;
      out.push_back(further);
      names.push_back(name);
    };
    add(history, error_of(column_name(c)));
    if (word == "force") add("force_deviation", column_name(c) + "_deviation");
    const std::string derivatives = derivatives_of(word, c);
    for (const std::string& one : histories)
      if (!derivatives.empty() && one.starts_with(derivatives)) add(one, one);
  }
  return out;
}

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
    const auto has_history = [&](const std::string& name) {
      return std::find(available.histories.begin(), available.histories.end(), name) !=
             available.histories.end();
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
      out.measures.push_back(std::move(m));  // the config knows that its columns are there
      continue;
    }
    if (c.history) {
      m.history = *c.history;
      if (!has_history(m.history))
        complain("history", fmt::format("the solution has no history \"{}\"", m.history),
                 "one of " + known(available.histories),
                 did_you_mean(m.history, available.histories));
    } else {
      const QuantityLine& line = line_of(*c.quantity);
      if (line.needs.contact && !available.contact)
        complain("quantity", fmt::format("{} of a solution without contact", line.word),
                 "a quantity that needs no indenter", "");
      if (line.needs.shapes && !available.energy)
        complain("quantity", fmt::format("{} needs the shapes of the indenters", line.word),
                 "a solution whose config this version can read", "");
      if (line.needs.history && (available.contact || !line.needs.contact) &&
          !has_history(line.needs.history))
        complain("quantity", fmt::format("the solution has no history \"{}\"", line.needs.history),
                 "one of " + known(available.histories), "");
      if (c.at && needs_place(line)) {
        const auto set = body.mesh().node_sets.find(*c.at);
        if (set == body.mesh().node_sets.end() || set->second.empty())
          complain("at", fmt::format("the mesh has no nodes called \"{}\"", *c.at),
                   "one of " + known(sets), did_you_mean(*c.at, sets));
        else
          m.nodes = set->second;
        if (line.needs.facets && !m.nodes.empty()) m.facets = surface_of(body.mesh(), *c.at);
        if (line.needs.facets && !m.nodes.empty() && m.facets.empty())
          complain("at", fmt::format("found \"{}\", a set without facets", *c.at),
                   "a set that covers facets", "");
      }
      m.family = c.family - 1;
      if (is<OfPoint>(line) && line.needs.fibres && c.family > body.n_families())
        complain("family",
                 fmt::format("family {} of a material with {}", c.family, body.n_families()),
                 "a family that is there", "");
      if (is<OfBody>(line) && line.needs.fibres && body.n_families() == 0)
        complain("quantity", fmt::format("{} of a material without fibres", line.word),
                 "another quantity", "");
      if (line.needs.extent >= 0) {
        if (c.length) {
          m.length = *c.length;
        } else {
          m.length = extent(body.mesh(), line.needs.extent);
        }
      }
    }
    out.measures.push_back(std::move(m));
  }
  return out;
}

}  // namespace langer

#include "pipeline/sweep/gather.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "pipeline/sweep/table_cell.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace {

// A quantity of a summary; nullptr if the member does not have it.
const Summary* find(const std::vector<Summary>& summary, const std::string& name) {
  const auto it = std::ranges::find(summary, name, &Summary::name);
  if (it == summary.end()) return nullptr;
  return &*it;
}

// The quantities of all members, each once.
std::vector<std::string> all_names(const std::vector<GatherInput>& members) {
  std::vector<std::string> names;
  for (const GatherInput& m : members)
    for (const Summary& s : m.summary)
      if (std::ranges::find(names, s.name) == names.end()) names.push_back(s.name);
  return names;
}

// One quantity of all members. Its unit must be the same for all, and at least one must have it.
SweepColumn column(const std::string& name, const std::vector<GatherInput>& members,
                   const Place& asked_at) {
  SweepColumn c{name, "", {}};
  const GatherInput* first = nullptr;
  for (const GatherInput& m : members) {
    const Summary* s = find(m.summary, name);
    if (!s) {
      c.values.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    c.values.push_back(s->value);
    if (!first) {
      c.unit = s->unit;
      first = &m;
    }
    if (s->unit != c.unit)
      throw Failure(Exit::input, Error{{m.path, 0, 0},
                                       name,
                                       fmt::format("found the unit {}", s->unit),
                                       fmt::format("{} as in {}", c.unit, first->path),
                                       ""});
  }
  // A column of gaps only would hide a misspelt name.
  if (!first) {
    const std::vector<std::string> known = all_names(members);
    const std::string near = nearest(name, known);
    throw Failure(Exit::config,
                  Error{asked_at, "columns", fmt::format("no member has a quantity \"{}\"", name),
                        "one of " + list_words(known), did_you_mean(near)});
  }
  return c;
}

}  // namespace

// The order of members is that of the files, which plan makes that of the axes.
Sweep gather(const std::vector<std::string>& columns, std::vector<SweepAxis> axes,
             const std::vector<GatherInput>& members, const Place& columns_at) {
  Sweep sweep;
  for (std::size_t a = 0; a < axes.size(); ++a)
    for (const GatherInput& m : members) axes[a].values.push_back(m.at.at(a));
  sweep.axes = std::move(axes);
  for (const GatherInput& m : members) sweep.members.push_back(m.path);
  std::vector<std::string> wanted = columns;
  if (wanted.empty() && !members.empty())
    for (const Summary& s : members.front().summary) wanted.push_back(s.name);
  for (const std::string& name : wanted) sweep.columns.push_back(column(name, members, columns_at));
  return sweep;
}

// Units are part of the names of columns, as in all tables of Langer.
std::string csv(const Sweep& sweep) {
  std::vector<std::string> words;
  for (const SweepAxis& a : sweep.axes) words.push_back(csv_cell(csv_name(a.name, a.unit)));
  for (const SweepColumn& c : sweep.columns) words.push_back(csv_cell(csv_name(c.name, c.unit)));
  std::string text = fmt::format("{}\n", fmt::join(words, ","));
  for (std::size_t i = 0; i < sweep.members.size(); ++i) {
    words.clear();
    for (const SweepAxis& a : sweep.axes) words.push_back(csv_cell(a.values[i]));
    for (const SweepColumn& c : sweep.columns) words.push_back(table_cell(c.values[i]));
    text += fmt::format("{}\n", fmt::join(words, ","));
  }
  return text;
}

}  // namespace langer

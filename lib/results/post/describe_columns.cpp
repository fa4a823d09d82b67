#include "results/post/describe_columns.hpp"

#include <fmt/format.h>

#include "results/plot/gnuplot.hpp"
#include "results/post/quantity.hpp"
#include "results/store/solution_layout.hpp"

namespace langer {

namespace {

// The heading under which a quantity is listed: where it is measured.
std::string heading_of(const QuantityLine& line) {
  if (is_field(line))
    return "at a place (`at:` a node set or observation point), mean over its nodes";
  if (is<OfSet>(line)) return "of a node set (`at:`)";
  if (is<OfBody>(line)) return "extreme over the whole body";
  if (line.needs.contact) return "of the indenter; needs a contact";
  return "of the whole state";
}

// A row of the table: name, unit, meaning.
std::string line(const std::string& name, const std::string& unit, const std::string& meaning) {
  return fmt::format("  {:<28} {:<5} {}\n", name, unit, meaning);
}

}  // namespace

// Quantities by the place where they are measured, then quotients, histories and fields of
// elements.
std::string columns_text() {
  std::string s =
      "Columns of curves: name, unit, meaning with its sign. In a CSV table a column is called "
      "name_unit, name alone without unit.\n";
  std::string heading;
  for (const QuantityLine& q : quantity_lines()) {
    if (heading_of(q) != heading) {
      heading = heading_of(q);
      s += fmt::format("\nquantity: {}\n", heading);
    }
    s += line(q.word, q.unit, fmt::format("{}: {}", plain(q.label), q.meaning));
  }
  s += "\nquotient: of two columns of one unit, by name, without unit; empty where the second is "
       "0\n";
  s += "\nhistory: what the solver wrote for every step, /history of a solution (of those with "
       "three numbers: quantities), and fields of elements\n";
  for (const solution::HistoryLine& h : solution::history_lines)
    s += line(h.name, h.unit, h.meaning);
  for (const solution::HistoryLine& h : solution::field_lines) s += line(h.name, h.unit, h.meaning);
  return s;
}

}  // namespace langer

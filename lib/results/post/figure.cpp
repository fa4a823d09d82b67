#include "results/post/figure.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "core/base/csv_table.hpp"
#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/writer.hpp"

namespace langer {

namespace {

// The column with a name, or nullptr.
const ColumnChoice* find(const std::vector<ColumnChoice>& columns, const std::string& name) {
  const auto found = std::ranges::find(columns, name, column_name);
  if (found == columns.end()) return nullptr;
  return &*found;
}

}  // namespace

PointColumns read_points(const FigurePoints& points,
                         const std::function<Place(const std::string& key)>& where) {
  const CsvTable table = read_table(points.file.path);
  const auto column = [&](const std::string& key, const std::string& name) {
    std::vector<std::string> known;
    for (const CsvCell& cell : table.header.cells) known.push_back(cell.text);
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw Failure(Exit::config,
                    Error{where("points." + key), "points." + key,
                          fmt::format("{} has no column \"{}\"", points.file.path, name),
                          "one of " + list_words(known), ""});
    std::vector<double> values;
    for (const CsvRow& row : table.rows)
      values.push_back(csv_number(row.cells[static_cast<std::size_t>(found - known.begin())].text)
                           .value_or(std::numeric_limits<double>::quiet_NaN()));
    return values;
  };
  return {column("x", points.x), column("y", points.y)};
}

std::string legend_of(const ColumnChoice& choice) {
  if (choice.name || !choice.quantity) return literal(column_name(choice));
  std::string family;
  if (line_of(*choice.quantity).needs.fibres && choice.family > 1) {
    family = fmt::format(", family {}", choice.family);
  }
  std::string place;
  if (choice.at) place = " at " + literal(*choice.at);
  return label_of(choice) + place + family;
}

// Columns that do not exist, and columns with different units on one axis.
std::vector<Complaint> complaints(const FigureChoice& figure,
                                  const std::vector<ColumnChoice>& columns) {
  std::vector<Complaint> found;
  std::vector<std::string> known;
  for (const ColumnChoice& c : columns) known.push_back(column_name(c));
  const auto check = [&](const std::string& key, const std::string& name) {
    if (find(columns, name)) return;
    const std::string near = nearest(name, known);
    found.push_back({key, fmt::format("there is no column \"{}\"", name),
                     fmt::format("one of {}", fmt::join(known, ", ")), did_you_mean(near)});
  };
  check("x", figure.x);
  for (std::size_t i = 0; i < figure.y.size(); ++i) check(fmt::format("y[{}]", i), figure.y[i]);
  if (figure.y.empty()) found.push_back({"y", "an empty list", "one or more columns", ""});
  if (!figure.legends.empty() && figure.legends.size() != figure.y.size())
    found.push_back(
        {"legends",
         fmt::format("{} legends for {} columns", figure.legends.size(), figure.y.size()),
         "one for each y", ""});
  if (!found.empty()) return found;
  // All columns of an axis must have one unit.
  const std::string first = unit_of(*find(columns, figure.y[0]));
  for (std::size_t i = 1; i < figure.y.size(); ++i)
    if (const std::string unit = unit_of(*find(columns, figure.y[i])); unit != first)
      found.push_back({fmt::format("y[{}]", i), fmt::format("{} in {}", figure.y[i], unit),
                       fmt::format("columns in {}, as the first", first), ""});
  return found;
}

Plot plot_of(const FigureChoice& figure, const std::vector<ColumnChoice>& columns,
             const std::string& csv, std::string (*head)(const std::string&, const std::string&)) {
  const auto head_of = [&](const std::string& name) {
    return head(name, unit_of(*find(columns, name)));
  };
  const ColumnChoice& x = *find(columns, figure.x);
  const ColumnChoice& y = *find(columns, figure.y[0]);
  Plot plot;
  plot.title = figure.title;
  plot.scale = figure.scale;
  plot.x_label = with_unit(figure.x_label.value_or(label_of(x)), unit_of(x));
  // Several quantities on one axis have a common label only if the user gives one.
  const bool one_label = std::ranges::all_of(figure.y, [&](const std::string& name) {
    return label_of(*find(columns, name)) == label_of(y);
  });
  plot.y_label_is_unit = !figure.y_label && !one_label;
  if (plot.y_label_is_unit) {
    plot.y_label = unit_of(y);
  } else {
    plot.y_label = with_unit(figure.y_label.value_or(label_of(y)), unit_of(y));
  }
  for (std::size_t i = 0; i < figure.y.size(); ++i) {
    std::string legend = legend_of(*find(columns, figure.y[i]));
    if (!figure.legends.empty()) legend = figure.legends[i];
    plot.lines.push_back({csv, head_of(figure.x), head_of(figure.y[i]), legend});
    // The first band that exists is drawn.
    for (const std::string& band : bands_of(figure.y[i]))
      if (find(columns, band) && plot.lines.back().error.empty())
        plot.lines.back().error = head_of(band);
  }
  return plot;
}

}  // namespace langer

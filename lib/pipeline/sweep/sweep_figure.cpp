#include "pipeline/sweep/sweep_figure.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/base/csv_table.hpp"
#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "pipeline/sweep/spread.hpp"
#include "results/post/figure.hpp"

namespace langer {

// Lists that belong to y must have its length, or contain names of y only.
std::vector<Complaint> SweepFigure::complaints() const {
  std::vector<Complaint> found;
  if (y.empty()) found.push_back({"y", "an empty list", "one or more names", ""});
  if (!legends.empty() && legends.size() != y.size())
    found.push_back({"legends", fmt::format("{} legends for {} names", legends.size(), y.size()),
                     "one for each y", ""});
  for (std::size_t i = 0; i < markers.size(); ++i)
    if (std::ranges::find(y, markers[i]) == y.end())
      found.push_back(
          {fmt::format("markers[{}]", i), markers[i], "one of y: " + list_words(y), ""});
  for (std::size_t i = 0; i < once.size(); ++i)
    if (std::ranges::find(y, once[i]) == y.end())
      found.push_back({fmt::format("once[{}]", i), once[i], "one of y: " + list_words(y), ""});
  return found;
}

// A pattern is used as it is; only the default adds units.
std::string member_text(const std::string& pattern, const std::vector<SweepAxis>& axes,
                        const std::vector<std::string>& at) {
  std::string values;
  for (std::size_t a = 0; a < at.size(); ++a) {
    std::string unit;
    if (a < axes.size() && axes[a].unit != "-") unit = axes[a].unit;
    if (a > 0) values += ", ";
    values += at[a];
    if (!pattern.empty() || unit.empty()) continue;
    if (unit == "deg") {
      values += "°";
    } else {
      values += " " + unit;
    }
  }
  std::string text = text_or(pattern, "{}");
  for (std::size_t i = text.find("{}"); i != std::string::npos;
       i = text.find("{}", i + values.size()))
    text.replace(i, 2, values);
  return text;
}

namespace {

// A CSV table of columns of different lengths. Cells below the end of a column are empty.
struct Table {
  std::vector<std::string> heads;
  std::vector<std::vector<double>> columns;

  // Adds a column and returns its head.
  std::string add(const std::string& head, std::vector<double> values) {
    heads.push_back(head);
    columns.push_back(std::move(values));
    return head;
  }
  // The text of the table; rows are as many as the longest column has.
  std::string csv() const {
    std::string text;
    for (const std::string& head : heads) append(text, ",", csv_cell(head));
    text += "\n";
    std::size_t rows = 0;
    for (const auto& c : columns) rows = std::max(rows, c.size());
    for (std::size_t i = 0; i < rows; ++i) {
      for (std::size_t c = 0; c < columns.size(); ++c) {
        if (c > 0) text += ",";
        text += cell(columns[c], i);
      }
      text += "\n";
    }
    return text;
  }

 private:
  static std::string cell(const std::vector<double>& column, std::size_t row) {
    if (row >= column.size() || std::isnan(column[row])) return "";
    return number_text(column[row]);
  }
};

// The label of a column on an axis: that of the quantity of the same name, or the name itself.
std::string label_of(const std::string& name) {
  const auto lines = quantity_lines();
  const auto found = std::ranges::find(lines, name, &QuantityLine::word);
  if (found == lines.end()) return literal(name);
  return found->label;
}

// An error with the names that members have, and a suggestion.
[[noreturn]] void unknown(const Place& place, const std::string& key, const std::string& name,
                          const std::vector<std::string>& known) {
  const std::string near = nearest(name, known);
  throw Failure(Exit::config, Error{place, key, fmt::format("no member has \"{}\"", name),
                                    "one of " + list_words(known), did_you_mean(near)});
}

// Builds one figure: the plot, and the table of the numbers in it.
class Drawer {
 public:
  Drawer(const SweepFigure& figure, const std::string& name, const std::vector<SweepAxis>& axes,
         const std::vector<SweepMember>& members,
         const std::function<Place(const std::string&)>& where)
      : figure_(figure),
        name_(name),
        file_(name + ".csv"),
        axes_(axes),
        members_(members),
        where_(where) {}

  // Chooses what x is, adds the lines, then the labels: the unit of y is known only when a line has
  // been added. With several y the label is their unit alone.
  FigureData data() {
    data_.plot.title = figure_.title;
    data_.plot.scale = figure_.scale;
    if (figure_.points) add_points(*figure_.points);
    const auto axis = std::ranges::find(axes_, figure_.x, &SweepAxis::name);
    if (axis == axes_.end() && axes_.size() == 1 && axes_[0].samples)
      over_samples();
    else if (axis == axes_.end())
      over_curves();
    else
      over_axis(static_cast<std::size_t>(axis - axes_.begin()));
    std::string y_label;
    if (figure_.y_label) {
      y_label = *figure_.y_label;
    } else if (figure_.y.size() == 1) {
      y_label = label_of(figure_.y[0]);
    }
    data_.plot.y_label_is_unit = y_label.empty();
    if (y_label.empty()) {
      data_.plot.y_label = y_unit_;
    } else {
      data_.plot.y_label = with_unit(y_label, y_unit_);
    }
    data_.csv = table_.csv();
    return std::move(data_);
  }

 private:
  const SweepFigure& figure_;
  const std::string name_, file_;
  const std::vector<SweepAxis>& axes_;
  const std::vector<SweepMember>& members_;
  const std::function<Place(const std::string&)>& where_;
  FigureData data_;
  Table table_;
  std::string y_unit_;

  // All y of a figure have the same unit.
  void check_unit(std::size_t i, const std::string& unit) {
    if (y_unit_.empty()) y_unit_ = unit;
    if (unit != y_unit_)
      throw Failure(Exit::config,
                    Error{where_(fmt::format("y[{}]", i)), fmt::format("y[{}]", i),
                          fmt::format("{} in {}", figure_.y[i], unit), "names in " + y_unit_, ""});
  }

  // Whether one y is drawn for each member. The members then differ in colour, otherwise in dashes.
  bool has_single_y() const { return figure_.y.size() == figure_.once.size() + 1; }

  // The name of a line: of its y, of its member, or of both if there are several of each.
  std::string legend(std::size_t i, const std::string& member) const {
    std::string name;
    if (figure_.legends.empty()) {
      name = label_of(figure_.y[i]);
    } else {
      name = figure_.legends[i];
    }
    if (member.empty()) return name;
    if (has_single_y() && figure_.legends.empty()) return member;
    return name + ", " + member;
  }

  // Adds a line. With several y of several members the colour is that of the y, and the dashes are
  // those of the member.
  void add_line(const std::string& x, const std::string& y, std::size_t i, std::size_t member,
                const std::string& member_name) {
    PlotLine line{file_, x, y, legend(i, member_name)};
    line.values = !member_name.empty() && figure_.member.empty();
    if (figure_.y.size() > figure_.once.size() + 1 && !member_name.empty()) {
      line.colour = static_cast<int>(i);
      line.dash = static_cast<int>(member);
    }
    line.points = std::ranges::find(figure_.markers, figure_.y[i]) != figure_.markers.end();
    data_.plot.lines.push_back(line);
  }

  // Adds the measured points.
  void add_points(const FigurePoints& points) {
    const PointColumns read = read_points(points, where_);
    PlotLine line{file_, table_.add("points_" + points.x, read.x),
                  table_.add("points_" + points.y, read.y), points.legend};
    line.points = true;
    data_.plot.lines.push_back(line);
    data_.plot.rows = static_cast<int>(read.x.size());
  }

  // The values of a summary's quantity for the members of a line; NaN for a member without it.
  // Sets the unit if any member has it.
  static std::vector<double> summary_values(
      const std::vector<std::pair<double, const SweepMember*>>& points, const std::string& name,
      std::string& unit) {
    std::vector<double> y;
    for (const auto& [x, member] : points) {
      const auto s = std::ranges::find(member->summary, name, &Summary::name);
      if (s == member->summary.end()) {
        y.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      y.push_back(s->value);
      unit = s->unit;
    }
    return y;
  }

  // x is an axis of the sweep. Members that differ in this axis only are the points of one line.
  void over_axis(std::size_t axis) {
    // Lines are found by the values on the other axes, in the order of the members.
    std::vector<std::vector<std::string>> others;  // values on the other axes, one for each line
    for (const SweepMember& m : members_) {
      const auto rest = without(m.at, axis);
      if (std::ranges::find(others, rest) == others.end()) others.push_back(rest);
    }
    std::vector<SweepAxis> other_axes = axes_;
    other_axes.erase(other_axes.begin() + static_cast<std::ptrdiff_t>(axis));
    data_.plot.x_label = with_unit(figure_.x_label.value_or(literal(figure_.x)), axes_[axis].unit);
    for (std::size_t g = 0; g < others.size(); ++g) {
      std::vector<std::pair<double, const SweepMember*>> points;
      for (const SweepMember& m : members_)
        if (without(m.at, axis) == others[g]) points.push_back({number(m.at[axis]), &m});
      std::ranges::stable_sort(points, {}, &std::pair<double, const SweepMember*>::first);
      std::vector<double> x;
      for (const auto& [value, member] : points) x.push_back(value);
      // Axes of angles have a tick every 30 degrees.
      if (axes_[axis].unit == "deg" && x.back() - x.front() >= 90 && x.back() - x.front() <= 360)
        data_.plot.x_step = 30;
      std::string ending;
      std::string name;
      if (others.size() > 1) {
        ending = fmt::format("_{}", fmt::join(others[g], "_"));
        name = literal(member_text(figure_.member, other_axes, others[g]));
      }
      const std::string x_head = table_.add(csv_name(figure_.x + ending, axes_[axis].unit), x);
      for (std::size_t i = 0; i < figure_.y.size(); ++i) {
        std::string unit;
        const std::vector<double> y = summary_values(points, figure_.y[i], unit);
        if (unit.empty())
          unknown(where_(fmt::format("y[{}]", i)), fmt::format("y[{}]", i), figure_.y[i],
                  summary_names());
        check_unit(i, unit);
        const std::string y_head = table_.add(csv_name(figure_.y[i] + ending, unit), y);
        add_line(x_head, y_head, i, g, name);
      }
    }
  }

  // x is a column of the members' curves. A member whose x is that of the first one shares its
  // column in the table.
  void over_curves() {
    for (std::size_t k = 0; k < members_.size(); ++k) {
      const SweepMember& m = members_[k];
      const Column& x = column(m, "x", figure_.x);
      std::string number = std::to_string(k + 1);
      std::string name = number;
      if (!m.at.empty()) {
        number = fmt::format("{}", fmt::join(m.at, "_"));
        name = literal(member_text(figure_.member, axes_, m.at));
      }
      const std::string ending = "_" + number;
      std::string x_head = csv_name(x.name, x.unit);
      if (k > 0 && x.values != column(members_[0], "x", figure_.x).values)
        x_head = table_.add(csv_name(x.name + ending, x.unit), x.values);
      if (k == 0) table_.add(x_head, x.values);
      data_.plot.x_label = with_unit(figure_.x_label.value_or(label_of(figure_.x)), x.unit);
      data_.plot.rows = std::max(data_.plot.rows, static_cast<int>(x.values.size()));
      for (std::size_t i = 0; i < figure_.y.size(); ++i) {
        const Column& y = column(m, fmt::format("y[{}]", i), figure_.y[i]);
        const bool once = std::ranges::find(figure_.once, figure_.y[i]) != figure_.once.end();
        if (once && k > 0) continue;
        check_unit(i, y.unit);
        const std::string y_head = table_.add(csv_name(y.name + ending, y.unit), y.values);
        add_line(x_head, y_head, i, k, once ? "" : name);
      }
    }
  }

  // x is a column of the members' curves, and the members are samples of fitted parameters: draws
  // their mean and a band.
  void over_samples() {
    std::vector<const Column*> x;
    for (const SweepMember& m : members_) x.push_back(&column(m, "x", figure_.x));
    const std::string x_head = table_.add(csv_name(x[0]->name, x[0]->unit), x[0]->values);
    data_.plot.x_label = with_unit(figure_.x_label.value_or(literal(figure_.x)), x[0]->unit);
    data_.plot.rows = static_cast<int>(x[0]->values.size());
    for (std::size_t i = 0; i < figure_.y.size(); ++i) {
      std::vector<const Column*> y;
      for (const SweepMember& m : members_)
        y.push_back(&column(m, fmt::format("y[{}]", i), figure_.y[i]));
      check_unit(i, y[0]->unit);
      // The table has mean, deviation and interval; the picture has the mean and the deviation.
      const Band band = band_of(name_, x, y);
      const std::string unit = y[0]->unit;
      const std::string mean = table_.add(csv_name(figure_.y[i] + "_mean", unit), band.mean.values);
      const std::string deviation =
          table_.add(csv_name(figure_.y[i] + "_deviation", unit), band.deviation.values);
      table_.add(csv_name(figure_.y[i] + "_lower_95", unit), band.low.values);
      table_.add(csv_name(figure_.y[i] + "_upper_95", unit), band.high.values);
      PlotLine line{file_, x_head, mean, legend(i, "")};
      line.error = deviation;
      data_.plot.lines.push_back(line);
      data_.bands.push_back(band);
    }
  }

  // A column of a member's curves; refuses a name that it does not have.
  const Column& column(const SweepMember& m, const std::string& key,
                       const std::string& name) const {
    std::vector<std::string> known;
    for (const SweepAxis& a : axes_)
      if (key == "x") known.push_back(a.name);
    for (const Column& c : m.curves.columns) {
      if (c.name == name) return c;
      known.push_back(c.name);
    }
    unknown(where_(key), key, name, known);
  }
  // The quantities of all members, for messages.
  std::vector<std::string> summary_names() const {
    std::vector<std::string> names;
    for (const SweepMember& m : members_)
      for (const Summary& s : m.summary)
        if (std::ranges::find(names, s.name) == names.end()) names.push_back(s.name);
    return names;
  }

  // Values on all axes but one.
  static std::vector<std::string> without(std::vector<std::string> at, std::size_t axis) {
    at.erase(at.begin() + static_cast<std::ptrdiff_t>(axis));
    return at;
  }

  // The value on an axis as a number; refuses a word.
  double number(const std::string& word) const {
    double x = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (error != std::errc{} || end != word.data() + word.size())
      throw Failure(
          Exit::config,
          Error{where_("x"), "x", fmt::format("the axis {} has the word \"{}\"", figure_.x, word),
                "an axis of numbers, or a column of the members' tables", ""});
    return x;
  }
};

}  // namespace

FigureData figure_over(const SweepFigure& figure, const std::string& name,
                       const std::vector<SweepAxis>& axes, const std::vector<SweepMember>& members,
                       const std::function<Place(const std::string& key)>& where) {
  return Drawer(figure, name, axes, members, where).data();
}

}  // namespace langer

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

std::vector<Complaint> SweepFigure::complaints() const {
  std::vector<Complaint> found;
  if (y.empty()) found.push_back({"y", "an empty list", "one or more names", ""});
  if (!legends.empty() && legends.size() != y.size())
    found.push_back({"legends", fmt::format("{} legends for {} names", legends.size(), y.size()),
                     "one for each y", ""});
  for (std::size_t i = 0; i < markers.size(); ++i)
    if (std::find(y.begin(), y.end(), markers[i]) == y.end())
      found.push_back(
          {fmt::format("markers[{}]", i), markers[i], "one of y: " + list_words(y), ""});
  for (std::size_t i = 0; i < once.size(); ++i)
    if (std::find(y.begin(), y.end(), once[i]) == y.end())
      found.push_back({fmt::format("once[{}]", i), once[i], "one of y: " + list_words(y), ""});
  return found;
}

std::string member_text(const std::string& pattern, const std::vector<SweepAxis>& axes,
                        const std::vector<std::string>& at) {
  std::string values;
  for (std::size_t a = 0; a < at.size(); ++a) {
    std::string unit;
    if (a < axes.size() && axes[a].unit != "-") unit = axes[a].unit;
    if (a > 0) values += ", ";
    values += at[a];
    if (pattern.empty() && !unit.empty()) {
      if (unit == "deg") {
        values += "°";
      } else {
        values += " " + unit;
      }
    }
  }
  std::string text = text_or(pattern, "{}");
  for (std::size_t i = text.find("{}"); i != std::string::npos;
       i = text.find("{}", i + values.size()))
    text.replace(i, 2, values);
  return text;
}

namespace {

// Columns of different lengths side by side, with their heads.
struct Table {
  std::vector<std::string> heads;
  std::vector<std::vector<double>> columns;

  std::string add(const std::string& head, std::vector<double> values) {
    heads.push_back(head);
    columns.push_back(std::move(values));
    return head;
  }
  std::string csv() const {
    std::string text;
    for (const std::string& head : heads) append(text, ",", csv_cell(head));
    text += "\n";
    std::size_t rows = 0;
    for (const auto& c : columns) rows = std::max(rows, c.size());
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const bool there = i < columns[c].size() && !std::isnan(columns[c][i]);
        text += (there ? number_text(columns[c][i]) : "") + (c + 1 < columns.size() ? "," : "\n");
      }
    return text;
  }
};

// what a column of that name shows, where it has the name of a quantity
std::string shown(const std::string& name) {
  const auto lines = quantity_lines();
  const auto found = std::find_if(lines.begin(), lines.end(),
                                  [&](const QuantityLine& line) { return line.word == name; });
  if (found == lines.end()) return literal(name);
  return found->label;
}

[[noreturn]] void unknown(const Place& place, const std::string& key, const std::string& name,
                          const std::vector<std::string>& known) {
  const std::string near = nearest(name, known);
  throw Failure(Exit::config, Error{place, key, fmt::format("no member has \"{}\"", name),
                                    "one of " + list_words(known), did_you_mean(near)});
}

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

  FigureData data() {
    data_.plot.title = figure_.title;
    data_.plot.scale = figure_.scale;
    if (figure_.points) add_points(*figure_.points);
    const auto axis = std::find_if(axes_.begin(), axes_.end(),
                                   [&](const SweepAxis& a) { return a.name == figure_.x; });
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
      y_label = shown(figure_.y[0]);
    } else {
      y_label = "";
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

  void take_unit(std::size_t i, const std::string& unit) {
    if (y_unit_.empty()) y_unit_ = unit;
    if (unit != y_unit_)
      throw Failure(Exit::config,
                    Error{where_(fmt::format("y[{}]", i)), fmt::format("y[{}]", i),
                          fmt::format("{} in {}", figure_.y[i], unit), "names in " + y_unit_, ""});
  }
  std::string legend(std::size_t i, const std::string& member) const {
    std::string name;
    if (figure_.legends.empty()) {
      name = shown(figure_.y[i]);
    } else {
      name = figure_.legends[i];
    }
    if (member.empty()) return name;
    const bool alone =
        figure_.y.size() == figure_.once.size() + 1;  // of those drawn for each member
    if (alone && figure_.legends.empty()) return member;
    return name + ", " + member;
  }
  // several y of several members: colours are the y, dashes the members
  void add_line(const std::string& x, const std::string& y, std::size_t i, std::size_t member,
                const std::string& member_name) {
    PlotLine line{file_, x, y, legend(i, member_name)};
    line.values = !member_name.empty() && figure_.member.empty();
    if (figure_.y.size() > figure_.once.size() + 1 && !member_name.empty()) {
      line.colour = static_cast<int>(i);
      line.dash = static_cast<int>(member);
    }
    line.points = std::find(figure_.markers.begin(), figure_.markers.end(), figure_.y[i]) !=
                  figure_.markers.end();
    data_.plot.lines.push_back(line);
  }

  void add_points(const FigurePoints& points) {
    const PointColumns read = read_points(points, where_);
    PlotLine line{file_, table_.add("points_" + points.x, read.x),
                  table_.add("points_" + points.y, read.y), points.legend};
    line.points = true;
    data_.plot.lines.push_back(line);
    data_.plot.rows = static_cast<int>(read.x.size());
  }

  void over_axis(std::size_t axis) {
    // groups of members that differ in this axis only
    std::vector<std::vector<std::string>> others;
    for (const SweepMember& m : members_)
      if (const auto rest = without(m.at, axis);
          std::find(others.begin(), others.end(), rest) == others.end())
        others.push_back(rest);
    std::vector<SweepAxis> other_axes = axes_;
    other_axes.erase(other_axes.begin() + static_cast<std::ptrdiff_t>(axis));
    data_.plot.x_label = with_unit(figure_.x_label.value_or(literal(figure_.x)), axes_[axis].unit);
    for (std::size_t g = 0; g < others.size(); ++g) {
      std::vector<std::pair<double, const SweepMember*>> points;
      for (const SweepMember& m : members_)
        if (without(m.at, axis) == others[g]) points.push_back({number(m.at[axis]), &m});
      std::stable_sort(points.begin(), points.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      std::vector<double> x;
      for (const auto& [value, member] : points) x.push_back(value);
      if (axes_[axis].unit == "deg" && x.back() - x.front() >= 90 && x.back() - x.front() <= 360)
        data_.plot.x_step = 30;
      std::string ending;
      if (others.size() > 1) ending = fmt::format("_{}", fmt::join(others[g], "_"));
      const std::string x_head = table_.add(csv_name(figure_.x + ending, axes_[axis].unit), x);
      for (std::size_t i = 0; i < figure_.y.size(); ++i) {
        std::vector<double> y;
        std::string unit;
        for (const auto& [value, member] : points) {
          const auto s =
              std::find_if(member->summary.begin(), member->summary.end(),
                           [&](const Summary& found) { return found.name == figure_.y[i]; });
          const bool there = s != member->summary.end();
          y.push_back(there ? s->value : std::numeric_limits<double>::quiet_NaN());
          if (there) unit = s->unit;
        }
        if (unit.empty())
          unknown(where_(fmt::format("y[{}]", i)), fmt::format("y[{}]", i), figure_.y[i],
                  summary_names());
        take_unit(i, unit);
        const std::string y_head = table_.add(csv_name(figure_.y[i] + ending, unit), y);
        add_line(
            x_head, y_head, i, g,
            others.size() > 1 ? literal(member_text(figure_.member, other_axes, others[g])) : "");
      }
    }
  }

  void over_curves() {
    for (std::size_t k = 0; k < members_.size(); ++k) {
      const SweepMember& m = members_[k];
      const Column& x = column(m, "x", figure_.x);
      const bool shared = k > 0 && x.values == column(members_[0], "x", figure_.x).values;
      const std::string ending =
          "_" + (m.at.empty() ? std::to_string(k + 1) : fmt::format("{}", fmt::join(m.at, "_")));
      std::string x_head;
      if (shared) {
        x_head = csv_name(x.name, x.unit);
      } else {
        x_head = table_.add(csv_name(x.name + (k ? ending : ""), x.unit), x.values);
      }
      data_.plot.x_label = with_unit(figure_.x_label.value_or(shown(figure_.x)), x.unit);
      data_.plot.rows = std::max(data_.plot.rows, static_cast<int>(x.values.size()));
      for (std::size_t i = 0; i < figure_.y.size(); ++i) {
        const Column& y = column(m, fmt::format("y[{}]", i), figure_.y[i]);
        const bool once =
            std::find(figure_.once.begin(), figure_.once.end(), figure_.y[i]) != figure_.once.end();
        if (once && k > 0) continue;
        take_unit(i, y.unit);
        const std::string y_head = table_.add(csv_name(y.name + ending, y.unit), y.values);
        std::string name;
        if (m.at.empty()) {
          name = ending.substr(1);
        } else {
          name = literal(member_text(figure_.member, axes_, m.at));
        }
        add_line(x_head, y_head, i, k, once ? "" : name);
      }
    }
  }

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
      take_unit(i, y[0]->unit);
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
  std::vector<std::string> summary_names() const {
    std::vector<std::string> names;
    for (const SweepMember& m : members_)
      for (const Summary& s : m.summary)
        if (std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
    return names;
  }
  static std::vector<std::string> without(std::vector<std::string> at, std::size_t axis) {
    at.erase(at.begin() + static_cast<std::ptrdiff_t>(axis));
    return at;
  }
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

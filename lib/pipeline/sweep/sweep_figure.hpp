// Figures over the members of a sweep.
//   x is an axis of the sweep   one point per member, from its summary; a line for each y, and for
//                               each value of the other axes
//   x is a column               a line for each y and member, from the members' curves
//   x is a column, and the axis numbers samples of fitted parameters
//                               a line for each y: the mean of the samples, with a band of one
//                               standard deviation
// The numbers in the figure are written to <name>.csv.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/fields.hpp"
#include "pipeline/sweep/gather.hpp"
#include "results/post/figure.hpp"
#include "results/post/map.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

// A figure as the config describes it.
struct SweepFigure {
  std::string x;
  std::vector<std::string> y, legends, markers, once;
  std::string title, member;
  std::optional<FigurePoints> points;
  std::optional<std::string> x_label, y_label;
  AxisScale scale = AxisScale::linear;
  static void fields(auto& v) {
    v(&SweepFigure::x, "x", unit::none,
      "an axis of the sweep, or a column of the members' tables, without its unit", required);
    v(&SweepFigure::y, "y", unit::none,
      "names from the summary, or columns of the members' tables; of the same unit", required);
    v(&SweepFigure::legends, "legends", unit::none, "one for each y; by default the names");
    v(&SweepFigure::markers, "markers", unit::none,
      "names of y that are drawn as open markers without a line, so that they can be seen on "
      "curves that they coincide with");
    v(&SweepFigure::once, "once", unit::none,
      "names of y that are the same for every member, such as measured values; drawn for the "
      "first");
    v(&SweepFigure::member, "member", unit::none,
      "name of a member in legends; {} is replaced by its value on the axes; by default the value "
      "and its unit");
    v(&SweepFigure::points, "points", unit::none, "measured points, drawn first");
    v(&SweepFigure::title, "title", unit::none, "above the figure");
    v(&SweepFigure::x_label, "x_label", unit::none, "name of x; the unit is added");
    v(&SweepFigure::y_label, "y_label", unit::none, "name of y; the unit is added");
    v(&SweepFigure::scale, "scale", unit::none, "logarithmic axes");
  }
  std::vector<Complaint> complaints() const;
};

// The difference of each member's map from that of one member.
struct MapComparison {
  std::vector<std::string> with;
  double beyond = 0;
  static void fields(auto& v) {
    v(&MapComparison::with, "with", unit::none,
      "values on the axes of the member that the others are compared with", required);
    v(&MapComparison::beyond, "beyond", unit::mm,
      "nodes closer to x = z = 0 do not count, for example those under an indenter", at_least(0));
  }
};

// The maps of all members in one picture.
struct SweepMap {
  int columns = 3;
  std::string member;
  std::optional<MapComparison> compare;
  MapStyle style;
  static void fields(auto& v) {
    v(&SweepMap::columns, "columns", unit::none, "panels side by side", between(1, 20));
    v(&SweepMap::member, "member", unit::none,
      "title of each panel; {} is replaced by the member's value on the axes; by default the value "
      "and its unit");
    v(&SweepMap::compare, "compare", unit::none,
      "adds the column <map>_difference: the largest difference of each member's map from that of "
      "one member, relative to the largest value of that one");
    v(&SweepMap::style, "style", unit::none, "style of the map");
  }
};

// A member with the values that figures may need.
struct SweepMember {
  std::vector<std::string> at;
  std::vector<Summary> summary;
  Curves curves;
};

// The name of a member in legends; see SweepFigure::member.
std::string member_text(const std::string& pattern, const std::vector<SweepAxis>& axes,
                        const std::vector<std::string>& at);

// Mean, standard deviation, and percentiles 2.5 and 97.5 of the curves of samples
// (sweep/spread.hpp).
struct Band {
  std::string figure;
  Column x, mean, deviation, low, high;
};
// A figure that is ready to be drawn, and the table of its numbers.
struct FigureData {
  Plot plot;
  std::string csv;
  std::vector<Band> bands = {};  // of samples, instead of a line for each member
};

// Throws Failure(config) at `where`("x"), `where`("y[0]") ... for names that no member has.
FigureData figure_over(const SweepFigure& figure, const std::string& name,
                       const std::vector<SweepAxis>& axes, const std::vector<SweepMember>& members,
                       const std::function<Place(const std::string& key)>& where);

}  // namespace langer

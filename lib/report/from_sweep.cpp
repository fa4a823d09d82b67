// Sweeps in a report: the table of all members, and pictures if the members differ in one number.
// Over an angle the results are drawn as polar diagrams, together with the residuals of symmetries
// that a square scene must have: a mesh without that symmetry shows up there. A sweep over samples
// of fitted parameters has the spread of each quantity instead.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/hdf5/h5.hpp"
#include "core/hdf5/unit_attribute.hpp"
#include "report/labels.hpp"
#include "report/sources.hpp"
#include "results/store/provenance.hpp"

namespace langer::report {

namespace {

bool is_finite(double v) { return std::isfinite(v); }

// One axis of a sweep with its value at each member: numbers, or words.
struct Axis {
  std::string name, unit;
  std::vector<double> numbers;
  std::vector<std::string> words;  // empty if the values are numbers
  Cell at(std::size_t i) const {
    if (words.empty()) return Cell(numbers[i]);
    return Cell(words[i]);
  }
};

// Words are stored as indices into the attribute "words".
Axis read_axis(const h5::Group& group, const std::string& name) {
  Axis axis{name, group.unit(name), {}, {}};
  const std::string all = group.annotation(name, "words");
  if (all.empty()) {
    axis.numbers = group.read<double>(name, {h5::any}).values;
    return axis;
  }
  std::vector<std::string> known;
  std::istringstream in(all);
  for (std::string word; in >> word;) known.push_back(word);
  for (const std::int64_t i : group.read<std::int64_t>(name, {h5::any}).values) {
    if (i < 0 || i >= static_cast<std::int64_t>(known.size()))
      group.refuse(name, fmt::format("{}", i), "an index of its words");
    axis.words.push_back(known[static_cast<std::size_t>(i)]);
  }
  return axis;
}

// Whether a name has a place, which is a part of one capital letter: A in u_y_A_half. `around` is
// then the name with the place replaced by an asterisk.
bool at_place(const std::string& name, char place, std::string& around) {
  for (std::size_t i = name.size(); i-- > 1;) {
    const bool begins = name[i] == place && name[i - 1] == '_';
    const bool ends = i + 1 == name.size() || name[i + 1] == '_';
    if (!begins || !ends) continue;
    around = name.substr(0, i) + '*' + name.substr(i + 1);
    return true;
  }
  return false;
}

// Columns of one family differ in their place only.
std::string family(const std::string& name) {
  std::string around;
  for (char place = 'A'; place <= 'Z'; ++place)
    if (at_place(name, place, around)) return around;
  return name;
}

// The title of a family: u_y_*_half without its place, in words.
std::string family_title(std::string name) {
  std::erase(name, '*');
  while (name.find("__") != std::string::npos) name.replace(name.find("__"), 2, "_");
  if (!name.empty() && name.back() == '_') name.pop_back();
  return in_words(name);
}

// Residuals of the symmetries of a square scene: mirror images of the fibre angle, and the quarter
// turn that carries place A to B and C to D (report_symmetry.hpp).
void add_residuals(Polar& polar) {
  for (const Series& a : polar.series) {
    if (const auto r = mirror_residual(a.name, polar.angle, a.y)) polar.residuals.push_back(*r);
    std::string around;
    char partner = 0;
    if (at_place(a.name, 'C', around)) partner = 'D';
    if (at_place(a.name, 'A', around)) partner = 'B';
    if (partner == 0) continue;
    for (const Series& b : polar.series) {
      std::string other;
      if (!at_place(b.name, partner, other)) continue;
      if (const auto r = swap_residual(a.name, b.name, polar.angle, a.y, b.y))
        polar.residuals.push_back(*r);
    }
  }
}

// A sweep over an angle: one polar diagram for each family of columns.
void add_polars(ReportPage& page, const Axis& axis, const std::vector<Series>& columns,
                const std::vector<std::string>& units) {
  std::vector<std::string> done;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string name = family(columns[c].name);
    if (std::ranges::find(done, name + units[c]) != done.end()) continue;
    done.push_back(name + units[c]);
    Polar polar{family_title(name), axis.name, units[c], axis.numbers, {}, {}};
    for (std::size_t d = c; d < columns.size(); ++d)
      if (family(columns[d].name) == name && units[d] == units[c])
        polar.series.push_back(columns[d]);
    add_residuals(polar);
    page.polars.push_back(std::move(polar));
  }
}

// The spread of results that the covariance of a fitted material causes: mean, standard deviation
// and interval of each quantity, and bands of curves.
void add_spread(ReportPage& page, const Source& source, const h5::Group& root) {
  if (!root.has("spread")) return;
  const h5::Group spread = root.group("spread");
  ReportTable table{"Uncertainty of the results from the parameters: " + source.label,
                    {{"quantity", "-"},
                     {"unit", "-"},
                     {"mean", "-"},
                     {"standard deviation", "-"},
                     {"lower 95 %", "-"},
                     {"upper 95 %", "-"},
                     {"most important parameter", "-"},
                     {"standard deviation if it were known", "-"}},
                    {}};
  for (const std::string& name : spread.groups()) {
    const h5::Group one = spread.group(name);
    const double mean = one.read_scalar("mean");
    const double deviation = one.read_scalar("deviation");
    const std::vector<double> interval = one.read<double>("interval", {1, 2}).values;
    const std::vector<double> without = one.read<double>("without", {h5::any}).values;
    std::istringstream order(one.text_attribute("order"));
    std::string most;
    order >> most;  // the parameter whose knowledge would help most is the first one
    double left = std::nan("");
    if (!without.empty()) left = without[0];
    table.rows.push_back(
        {name, one.unit("mean"), mean, deviation, interval.at(0), interval.at(1), most, left});
    if (!std::isfinite(deviation) || mean == 0 || most.empty()) continue;
    page.verdicts.push_back(
        {Level::note, source.label,
         fmt::format("{} {:.4g} {} ± {:.2g} % from the uncertainty of the fitted parameters; "
                     "{:.2g} % if {} were known",
                     name, mean, one.unit("mean"), 100 * deviation / std::abs(mean),
                     100 * left / std::abs(mean), most)});
  }
  page.tables.push_back(std::move(table));
  const h5::Group bands = root.group("bands");
  for (const std::string& name : bands.groups()) {
    const h5::Group one = bands.group(name);
    const auto values = [&](const char* of) {
      return one.read<double>(of, {h5::any}).values;
    };
    const std::string x = one.text_attribute("x");
    const std::string y = one.text_attribute("y");
    Series mean{"mean of the samples, ± one standard deviation", values("x"), values("mean")};
    mean.error = values("deviation");
    page.charts.push_back({"sweep",
                           in_words(y),
                           in_words(x),
                           one.unit("x"),
                           in_words(y),
                           one.unit("mean"),
                           {mean},
                           false});
  }
}

// A symmetry of the scene that the results miss by more than 2 %.
void judge_symmetry(ReportPage& page, const Source& source) {
  for (const Polar& polar : page.polars)
    for (const SymmetryResidual& r : polar.residuals) {
      if (r.value <= 0.02) continue;
      page.verdicts.push_back(
          {Level::warning, source.label,
           fmt::format("{} fails by {:.2g} % of the largest value: the mesh, or the scene, lacks "
                       "that symmetry",
                       r.says, 100 * r.value)});
    }
}

// One chart for each column over a numerical axis.
void add_sweep_charts(ReportPage& page, const Axis& axis, const std::vector<Series>& columns,
                      const std::vector<std::string>& units) {
  for (std::size_t c = 0; c < columns.size(); ++c)
    page.charts.push_back({"sweep",
                           in_words(columns[c].name),
                           axis.name,
                           axis.unit,
                           in_words(columns[c].name),
                           units[c],
                           {columns[c]},
                           false});
}

}  // namespace

// The table of a sweep. With one axis of numbers also charts, or polar diagrams if it is an angle.
void add_sweeps(ReportPage& page, const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    const h5::File file = h5::File::open(source.path);
    read_identity(file.root(), sweep_schema);
    const h5::Group axis_group = file.root().group("axis");
    const h5::Group values = file.root().group("values");
    std::vector<Axis> axes;
    for (const std::string& name : axis_group.datasets())
      axes.push_back(read_axis(axis_group, name));
    // Rows begin with the values on the axes; without an axis, with the name of the member.
    std::istringstream members(file.root().read_text("members"));
    ReportTable table{"Sweep: " + source.label, {}, {}};
    for (std::string member; std::getline(members, member);) {
      table.rows.emplace_back();
      if (axes.empty()) table.rows.back().push_back(member);
    }
    const std::size_t n = table.rows.size();
    if (axes.empty()) table.columns.push_back({"member", "-"});
    for (const Axis& axis : axes) {
      if (std::max(axis.numbers.size(), axis.words.size()) != n)
        axis_group.refuse(axis.name, "another number of members");
      table.columns.push_back({axis.name, axis.unit});
      for (std::size_t i = 0; i < n; ++i) table.rows[i].push_back(axis.at(i));
    }
    const bool numeric = axes.size() == 1 && axes[0].words.empty();
    const bool is_curve = numeric && n > 1;
    const bool is_angle = numeric && n > 2 && axes[0].unit == "deg";
    // A column with a gap (a member without the quantity) is in the table, but has no curve.
    std::vector<Series> columns;
    std::vector<std::string> units;
    for (const std::string& name : values.datasets()) {
      require_known_unit(values, name);
      const auto column = values.read<double>(name, {n}).values;
      table.columns.push_back({name, values.unit(name)});
      for (std::size_t i = 0; i < n; ++i) table.rows[i].push_back(column[i]);
      if (!is_curve || !std::ranges::all_of(column, is_finite)) continue;
      columns.push_back({name, axes[0].numbers, column, false});
      units.push_back(values.unit(name));
    }
    page.tables.push_back(std::move(table));
    add_spread(page, source, file.root());
    // The members of a design or of a sample of parameters have no order, so they are no curve.
    const bool ordered = is_curve && axes[0].name != "sample" && !file.root().has("spread");
    if (is_angle)
      add_polars(page, axes[0], columns, units);
    else if (ordered)
      add_sweep_charts(page, axes[0], columns, units);
    judge_symmetry(page, source);
  }
}

}  // namespace langer::report

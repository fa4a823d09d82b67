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

struct Axis {
  std::string name, unit;
  std::vector<double> numbers;
  std::vector<std::string> words;  // where they are no numbers
  Cell at(std::size_t i) const {
    if (words.empty()) return Cell(numbers[i]);
    return Cell(words[i]);
  }
};

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

// u_y_A_half: A; the last part that is one capital letter, with what stands around it
bool at_place(const std::string& name, char place, std::string& around) {
  for (std::size_t i = name.size(); i-- > 1;)
    if (name[i] == place && name[i - 1] == '_' && (i + 1 == name.size() || name[i + 1] == '_')) {
      around = name.substr(0, i) + '*' + name.substr(i + 1);
      return true;
    }
  return false;
}

std::string family(const std::string& name) {
  std::string around;
  for (char place = 'A'; place <= 'Z'; ++place)
    if (at_place(name, place, around)) return around;
  return name;
}

// columns of one family in one picture, with what the symmetry of the scene asks of them
void add_polars(ReportPage& page, const Axis& axis, const std::vector<Series>& columns,
                const std::vector<std::string>& units) {
  std::vector<std::string> done;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string of = family(columns[c].name);
    if (std::find(done.begin(), done.end(), of + units[c]) != done.end()) continue;
    done.push_back(of + units[c]);
    Polar polar{of, axis.name, units[c], axis.numbers, {}, {}};
    std::erase(polar.title, '*');
    while (polar.title.find("__") != std::string::npos)
      polar.title.replace(polar.title.find("__"), 2, "_");
    if (!polar.title.empty() && polar.title.back() == '_') polar.title.pop_back();
    polar.title = in_words(polar.title);
    for (std::size_t d = c; d < columns.size(); ++d)
      if (family(columns[d].name) == of && units[d] == units[c]) polar.series.push_back(columns[d]);
    for (std::size_t i = 0; i < polar.series.size(); ++i) {
      const Series& a = polar.series[i];
      if (const auto r = mirror_residual(a.name, axis.numbers, a.y)) polar.residuals.push_back(*r);
      std::string around;
      if (!at_place(a.name, 'A', around) && !at_place(a.name, 'C', around)) continue;
      for (const Series& b : polar.series) {
        std::string other;
        if (!at_place(b.name, at_place(a.name, 'A', around) ? 'B' : 'D', other)) continue;
        if (const auto r = swap_residual(a.name, b.name, axis.numbers, a.y, b.y))
          polar.residuals.push_back(*r);
      }
    }
    page.polars.push_back(std::move(polar));
  }
}

// what a fit leaves open in each quantity, and in curves
void add_spread(ReportPage& page, const Source& source, const h5::Group& root) {
  if (!root.has("spread")) return;
  const h5::Group spread = root.group("spread");
  ReportTable table{"What the parameters leave open: " + source.label,
                    {{"quantity", "-"},
                     {"unit", "-"},
                     {"mean", "-"},
                     {"standard deviation", "-"},
                     {"lower 95 %", "-"},
                     {"upper 95 %", "-"},
                     {"parameter that matters most", "-"},
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
    order >> most;  // the one that would help most stands first
    double left = std::nan("");
    if (!without.empty()) left = without[0];
    table.rows.push_back(
        {name, one.unit("mean"), mean, deviation, interval.at(0), interval.at(1), most, left});
    if (std::isfinite(deviation) && mean != 0 && !most.empty())
      page.verdicts.push_back(
          {Level::note, source.label,
           fmt::format(
               "{} {:.4g} {} ± {:.2g} % by what the fit leaves open of the parameters; {:.2g} % if {} were known",
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

}  // namespace

void add_sweeps(ReportPage& page, const std::vector<Source>& sources) {
  for (const Source& source : sources) {
    const h5::File file = h5::File::open(source.path);
    read_identity(file.root(), sweep_schema);
    const h5::Group axis_group = file.root().group("axis");
    const h5::Group values = file.root().group("values");
    std::vector<Axis> axes;
    for (const std::string& name : axis_group.datasets())
      axes.push_back(read_axis(axis_group, name));
    std::istringstream members(file.root().read_text("members"));
    ReportTable table{"Sweep: " + source.label, {}, {}};
    for (std::string member; std::getline(members, member);)
      table.rows.push_back(axes.empty() ? std::vector<Cell>{member} : std::vector<Cell>{});
    const std::size_t n = table.rows.size();
    if (axes.empty()) table.columns.push_back({"member", "-"});
    for (const Axis& axis : axes) {
      if (std::max(axis.numbers.size(), axis.words.size()) != n)
        axis_group.refuse(axis.name, "another number of members");
      table.columns.push_back({axis.name, axis.unit});
      for (std::size_t i = 0; i < n; ++i) table.rows[i].push_back(axis.at(i));
    }
    const Axis* angle =
        axes.size() == 1 && axes[0].unit == "deg" && axes[0].words.empty() ? &axes[0] : nullptr;
    const Axis* along = axes.size() == 1 && axes[0].words.empty() && n > 1 ? &axes[0] : nullptr;
    std::vector<Series> columns;
    std::vector<std::string> units;
    for (const std::string& name : values.datasets()) {
      require_known_unit(values, name);
      const auto column = values.read<double>(name, {n}).values;
      table.columns.push_back({name, values.unit(name)});
      for (std::size_t i = 0; i < n; ++i) table.rows[i].push_back(column[i]);
      const bool whole =
          std::all_of(column.begin(), column.end(), [](double v) { return std::isfinite(v); });
      if (along && whole) {
        columns.push_back({name, along->numbers, column, false});
        units.push_back(values.unit(name));
      }
    }
    page.tables.push_back(std::move(table));
    add_spread(page, source, file.root());
    if (angle && n > 2)
      add_polars(page, *angle, columns, units);
    else if (along && axes[0].name != "sample" &&
             !file.root().has("spread"))  // samples of a design have no order
      for (std::size_t c = 0; c < columns.size(); ++c)
        page.charts.push_back({"sweep",
                               in_words(columns[c].name),
                               along->name,
                               along->unit,
                               in_words(columns[c].name),
                               units[c],
                               {columns[c]},
                               false});
    for (const Polar& polar : page.polars)
      for (const SymmetryResidual& r : polar.residuals)
        if (r.value > 0.02)
          page.verdicts.push_back(
              {Level::warning, source.label,
               fmt::format(
                   "{} fails by {:.2g} % of the largest value: the mesh, or the scene, lacks that symmetry",
                   r.says, 100 * r.value)});
  }
}

}  // namespace langer::report

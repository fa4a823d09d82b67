// langer-gather: one table over the members of a sweep.
//   langer-gather table.yaml --curves a/curves.h5 --curves b/curves.h5 -o sweep.h5
//
// The table has one row per file; it is also written as table.csv. Figures and maps show all
// members together. If the members are a design of experiments or samples of fitted parameters,
// effects or spreads are computed.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/base/text.hpp"
#include "core/hdf5/seal.hpp"
#include "identification/inverse/parameter_sample.hpp"
#include "pipeline/sweep/design_tables.hpp"
#include "pipeline/sweep/gather.hpp"
#include "pipeline/sweep/gather_config.hpp"
#include "pipeline/sweep/sweep_file.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/plot/pictures.hpp"
#include "results/store/material_file.hpp"
#include "stage.hpp"

namespace langer {
namespace {

using Members = std::vector<SweepMember>;

// The map of this name of every member; refuses a member without it.
std::vector<const SurfaceMap*> maps_of(const Job<GatherConfig>& job, const Sweep& sweep,
                                       const Members& members, const std::string& name) {
  std::vector<const SurfaceMap*> found;
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::vector<std::string> known;
    for (const SurfaceMap& map : members[i].curves.maps) {
      known.push_back(map.name);
      if (map.name == name) found.push_back(&map);
    }
    if (found.size() == i + 1) continue;
    const std::string key = "maps." + name;
    std::string expected = "a file with maps: post has the key `maps`";
    if (!known.empty()) expected = "one of " + list_words(known);
    throw Failure(Exit::config,
                  Error{job.where(key), key, fmt::format("{} has no such map", sweep.members[i]),
                        expected, did_you_mean(nearest(name, known))});
  }
  return found;
}

// The columns of a member that figures may draw: the columns and maps of curves.h5, or strain,
// measured stress, model and error of a fit. Other files have none.
Curves curves_in(const std::string& file) {
  const std::string schema = read_origin(file).schema;
  if (schema == curves_schema.name) return read_curves(file).curves;
  Curves curves;
  if (schema != material_schema.name) return curves;
  const std::optional<FitRecord> fit = read_material(file).fit;
  if (!fit) return curves;
  double largest = 0;
  for (double s : fit->stress) largest = std::max(largest, std::abs(s));
  std::vector<double> error;
  for (std::size_t i = 0; i < fit->model.size(); ++i)
    error.push_back(100 * (fit->model[i] - fit->stress[i]) / largest);
  curves.columns = {{"strain", "-", fit->strain},
                    {"measured", "MPa", fit->stress},
                    {"model", "MPa", fit->model},
                    {"error", "percent", error}};
  return curves;
}

// The largest difference of each member's map from that of one member, in percent.
SweepColumn differences(const Job<GatherConfig>& job, const Members& members,
                        const std::string& name, const std::vector<const SurfaceMap*>& maps) {
  const MapComparison& compare = *job.config.maps.at(name).compare;
  const auto other = std::ranges::find(members, compare.with, &SweepMember::at);
  if (other == members.end()) {
    const std::string key = fmt::format("maps.{}.compare.with", name);
    std::vector<std::string> known;
    for (const SweepMember& m : members)
      known.push_back(fmt::format("[{}]", fmt::join(m.at, ", ")));
    throw Failure(
        Exit::config,
        Error{job.where(key), key, fmt::format("no member is [{}]", fmt::join(compare.with, ", ")),
              fmt::format("one of {}", fmt::join(known, ", ")), ""});
  }
  const SurfaceMap& reference = *maps[static_cast<std::size_t>(other - members.begin())];
  SweepColumn column{name + "_difference", "percent", {}};
  for (const SurfaceMap* map : maps)
    column.values.push_back(100 * difference(*map, reference, compare.beyond));
  return column;
}

// Prints the effects of a design on one quantity, and draws them if the design asks for figures.
void show_effects(const Job<GatherConfig>& job, const Design& design,
                  const QuantityEffects& effects, Pictures& pictures) {
  constexpr std::string_view warning = "warning: ";
  for (const std::string& line : effects_lines(design, effects)) {
    if (line.starts_with(warning))
      job.warn("{}", line.substr(warning.size()));
    else
      job.say("{}", line);
  }
  if (!design.figures) return;
  if (design.one_at_a_time || design.morris)
    pictures.draw("effects_" + effects.name, bars(effects_bars(design, effects), pictures.look()));
  if (design.sobol)
    pictures.draw("shares_" + effects.name, bars(share_bars(design, effects), pictures.look()));
}

// The effects of a design on each column. The values of the design's points become the first
// columns of the table.
std::vector<QuantityEffects> effects_over(const Job<GatherConfig>& job, const Design& design,
                                          Sweep& sweep, Pictures& pictures) {
  const std::vector<VecX> points = design_points(design);
  if (sweep.members.size() != points.size())
    throw Failure(Exit::config, Error{job.where("axes[0].design"), "axes[0].design",
                                      fmt::format("{} members for {} points", sweep.members.size(),
                                                  points.size()),
                                      "one member for each point, in their order", ""});
  std::vector<QuantityEffects> effects;
  for (const SweepColumn& c : sweep.columns) {
    effects.push_back(effects_of(design, c.name, c.unit, c.values));
    show_effects(job, design, effects.back(), pictures);
  }
  for (std::size_t j = design.parameters.size(); j-- > 0;) {
    SweepColumn column{short_name(design.parameters[j]), design.parameters[j].unit, {}};
    for (const VecX& p : points) column.values.push_back(p[static_cast<Eigen::Index>(j)]);
    sweep.columns.insert(sweep.columns.begin(), std::move(column));
  }
  write_text_file(job.side_file("effects.csv"), effects_csv(design, effects));
  return effects;
}

// The spread of each column over samples of fitted parameters. The parameters of each sample become
// the first columns of the table.
std::vector<Spread> spreads_over(const Job<GatherConfig>& job,
                                 const std::vector<GatherInput>& members, Sweep& sweep) {
  const auto refuse = [&](std::string found) {
    throw Failure(Exit::config,
                  Error{job.where("axes[0].samples"), "axes[0].samples", std::move(found),
                        "--material with the fit that the samples were drawn from", ""});
  };
  if (!job.has("material")) refuse("samples without the fit");
  const MaterialFile fitted = read_material(job.input("material"));
  std::vector<std::vector<Summary>> sets;
  for (const GatherInput& member : members) {
    const int number = std::atoi(member.at.at(0).c_str());
    std::string reason = "no sample of this number";
    if (number >= 1) reason = reason_without_samples(fitted, number);
    if (!reason.empty())
      refuse(fmt::format("{}: {} has {}", member.at[0], job.input("material"), reason));
    sets.push_back(sample_of(fitted, number).values);
  }
  const std::vector<SweepColumn> parameters = sampled_parameters(sets);
  std::vector<Spread> spreads;
  for (const SweepColumn& c : sweep.columns)
    if (!c.name.starts_with("parameter_")) spreads.push_back(spread_of(c, parameters));
  for (const Spread& one : spreads) job.say("{}", in_words(one));
  for (std::size_t j = parameters.size(); j-- > 0;) {
    const auto same = std::ranges::find(sweep.columns, parameters[j].name, &SweepColumn::name);
    if (same == sweep.columns.end()) sweep.columns.insert(sweep.columns.begin(), parameters[j]);
  }
  write_text_file(job.side_file("spread.csv"), spread_csv(spreads));
  return spreads;
}

// The table of `rows: parameters`: one row for each fitted parameter of one fit.
std::vector<Summary> gather_parameters(const Job<GatherConfig>& job) {
  const std::vector<std::string>& files = job.inputs.at("curves");
  const auto refuse = [&](const std::string& found) {
    throw Failure(Exit::config, Error{job.where("rows"), "rows", "parameters, of " + found,
                                      "material.h5 of one fit", ""});
  };
  if (files.size() != 1) refuse(fmt::format("{} files", files.size()));
  if (read_origin(files[0]).schema != material_schema.name) refuse(files[0]);
  const std::optional<FitRecord> fit = read_material(files[0]).fit;
  if (!fit) refuse("a material that was not fitted");
  Sweep sweep;
  sweep.axes = {{"parameter", "-", {}}};
  sweep.columns = {{"true", "-", {}},
                   {"found", "-", {}},
                   {"standard_error", "-", {}},
                   {"lower_95", "-", {}},
                   {"upper_95", "-", {}}};
  for (const FittedParameter& p : fit->parameters) {
    const std::array<double, 2> interval = interval_95(p);
    const double row[] = {p.truth, p.value, p.standard_error, interval[0], interval[1]};
    sweep.members.push_back(p.name);
    sweep.axes[0].values.push_back(p.name);
    for (std::size_t k = 0; k < 5; ++k) sweep.columns[k].values.push_back(row[k]);
  }
  write_sweep(job.output, job.side_file("table.csv"), sweep, nullptr, {}, job.identity);
  job.say("{} parameters", sweep.members.size());
  return {};
}

// Reads the summary of each file, with the name and the axis values that the config gives it. If
// anything is drawn, the curves of each file are kept, too.
std::vector<GatherInput> read_members(const Job<GatherConfig>& job, Members& members) {
  const std::vector<std::string>& files = job.inputs.at("curves");
  const GatherConfig& config = job.config;
  if (!config.members.empty() && config.members.size() != files.size())
    throw Failure(Exit::config,
                  Error{job.where("members"), "members",
                        fmt::format("found {} members", config.members.size()),
                        fmt::format("one for each of the {} files given", files.size()), ""});
  std::vector<GatherInput> inputs;
  const bool drawn =
      !config.figures.empty() || !config.maps.empty() || config.rows == GatherRows::steps;
  for (std::size_t i = 0; i < files.size(); ++i) {
    GatherInput member{files[i], {}, read_summary(files[i])};
    if (member.summary.empty())
      throw Failure(Exit::input,
                    Error{{files[i], 0, 0},
                          "/summary",
                          "nothing to gather",
                          "a file with a summary",
                          "curves.h5, material.h5, mesh.h5 and sensitivity.h5 have one"});
    if (!config.members.empty()) {
      member.path = config.members[i].path;
      member.at = config.members[i].at;
    }
    if (drawn) members.push_back({member.at, member.summary, curves_in(files[i])});
    inputs.push_back(std::move(member));
  }
  return inputs;
}

// The table of `rows: steps`: one row for each row of the curves of each member.
Sweep steps_of(const Job<GatherConfig>& job, const std::vector<SweepAxis>& axes,
               const std::vector<GatherInput>& inputs, const Members& members) {
  std::vector<std::string> wanted = job.config.columns;
  if (wanted.empty())
    for (const Column& c : members.front().curves.columns) wanted.push_back(c.name);
  Sweep sweep;
  sweep.axes = axes;
  for (SweepAxis& axis : sweep.axes) axis.values.clear();
  for (const std::string& name : wanted) sweep.columns.push_back({name, "", {}});
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::vector<Column>& columns = members[i].curves.columns;
    std::vector<std::string> known;
    for (const Column& c : columns) known.push_back(c.name);
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const auto found = std::ranges::find(columns, wanted[k], &Column::name);
      if (found == columns.end())
        throw Failure(
            Exit::config,
            Error{job.where("columns"), "columns",
                  fmt::format("{} has no column \"{}\"", inputs[i].path, wanted[k]),
                  "one of " + list_words(known), did_you_mean(nearest(wanted[k], known))});
      SweepColumn& column = sweep.columns[k];
      column.unit = found->unit;
      column.values.insert(column.values.end(), found->values.begin(), found->values.end());
    }
    for (std::size_t row = 0; row < columns.front().values.size(); ++row) {
      sweep.members.push_back(inputs[i].path);
      for (std::size_t a = 0; a < axes.size(); ++a)
        sweep.axes[a].values.push_back(inputs[i].at.at(a));
    }
  }
  return sweep;
}

// Effects, spreads and differences of maps add columns to the table, so the file is written last.
std::vector<Summary> gather_sweep(const Job<GatherConfig>& job) {
  const GatherConfig& config = job.config;
  if (config.rows == GatherRows::parameters) return gather_parameters(job);
  Members members;
  const std::vector<GatherInput> inputs = read_members(job, members);
  std::vector<SweepAxis> axes;
  for (const GatherAxis& a : config.axes)
    axes.push_back({a.name, a.unit, {}, a.samples.has_value()});
  const bool by_steps = config.rows == GatherRows::steps;
  const std::vector<std::string> of_members =
      by_steps ? std::vector<std::string>{} : config.columns;
  Sweep sweep = gather(of_members, axes, inputs, job.where("columns"));

  // Analyses of the members: effects of a design, or the spread over samples.
  Pictures pictures(job.side_file(""), config.figure_style);
  std::vector<QuantityEffects> effects;
  const Design* design = nullptr;
  if (!config.axes.empty() && config.axes[0].design) design = &*config.axes[0].design;
  if (design) effects = effects_over(job, *design, sweep, pictures);
  std::vector<Spread> spreads;
  std::vector<Band> bands;
  if (axes.size() == 1 && axes[0].samples) spreads = spreads_over(job, inputs, sweep);
  // Maps of all members side by side, with one colour scale.
  for (const auto& [name, map] : config.maps) {
    const auto maps = maps_of(job, sweep, members, name);
    if (map.compare) sweep.columns.push_back(differences(job, members, name, maps));
    std::vector<MapPanel> panels;
    for (std::size_t i = 0; i < maps.size(); ++i)
      panels.push_back({member_text(map.member, axes, members[i].at), maps[i]});
    pictures.draw(name, map_drawing(panels, map.style, map.columns, pictures.look()));
  }
  // Figures over an axis, or of the members' curves.
  for (const auto& [name, figure] : config.figures) {
    const auto where = [&, at = "figures." + name + "."](const std::string& key) {
      return job.where(at + key);
    };
    const FigureData data = figure_over(figure, name, axes, members, where);
    write_text_file(job.side_file(name + ".csv"), data.csv);
    pictures.draw(name, data.plot);
    bands.insert(bands.end(), data.bands.begin(), data.bands.end());
  }
  for (const auto& [reason, names] : pictures.failed())
    job.say("not drawn: {} ({})", names, reason);
  if (by_steps) sweep = steps_of(job, axes, inputs, members);
  write_sweep(job.output, job.side_file("table.csv"), sweep, design, effects, job.identity, spreads,
              bands);
  job.say("{} rows, {} columns, {} figures", sweep.members.size(),
          sweep.axes.size() + sweep.columns.size(), config.figures.size() + config.maps.size());
  return {};
}

// The names of the files that the config asks for, in addition to sweep.h5.
std::vector<std::string> side_files(const GatherConfig& config) {
  std::vector<std::string> names{"table.csv"};
  for (const auto& [name, figure] : config.figures) {
    names.push_back(name + ".csv");
    names.push_back(name + ".gp");
  }
  for (const auto& [name, map] : config.maps) names.push_back(name + ".gp");
  return names;
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::GatherConfig>(argc, argv, "gather", langer::gather_sweep,
                                                 langer::side_files);
}

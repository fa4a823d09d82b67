// langer-post: curves, snapshots and figures of a solution. Nothing is solved here: all quantities
// are evaluated from the displacements of each step, and from the columns that langer-solve
// recorded.
//   langer-post indentation.yaml --solution solution.h5 -o curves.h5
//   langer-post --solution solution.h5 --export scene.inp --export scene.feb
#include <cmath>
#include <functional>
#include <set>

#include "arguments.hpp"
#include "core/base/counted.hpp"
#include "core/base/output_file.hpp"
#include "core/hdf5/seal.hpp"
#include "export/write_decks.hpp"
#include "mechanics/material/ellipticity.hpp"
#include "mechanics/mesh/bounding_box.hpp"
#include "pipeline/plan/effective.hpp"
#include "results/plot/pictures.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/snapshot.hpp"
#include "results/store/solution_file.hpp"
#include "results/store/solution_layout.hpp"
#include "results/store/vtu.hpp"
#include "scene/run/post_config.hpp"
#include "scene/run/post_files.hpp"
#include "scene/run/recorded_contact.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// A solution file with its body. Row 0 of every table is the unloaded state, row i the i-th step.
struct Solution {
  explicit Solution(const std::string& path)
      : reader(path),
        body(reader.header().mesh, reader.header().laws(), reader.header().directions,
             formulation_of(reader.header(), path)),
        branches_(body, reader) {}
  SolutionReader reader;
  mutable Body body;  // with the branch stresses of the row that was read last

  // The record of a row; the unloaded state is not in the file, so it is made here.
  StepRecord record(int row) const {
    branches_.go_to(row);
    if (row > 0) return reader.step(row - 1);
    StepRecord undeformed;
    undeformed.u.assign(body.mesh().X.size(), Vec3::Zero());
    undeformed.reaction = undeformed.u;
    undeformed.scalars["shear_stiffness_min"] = stiffness_at_rest();
    if (reader.n_steps() > 0) {
      // A body in motion has a velocity at the beginning, so not all of its values are 0 there.
      const std::string suffix = solution::at_start_suffix;
      for (const auto& [name, value] : reader.step(0).scalars) {
        if (!name.ends_with(suffix)) continue;
        undeformed.scalars[name.substr(0, name.size() - suffix.size())] = value;
      }
    }
    return undeformed;
  }

 private:
  // The minimum acoustic eigenvalue of the undeformed state. The direction of the fibres does not
  // matter in that state, so one element of each body is enough.
  double stiffness_at_rest() const {
    double stiffness = std::numeric_limits<double>::infinity();
    std::set<int> bodies;
    for (int e = 0; e < body.mesh().n_cells(); ++e) {
      int number = 0;
      if (!body.mesh().body.empty()) number = body.mesh().body[e];
      if (!bodies.insert(number).second) continue;
      stiffness = std::min(
          stiffness,
          smallest_shear_stiffness(body.material(e), Mat3::Identity(), body.fibres(e)).value);
    }
    return stiffness;
  }

  mutable BranchRows branches_;
};

using Columns = std::vector<Column>;

// Errors of the config that were found with the solution at hand, all at once.
[[noreturn]] void refuse(const Job<PostConfig>& job, const std::vector<Complaint>& complaints) {
  std::vector<Error> errors;
  for (const Complaint& c : complaints)
    errors.push_back({job.where(c.key), c.key, c.found, c.expected, c.hint});
  throw Failure(Exit::config, std::move(errors));
}

// The table of states: one row per state, the first is the unloaded one.
struct Table {
  std::vector<double> t, u_ind, seconds;
  Columns columns;

  // The row closest to a wanted state, such as "t=0.5"; refuses a state beyond the path.
  int row(const Job<PostConfig>& job, const std::string& key, const std::string& step) const {
    const int row = row_of(*parse_step(step), t, u_ind);
    if (row >= 0) return row;
    const double furthest = *std::max_element(u_ind.begin(), u_ind.end());
    refuse(job, {{key, step,
                  fmt::format("a row from 0 to {}, or t=0 to t={}, or u_ind=0 to u_ind={}",
                              t.size() - 1, t.back(), furthest),
                  ""}});
  }

  // As row(), but refuses a state between two rows.
  int exact_row(const Job<PostConfig>& job, const std::string& key, const std::string& step) const {
    const int found = row(job, key, step);
    if (!is_exact(*parse_step(step), found, t, u_ind))
      refuse(
          job,
          {{key, step, "a state of the solution",
            fmt::format(
                "the closest are t={}, u_ind={} and t={}, u_ind={}; with a waypoint in the motion "
                "the path has a step exactly there",
                t[found - 1], u_ind[found - 1], t[found], u_ind[found])}});
    return found;
  }
};

// Whether any measure has a quantity with a property.
bool any_quantity(const std::vector<Measure>& measures, bool (*property)(const QuantityLine&)) {
  for (const Measure& m : measures)
    if (m.quantity && property(line_of(*m.quantity))) return true;
  return false;
}

// Properties of quantities that cost extra work.
bool is_contact_area(const QuantityLine& line) { return is_contact_surface_column(line.word); }
bool is_applied_pressure(const QuantityLine& line) {
  return std::string_view(line.word) == "applied_pressure";
}
bool is_contact_value(const QuantityLine& line) { return is<OfContact>(line); }
bool needs_shapes(const QuantityLine& line) { return line.needs.shapes; }
bool needs_slip(const QuantityLine& line) { return is<OfContact>(line) && line.needs.shapes; }

// Where the limit of the meshes is the answer to an accuracy, a column shows that limit, and the
// next one, <name>_of_mesh, what was computed on the mesh. The latter was read from the history
// with the share of one in the other.
void put_limits_first(const std::vector<Measure>& measures, Columns& columns) {
  for (std::size_t c = 0; c < measures.size(); ++c) {
    if (!measures[c].history.ends_with("_limit_share")) continue;
    const auto shown = std::ranges::find_if(
        columns, [&](const Column& column) { return of_mesh(column.name) == columns[c].name; });
    if (shown == columns.end()) continue;
    for (std::size_t row = 0; row < shown->values.size(); ++row)
      columns[c].values[row] *= shown->values[row];
    std::swap(shown->values, columns[c].values);
    columns[c].unit = shown->unit;
  }
}

// Evaluates all measures in all states. Sums along the path (energies) are computed first; contact
// areas, contact values and slip only if a measure needs them.
Table table_of(const Job<PostConfig>& job, const Solution& solution,
               const std::vector<RigidContact>& indenters, std::vector<SurfaceContact> surfaces,
               const ContactStates& contacts, const std::vector<Measure>& measures) {
  const int n_steps = solution.reader.n_steps();
  const SolutionHeader& header = solution.reader.header();
  const Loads loads = loads_of(header);
  if (!any_quantity(measures, needs_shapes)) surfaces.clear();
  EnergyPath path = energy_path(solution.body.mesh(), indenters, header, surfaces);
  for (int row = 0; row <= n_steps; ++row)
    path.add(energy_state(solution.record(row), indenters, loads, surfaces));
  const std::vector<PathSums> sums = path.sums();
  const bool areas = any_quantity(measures, is_contact_area);
  const bool touched = any_quantity(measures, is_contact_value);
  const bool slips = any_quantity(measures, needs_slip);
  std::function<double(double)> pressure;
  if (any_quantity(measures, is_applied_pressure))
    pressure = applied_pressure(solution.reader.header());
  Table table;
  for (const Measure& m : measures) table.columns.push_back({m.name, m.unit, {}});
  for (int row = 0; row <= n_steps; ++row) {
    const StepRecord record = solution.record(row);
    StepState state = state_of(record);
    if (areas) add_contact_numbers(state.histories, contacts.surfaces(), record);
    if (pressure) state.histories["applied_pressure"] = pressure(state.t);
    if (touched) state.contact = contacts.nodes(row, record, slips);
    state.sums = sums[row];
    GaussValues gauss;
    const std::vector<double> values =
        measured(solution.body, measures, job.config.stress, state, gauss);
    for (std::size_t c = 0; c < values.size(); ++c) table.columns[c].values.push_back(values[c]);
    table.t.push_back(state.t);
    table.u_ind.push_back(state.u_ind.norm());
    if (const auto time = state.histories.find("time"); time != state.histories.end())
      table.seconds.push_back(time->second);
    else if (row == 0)
      table.seconds.push_back(0);
  }
  put_limits_first(measures, table.columns);
  for (std::size_t c = 0; c < measures.size(); ++c) {
    if (!measures[c].zero_at) continue;
    std::vector<double>& values = table.columns[c].values;
    const double zero = values[static_cast<std::size_t>(
        table.exact_row(job, measures[c].key + ".zero_at", *measures[c].zero_at))];
    for (double& value : values) value -= zero;
  }
  return table;
}

const Column& column_named(const Table& table, const std::string& name) {
  return *std::ranges::find(table.columns, name, &Column::name);
}

// The unit of a slope: of force over displacement it is N/mm.
std::string quotient_unit(const std::string& numerator, const std::string& denominator) {
  if (numerator == denominator) return "-";
  if (denominator == "-") return numerator;
  return numerator + "/" + denominator;
}

// Storage, loss and loss tangent of the last cycle of one column over another (viscoelasticity).
void add_cycles(const Job<PostConfig>& job, const Table& table, std::vector<Summary>& summary) {
  for (const auto& [name, choice] : job.config.cycles) {
    double lasts = 0;
    if (table.seconds.size() == table.t.size()) lasts = table.seconds.back();
    if (!(lasts >= choice.period * (1 - 1e-9)))
      refuse(job, {{"cycles." + name + ".period",
                    fmt::format("{:g} s, and the solution lasts {:g} s", choice.period, lasts),
                    "a cycle that is complete in the solution, in seconds",
                    "path.seconds of the solve is the duration of the path"}});
    const Column& of = column_named(table, choice.of);
    const Column& over = column_named(table, choice.over);
    const Cycle cycle = last_cycle(table.seconds, over.values, of.values, choice.period);
    const std::string unit = quotient_unit(of.unit, over.unit);
    summary.push_back({"storage_" + name, cycle.storage, unit});
    summary.push_back({"loss_" + name, cycle.loss, unit});
    summary.push_back({"tan_delta_" + name, cycle.tan_delta(), "-"});
    if (cycle.change > 0.01)
      job.say(
          "warning: cycle \"{}\" differs from the one before by {:.2g} %: storage and loss are not "
          "yet those of many cycles",
          name, 100 * cycle.change);
  }
}

// The unit of an area under a curve: of force over displacement it is N mm.
std::string product_unit(const std::string& a, const std::string& b) {
  if (b == "-") return a;
  if (a == "-") return b;
  return a + " " + b;
}

// R0 to R9 of a suction and release. Heights between two states of the path are not guessed: the
// user is told where the path has to stop.
void add_suction(const Job<PostConfig>& job, const Table& table, const std::string& name,
                 const ReadingChoice& choice, std::vector<Summary>& summary) {
  const std::string key = "readings." + name;
  const Column& height = column_named(table, *choice.suction_of);
  const double lasts = table.seconds.size() == table.t.size() ? table.seconds.back() : 0;
  const double period = *choice.suction + *choice.release;
  if (!(lasts >= (choice.begins + period) * (1 - 1e-9)))
    refuse(job, {{key + ".suction",
                  fmt::format("a cycle of {:g} s from {:g} s on, and the solution lasts {:g} s",
                              period, choice.begins, lasts),
                  "a cycle that is complete in the solution, in seconds",
                  "path.seconds of the solve is the duration of the path"}});
  std::optional<MissingTime> missing;
  const SuctionCycles found = suction_cycles(table.seconds, height.values, choice, missing);
  if (missing)
    refuse(job, {{key, fmt::format("no state at {:g} s", missing->seconds), "a state at each time",
                  fmt::format("a waypoint of the pressure at t = {:.6g} makes the path stop there",
                              missing->seconds / lasts)}});
  const auto add = [&](const char* what, double value, const std::string& unit) {
    summary.push_back({name + "_" + what, value, unit});
  };
  const std::string mm = height.unit;
  add("Ue", found.ue, mm);
  add("Uv", found.uv(), mm);
  add("Uf", found.uf, mm);
  add("Ur", found.ur, mm);
  add("Ua", found.ua, mm);
  add("R0", found.uf, mm);
  add("R1", found.uf - found.ua, mm);
  add("R2", found.ua / found.uf, "-");
  add("R3", found.last_maximum, mm);
  add("R4", found.last_minimum, mm);
  add("R5", found.ur / found.ue, "-");
  add("R6", found.uv() / found.ue, "-");
  add("R7", found.ur / found.uf, "-");
  add("R8", found.ua, mm);
  add("R9", found.last_maximum - found.uf, mm);
}

// What devices report (results/post/reading.hpp). A number that the path does not reach is refused:
// the largest one says how far it goes.
void add_readings(const Job<PostConfig>& job, const Table& table, std::vector<Summary>& summary) {
  for (const auto& [name, choice] : job.config.readings) {
    if (choice.suction_of) {
      add_suction(job, table, name, choice, summary);
      continue;
    }
    const Column& over = column_named(table, *choice.over);
    if (choice.hysteresis_of) {
      const Column& of = column_named(table, *choice.hysteresis_of);
      const Loop loop = last_loop(over.values, of.values);
      if (std::isnan(loop.loading))
        refuse(job, {{"readings." + name, fmt::format("{} never goes back", over.name),
                      "a path with a loading and an unloading", ""}});
      summary.push_back({name + "_loss", loop.loss(), product_unit(of.unit, over.unit)});
      summary.push_back({name + "_ratio", loop.ratio(), "-"});
      continue;
    }
    const bool is_slope = choice.slope_of.has_value();
    const Column& of = column_named(table, is_slope ? *choice.slope_of : *choice.value_of);
    double found = value_where(over.values, of.values, *choice.at);
    std::string unit = of.unit;
    if (is_slope) {
      found = slope_where(over.values, of.values, *choice.at);
      unit = quotient_unit(of.unit, over.unit);
    }
    if (std::isnan(found)) {
      const auto [low, high] = std::ranges::minmax(over.values);
      refuse(job,
             {{"readings." + name + ".at",
               fmt::format("{:g} {}, which {} never reaches", *choice.at, over.unit, over.name),
               fmt::format("a number from {:.4g} to {:.4g}", low, high), ""}});
    }
    summary.push_back({name, found, unit});
  }
}

// The last row of the table, the rows of `summary_at`, cycles, and the range of each map.
std::vector<Summary> summary_of(const Job<PostConfig>& job, const Table& table,
                                const std::vector<SurfaceMap>& maps) {
  std::vector<Summary> summary;
  for (const Column& c : table.columns) summary.push_back({c.name, c.values.back(), c.unit});
  for (const auto& [name, step] : job.config.summary_at) {
    const int row = table.exact_row(job, "summary_at." + name, step);
    for (const Column& c : table.columns)
      summary.push_back({c.name + "_" + name, c.values[row], c.unit});
  }
  add_cycles(job, table, summary);
  add_readings(job, table, summary);
  for (const SurfaceMap& map : maps) {
    const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
    summary.push_back({map.name + "_min", *low, map.unit});
    summary.push_back({map.name + "_max", *high, map.unit});
  }
  return summary;
}

// Name of a rendered picture -> its key in the config, and its settings.
using Renders = std::map<std::string, std::pair<std::string, RenderChoice>>;

Renders renders_of(const PostConfig& config) {
  Renders renders;
  if (config.render) renders["render"] = {"render", *config.render};
  for (const auto& [name, choice] : config.renders) renders[name] = {"renders." + name, choice};
  return renders;
}

// Errors of the config that depend on the solution: fields that it lacks, fibre families, points.
std::vector<Complaint> complaints_of(const PostConfig& config, const Renders& renders,
                                     const Body& body, const Available& available) {
  std::vector<Complaint> complaints;
  const auto needs_contact = [&](const std::string& key, const std::optional<Quantity>& field) {
    if (!field || !is<OfContact>(line_of(*field))) return;
    const QuantityLine& line = line_of(*field);
    if (!available.contact)
      complaints.push_back({key + ".field",
                            fmt::format("{} of a solution without contact", line.word),
                            "a field that needs no indenter", ""});
    else if (line.needs.shapes && !available.energy)
      complaints.push_back({key + ".field",
                            fmt::format("{} needs the shapes of the indenters", line.word),
                            "a solution whose config this version can read", ""});
  };
  for (const auto& [name, map] : config.maps) needs_contact("maps." + name, map.field);
  for (const auto& [name, keyed] : renders) needs_contact(keyed.first, keyed.second.field);
  for (const auto& [name, map] : config.maps)
    for (const Complaint& c : langer::complaints(map, body))
      complaints.push_back({"maps." + name + "." + c.key, c.found, c.expected, c.hint});
  const auto& sets = body.mesh().node_sets;
  for (const auto& [name, keyed] : renders) {
    const auto& [key, choice] = keyed;
    if (choice.field && line_of(*choice.field).needs.fibres && choice.family > body.n_families())
      complaints.push_back(
          {key + ".family", "a fibre family that the material lacks", "another field", ""});
    for (std::size_t i = 0; i < choice.points.size(); ++i) {
      const auto set = sets.find(choice.points[i]);
      if (set != sets.end() && set->second.size() == 1) continue;
      complaints.push_back({fmt::format("{}.points[{}]", key, i), choice.points[i],
                            "an observation point of the mesh", ""});
    }
  }
  return complaints;
}

// The state of a row, with the contact values of the nodes if the picture shows one.
StepState pictured_state(const Solution& solution, const ContactStates& contacts, int row,
                         const std::optional<Quantity>& field) {
  const StepRecord record = solution.record(row);
  StepState state = state_of(record);
  if (field && is<OfContact>(line_of(*field)))
    state.contact = contacts.nodes(row, record, line_of(*field).needs.shapes);
  return state;
}

StepState moved_along(const Solution& solution, const std::vector<Vec3>& shape, double amplitude,
                      StepState state) {
  const double size = bounding_box(solution.body.mesh().X).size().norm();
  for (std::size_t i = 0; i < state.u.size(); ++i) state.u[i] += amplitude * size * shape[i];
  return state;
}

// The state before the first critical point, or the one that is asked for, with the mode of this
// point at its largest movement.
StepState with_critical_mode(const Job<PostConfig>& job, const Solution& solution,
                             const std::string& key, const RenderChoice& choice, StepState state) {
  const VibrationRecord record = solution.reader.vibration();
  if (!record.critical)
    refuse(job, {{key + ".critical", "the path has no critical point with a mode",
                  "a limit point or a bifurcation",
                  "`langer-solve` names it as it ends, where stability is checked"}});
  if (choice.step == RenderChoice{}.step)
    state = state_of(solution.record(steps_until(solution.reader, record.critical->t)));
  return moved_along(solution, record.critical->shape, choice.amplitude, std::move(state));
}

// The state with a natural vibration at its largest movement added to it.
StepState with_mode(const Job<PostConfig>& job, const Solution& solution, const std::string& key,
                    const RenderChoice& choice, StepState state) {
  if (choice.critical) return with_critical_mode(job, solution, key, choice, std::move(state));
  if (!choice.mode) return state;
  const VibrationRecord vibration = solution.reader.vibration();
  const std::size_t mode = static_cast<std::size_t>(*choice.mode);
  std::size_t known = 0;
  if (vibration.modes) known = vibration.modes->shape.size();
  if (mode > known)
    refuse(job,
           {{key + ".mode", fmt::format("found {}, and the solution has {} modes", mode, known),
             "a mode of the solution", "the key `modes` of the solve config computes them"}});
  return moved_along(solution, vibration.modes->shape[mode - 1], choice.amplitude,
                     std::move(state));
}

// The content of curves.h5: the shown columns, a curve of each column over the first one, maps of
// the surface, and the summary.
Curves curves_of(const Job<PostConfig>& job, const Solution& solution,
                 const ContactStates& contacts, const Table& table, std::size_t n_shown) {
  Curves curves;
  curves.columns.assign(table.columns.begin(),
                        table.columns.begin() + static_cast<std::ptrdiff_t>(n_shown));
  const Column& x = table.columns.front();
  for (std::size_t c = 1; c < table.columns.size(); ++c) {
    const Column& y = table.columns[c];
    curves.curves.push_back({y.name, x.name, x.unit, y.name, y.unit, x.values, y.values});
  }
  for (const auto& [name, map] : job.config.maps) {
    const StepState state = pictured_state(
        solution, contacts, table.row(job, "maps." + name + ".step", map.step), map.field);
    const auto values =
        picture_values(solution.body, state, map.field, map.family, job.config.stress);
    curves.maps.push_back(surface_map(solution.body, map, name, values, state.t));
  }
  curves.summary = summary_of(job, table, curves.maps);
  return curves;
}

// A picture of the deformed body with its indenters.
Drawing drawing_of(const Solution& solution, const std::vector<RigidContact>& indenters,
                   const StepState& state, const RenderChoice& choice, StressAt stress,
                   const Look& look) {
  const SolutionHeader& header = solution.reader.header();
  RenderScene scene{header.mesh, header.mesh.X, {}, "", {}};
  for (const RigidContact& indenter : indenters)
    scene.indenters.push_back(outline_at(indenter, state.t, shown_of(header.mesh)));
  for (std::size_t i = 0; i < scene.x.size(); ++i) scene.x[i] += state.u[i];
  for (const std::string& point : choice.points)
    scene.points.push_back(
        {point, scene.x[static_cast<std::size_t>(header.mesh.node_sets.at(point)[0])]});
  if (choice.actions) scene.actions = actions_of(header, state.u);
  if (choice.field) {
    const QuantityLine& field = line_of(*choice.field);
    scene.values = picture_values(solution.body, state, *choice.field, choice.family, stress);
    scene.label = with_unit(field.label, field.unit);
  }
  return render(scene, choice, look);
}

void write_snapshot_of(const Job<PostConfig>& job, const Solution& solution,
                       const ContactStates& contacts, int row, double t) {
  const SolutionHeader& header = solution.reader.header();
  const SnapshotFields fields = snapshot_fields(solution.body, header, solution.record(row), row,
                                                contacts, job.config.stress);
  write_snapshot(job.side_file(fmt::format("snapshot_{:04}.hdf", row)), header.mesh, fields.points,
                 fields.cells, job.identity, t);
}

// Writes all states as series/step_*.vtu, and series.pvd for ParaView. All states must have the
// same fields; the gap of the undeformed state is not recorded, so it is NaN there.
void write_series(const Job<PostConfig>& job, const Solution& solution,
                  const ContactStates& contacts) {
  const SolutionHeader& header = solution.reader.header();
  make_folder_below(job.side_file(""), job.side_file("series"));
  std::vector<std::pair<double, std::string>> files;
  for (int row = 0; row <= solution.reader.n_steps(); ++row) {
    StepRecord record = solution.record(row);
    if (row == 0) {
      for (const auto& [name, nodes] : header.contact_nodes)
        record.contacts[name] = {
            std::vector<Vec3>(nodes.size(), Vec3::Zero()), std::vector<int>(nodes.size(), 0),
            std::vector<double>(nodes.size(), std::numeric_limits<double>::quiet_NaN())};
    }
    const SnapshotFields fields =
        snapshot_fields(solution.body, header, record, row, contacts, job.config.stress);
    files.push_back({record.t, fmt::format("series/step_{:04}.vtu", row)});
    write_vtu(job.side_file(files.back().second), header.mesh, record.t, fields.points,
              fields.cells);
  }
  write_pvd(job.side_file("series.pvd"), files);
}

// Adds measured points to a figure, and writes them next to it.
void add_points(const Job<PostConfig>& job, const std::string& name, const FigurePoints& points,
                Plot& plot) {
  const auto where = [&](const std::string& key) {
    return job.where("figures." + name + "." + key);
  };
  const PointColumns read = read_points(points, where);
  const std::string file = name + "_points.csv";
  write_text_file(job.side_file(file), csv({{points.x, "-", read.x}, {points.y, "-", read.y}}));
  PlotLine line{file, points.x, points.y, points.legend};
  line.points = true;
  plot.lines.insert(plot.lines.begin(), line);
}

// The x-y figures of the config, drawn from the CSV table.
void draw_curves(const Job<PostConfig>& job, const std::vector<ColumnChoice>& columns,
                 const std::string& csv_file, int rows, Pictures& pictures) {
  for (const auto& [name, figure] : job.config.figures) {
    Plot plot = plot_of(figure, columns, csv_file, csv_name);
    plot.rows = rows;
    if (figure.points) add_points(job, name, *figure.points, plot);
    pictures.draw(name, plot);
  }
}

// Maps of the surface, each with a CSV table of its own.
void draw_maps(const Job<PostConfig>& job, const std::vector<SurfaceMap>& maps,
               Pictures& pictures) {
  for (const SurfaceMap& map : maps) {
    write_text_file(job.side_file(map.name + ".csv"), csv(columns_of(map)));
    pictures.draw(map.name, map_drawing({{"", &map}}, job.config.maps.at(map.name).style, 1,
                                        pictures.look()));
  }
}

// Adds the summary of the solution, such as error estimates, except for names that are columns.
void add_solution_summary(const SolutionReader& reader, std::vector<Summary>& summary) {
  for (const Summary& s : reader.summary())
    if (std::ranges::find(summary, s.name, &Summary::name) == summary.end()) summary.push_back(s);
}

// Draws the deformed body. Indenters whose surface is not in the solution cannot be drawn.
void draw_renders(const Job<PostConfig>& job, const Solution& solution, const Renders& renders,
                  const std::vector<RigidContact>& indenters,
                  const std::vector<std::string>& missing, const ContactStates& contacts,
                  const std::map<std::string, int>& rows, Pictures& pictures) {
  for (const auto& [name, keyed] : renders) {
    const RenderChoice& choice = keyed.second;
    const StepState state =
        with_mode(job, solution, keyed.first, choice,
                  pictured_state(solution, contacts, rows.at(name), choice.field));
    pictures.draw(
        name, drawing_of(solution, indenters, state, choice, job.config.stress, pictures.look()));
  }
  if (renders.empty()) return;
  for (const std::string& name : missing)
    job.say("not drawn: the indenter \"{}\", whose triangles are not in the solution", name);
}

// The table of all states comes first: columns, curves, snapshots and pictures refer to its rows.
std::vector<Summary> post(const Job<PostConfig>& job) {
  PostConfig config = job.config;
  const Solution solution(job.input("solution"));
  const SolutionHeader& header = solution.reader.header();
  std::vector<RigidContact> indenters = indenters_of(header);
  follow_records(indenters, solution.reader);
  const std::vector<SurfaceContact> surfaces = touching_surfaces(header);
  const std::vector<std::string> missing = indenters_missing(header, indenters, surfaces);

  // Columns that this solution cannot have are errors, before any work.
  Available available;
  available.contact = !header.contact_nodes.empty();
  available.indenter = !indenters.empty();
  available.energy = missing.empty() && knows_work(header, surfaces);
  if (solution.reader.n_steps() > 0)
    for (const auto& [name, value] : solution.reader.step(0).scalars)
      available.histories.push_back(name);
  config.columns = with_errors(config.columns, available.histories);
  const Measures shown = look_up(config.columns, "columns", solution.body, available);
  const Measures further = look_up(config.further, "further", solution.body, available);
  const Renders renders = renders_of(config);
  std::vector<Complaint> complaints = shown.complaints;
  for (const auto& more :
       {further.complaints, complaints_of(config, renders, solution.body, available)})
    complaints.insert(complaints.end(), more.begin(), more.end());
  if (!complaints.empty()) refuse(job, complaints);

  // `further` columns are used by figures and the summary, but are not in the table.
  std::vector<Measure> measures = shown.measures;
  measures.insert(measures.end(), further.measures.begin(), further.measures.end());
  const ContactStates contacts(solution.reader, indenters, surfaces);
  const Table table = table_of(job, solution, indenters, surfaces, contacts, measures);
  std::vector<int> snapshots;
  for (std::size_t i = 0; i < config.snapshots.size(); ++i)
    snapshots.push_back(table.row(job, fmt::format("snapshots[{}]", i), config.snapshots[i]));
  std::map<std::string, int> pictured;
  for (const auto& [name, keyed] : renders)
    pictured[name] = table.row(job, keyed.first + ".step", keyed.second.step);
  Curves curves = curves_of(job, solution, contacts, table, shown.measures.size());

  // The main output is written last: if it exists, all other files exist.
  const std::filesystem::path csv_file =
      std::filesystem::path(job.output).replace_extension(".csv");
  write_text_file(csv_file.string(), csv(curves.columns));
  for (int row : snapshots)
    write_snapshot_of(job, solution, contacts, row, table.t[static_cast<std::size_t>(row)]);
  if (config.series) write_series(job, solution, contacts);
  Pictures pictures(job.side_file(""), config.figure_style, config.draw == Draw::always);
  // The scripts of figures are in the side folder, so they name the table relative to it.
  std::string table_file = csv_file.filename().string();
  if (job.side_folder != csv_file.parent_path()) table_file = "../" + table_file;
  draw_curves(job, config.columns, table_file, static_cast<int>(table.t.size()), pictures);
  draw_maps(job, curves.maps, pictures);
  draw_renders(job, solution, renders, indenters, missing, contacts, pictured, pictures);
  for (const auto& [reason, names] : pictures.failed())
    job.say("not drawn: {} ({})", names, reason);
  // The cost of the solution is kept for work-precision diagrams (langer-tune).
  Identity identity = job.identity;
  identity.solution_cost = header.identity.solution_cost;
  add_solution_summary(solution.reader, curves.summary);
  write_curves(job.output, curves, identity);
  std::string on_request;
  if (config.draw != Draw::always) on_request = " on request: gnuplot <name>.gp draws one";
  job.say("{}, {} in {}; {}, {}{}", counted(table.t.size(), "row"),
          counted(curves.columns.size(), "column"), csv_file.filename().string(),
          counted(snapshots.size(), "snapshot"),
          counted(config.figures.size() + config.maps.size() + renders.size(), "figure"),
          on_request);
  return curves.summary;
}

// Names of the scripts and of the series, by which the side folder is chosen.
std::vector<std::string> side_files(const PostConfig& config) {
  std::vector<std::string> names;
  for (const auto& [name, figure] : config.figures) names.push_back(name + ".gp");
  for (const auto& [name, map] : config.maps) names.push_back(name + ".gp");
  for (const auto& [name, render] : renders_of(config)) names.push_back(name + ".gp");
  if (config.series) names.push_back("series.pvd");
  return names;
}

// --export: writes the solved scene as input files of other programs, and nothing else.
int export_scene(int argc, char** argv) {
  const Usage usage = usage_of(*find_stage("post"), find_config_kind("post")->top_keys());
  Arguments options(usage.program);
  std::string solution, log;
  std::vector<std::string> files;
  bool quiet = false;
  options.text("--solution", solution, true);
  options.texts("--export", files, true);
  options.flag("--quiet", quiet);
  options.text("--log", log);
  options.version();
  RunLog kept_log;
  return guarded(usage.program, [&] {
    int code = 0;
    if (!options.read(usage, argc, argv, code)) return code;
    never_replace(solution);
    if (!log.empty()) kept_log.open(log, command_line(argc, argv), false);
    require_file(solution);
    for (const WrittenDeck& deck : write_decks(solution, files)) {
      if (!quiet) say_line("post: {} for {}", deck.file, deck.program);
      for (const std::string& line : deck.warnings) say_line("post: warning: {}", line);
    }
    return static_cast<int>(Exit::ok);
  });
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]).starts_with("--export")) return langer::export_scene(argc, argv);
  return langer::run_stage<langer::PostConfig>(argc, argv, "post", langer::post,
                                               langer::side_files);
}

// langer-post: curves, snapshots and figures of a solution.
//   langer-post indentation.yaml --solution solution.h5 -o curves.h5
#include <fstream>

#include "post/gnuplot.hpp"
#include "scene/post_config.hpp"
#include "scene/post_files.hpp"
#include "stage.hpp"
#include "store/curves_file.hpp"
#include "store/seal.hpp"
#include "store/snapshot.hpp"
#include "store/solution_file.hpp"

namespace langer {
namespace {

// Row 0 of every table is the unloaded state, row i the i-th step.
struct Solution {
  explicit Solution(const std::string& path)
      : reader(path), body(reader.header().mesh, {reader.header().material}, formulation_of(reader.header(), path)) {}
  SolutionReader reader;
  Body body;
  StepRecord record(int row) const {
    if (row > 0) return reader.step(row - 1);
    StepRecord rest;
    rest.u.assign(body.mesh().X.size(), Vec3::Zero());
    rest.reaction = rest.u;
    return rest;
  }
};

using Columns = std::vector<Column>;

[[noreturn]] void refuse(const Job<PostConfig>& job, const std::vector<Complaint>& complaints) {
  std::vector<Error> errors;
  for (const Complaint& c : complaints) errors.push_back({job.where(c.key), c.key, c.found, c.expected, c.hint});
  throw Failure(Exit::config, std::move(errors));
}

int chosen_row(const Job<PostConfig>& job, const std::string& key, const std::string& step, const std::vector<double>& t) {
  const int row = row_of(*parse_step(step), t);
  if (row < 0) refuse(job, {{key, step, fmt::format("a row from 0 to {}, or t=0 to t={}", t.size() - 1, t.back()), ""}});
  return row;
}

// Writes the scripts of figures and runs them; what goes wrong is said at the end, each reason once.
struct Figures {
  const Job<PostConfig>& job;
  std::map<std::string, std::string> failed;  // reason -> figures

  void draw(const std::string& name, const std::string& script) {
    write_text_file(job.beside(name + ".gp"), script);
    const std::string reason = run_gnuplot(std::filesystem::path(job.output).parent_path().string(), name + ".gp");
    if (!reason.empty()) failed[reason] += (failed[reason].empty() ? "" : ", ") + name;
  }
  void report() const {
    for (const auto& [reason, names] : failed) job.say("not drawn: {} ({})", names, reason);
  }
};

std::vector<Summary> post(const Job<PostConfig>& job) {
  const PostConfig& config = job.config;
  const Solution solution(job.input("solution"));
  const SolutionHeader& header = solution.reader.header();
  const int n_steps = solution.reader.n_steps();

  Available available{!header.contact_nodes.empty(), {}};
  if (n_steps > 0)
    for (const auto& [name, value] : solution.reader.step(0).scalars) available.histories.push_back(name);
  Measures table = look_up(config.columns, "columns", solution.body, available);
  Measures further = look_up(config.further, "further", solution.body, available);
  table.complaints.insert(table.complaints.end(), further.complaints.begin(), further.complaints.end());
  if (config.render && config.render->field == Quantity::fibre_stretch && config.render->family > solution.body.n_families())
    table.complaints.push_back({"render.family", "a fibre family that the material lacks", "another field", ""});
  if (!table.complaints.empty()) refuse(job, table.complaints);

  std::vector<Measure> measures = table.measures;
  measures.insert(measures.end(), further.measures.begin(), further.measures.end());
  Columns columns;
  for (const Measure& m : measures) columns.push_back({m.name, m.unit, {}});
  std::vector<double> t;
  for (int row = 0; row <= n_steps; ++row) {
    const StepState state = state_of(solution.record(row));
    GaussValues gauss;
    const std::vector<double> values = measured(solution.body, measures, config.stress, state, gauss);
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(values[c]);
    t.push_back(state.t);
  }
  std::vector<int> snapshots;
  for (std::size_t i = 0; i < config.snapshots.size(); ++i)
    snapshots.push_back(chosen_row(job, fmt::format("snapshots[{}]", i), config.snapshots[i], t));
  const int pictured = config.render ? chosen_row(job, "render.step", config.render->step, t) : 0;

  Curves curves;
  curves.columns.assign(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(table.measures.size()));
  const Column& x = columns.front();
  for (std::size_t c = 1; c < columns.size(); ++c)
    curves.curves.push_back({columns[c].name, x.name, x.unit, columns[c].name, columns[c].unit, x.values, columns[c].values});
  for (const Column& c : columns) curves.summary.push_back({c.name, c.values.back(), c.unit});

  // the main output comes last: once it is there, everything is
  const std::filesystem::path csv_file = std::filesystem::path(job.output).replace_extension(".csv");
  write_text_file(csv_file.string(), csv(curves.columns));
  for (int row : snapshots) {
    const SnapshotFields fields = snapshot_fields(solution.body, header, solution.record(row), config.stress);
    write_snapshot(job.beside(fmt::format("snapshot_{:04}.hdf", row)), header.mesh, fields.points, fields.cells, job.identity);
  }
  Figures figures{job, {}};
  for (const auto& [name, figure] : config.figures) {
    Plot plot = plot_of(figure, config.columns, csv_file.filename().string(), csv_name);
    plot.rows = n_steps + 1;
    figures.draw(name, gnuplot_script(plot, name));
  }
  if (config.render) {
    const StepState state = state_of(solution.record(pictured));
    RenderScene scene{header.mesh, header.mesh.X, picture_values(solution.body, state, *config.render, config.stress), "",
                      sphere_of(header, state.u_ind)};
    for (std::size_t i = 0; i < scene.x.size(); ++i) scene.x[i] += state.u[i];
    const QuantityLine& field = line_of(config.render->field);
    scene.label = plain(with_unit(field.label, field.unit));
    const Drawing drawing = render(scene, *config.render);
    write_text_file(job.beside("render.svg"), svg(drawing));
    figures.draw("render", gnuplot_script(drawing, "render"));
  }
  figures.report();
  write_curves(job.output, curves, job.identity);
  job.say("{} rows, {} columns in {}; {} snapshots, {} figures", t.size(), curves.columns.size(), csv_file.filename().string(),
          snapshots.size(), config.figures.size() + config.render.has_value());
  return curves.summary;
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) { return langer::run_stage<langer::PostConfig>(argc, argv, "post", langer::post); }

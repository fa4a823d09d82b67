// langer-tune: the work-precision diagram of a refinement study.
//   langer-tune tune.yaml --curves a/curves.h5 --curves b/curves.h5 -o levels.h5
//
// Writes errors, CPU seconds and memory of every level (also levels.csv); the Pareto front of each
// quantity as a picture and CSV, with bars for the uncertainty of the reference; and the cheapest
// level for each wanted error that is not below that uncertainty (cheapest.csv).
#include <cmath>

#include "core/hdf5/seal.hpp"
#include "pipeline/sweep/gather.hpp"
#include "pipeline/sweep/sweep_file.hpp"
#include "pipeline/sweep/tune_config.hpp"
#include "pipeline/sweep/work_precision.hpp"
#include "results/plot/gnuplot.hpp"
#include "results/plot/pictures.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// The levels of a refinement study with the cost of each.
struct Levels {
  std::vector<GatherInput> members;
  std::vector<Cost> cost;

  // The level with these values on the axes; refuses values that no level has.
  std::size_t at(const Job<TuneConfig>& job, const std::string& key,
                 const std::vector<std::string>& at) const {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (members[i].at == at) return i;
      known.push_back(fmt::format("[{}]", fmt::join(members[i].at, ", ")));
    }
    throw Failure(Exit::config,
                  Error{job.where(key), key, fmt::format("no level is [{}]", fmt::join(at, ", ")),
                        fmt::format("one of {}", fmt::join(known, ", ")), ""});
  }
};

// Reads the levels. The cost of a solution that was continued, or made by an older version, is not
// known (NaN).
Levels levels_of(const Job<TuneConfig>& job) {
  const std::vector<std::string>& files = job.inputs.at("curves");
  const TuneConfig& config = job.config;
  if (!config.members.empty() && config.members.size() != files.size())
    throw Failure(Exit::config,
                  Error{job.where("members"), "members",
                        fmt::format("found {} members", config.members.size()),
                        fmt::format("one for each of the {} files given", files.size()), ""});
  Levels levels;
  for (std::size_t i = 0; i < files.size(); ++i) {
    GatherInput member{files[i], {files[i]}, read_summary(files[i])};
    if (!config.members.empty()) {
      member.path = config.members[i].path;
      member.at = config.members[i].at;
    }
    const std::optional<Cost> cost = read_origin(files[i]).identity.solution_cost;
    if (!cost)
      job.say(
          "{}: its solution was made in several runs, or by an older version: its cost is not "
          "known",
          member.path);
    levels.members.push_back(std::move(member));
    levels.cost.push_back(cost.value_or(Cost{NAN, NAN, NAN}));
  }
  return levels;
}

struct Reference {
  Limit limit;
  std::vector<std::size_t> members;  // levels that the reference is taken from: they have no error
};

// The reference value of one quantity: a fitted limit, a member, or Richardson's extrapolation.

Reference reference_of(const Job<TuneConfig>& job, const Levels& levels,
                       const std::vector<double>& values) {
  const TuneReference& wanted = job.config.reference;
  if (wanted.fitted) {
    std::vector<double> lengths;
    std::vector<double> of_members;
    for (std::size_t i = 0; i < wanted.fitted->members.size(); ++i) {
      const MemberOfLength& m = wanted.fitted->members[i];
      lengths.push_back(m.length);
      of_members.push_back(
          values[levels.at(job, fmt::format("reference.fitted.members[{}].member", i), m.member)]);
    }
    return {fitted_limit(lengths, of_members, wanted.fitted->order), {}};
  }
  if (!wanted.richardson) {
    const std::size_t i = levels.at(job, "reference.member", wanted.member);
    return {{values[i], 0, 0}, {i}};
  }
  const RichardsonConfig& r = *wanted.richardson;
  const std::size_t coarse = levels.at(job, "reference.richardson.coarse", r.coarse);
  const std::size_t middle = levels.at(job, "reference.richardson.middle", r.middle);
  const std::size_t fine = levels.at(job, "reference.richardson.fine", r.fine);
  return {richardson(values[coarse], values[middle], values[fine], r.ratio), {fine}};
}

std::string name_of(const GatherInput& member) {
  return fmt::format("{}", fmt::join(member.at, " "));
}

// Errors of one quantity, in percent of its reference.
struct LevelErrors {
  std::vector<double> all = {};    // of each level
  std::vector<double> found = {};  // NaN for levels that the reference is taken from
  double uncertain = 0;            // uncertainty of the reference
  std::vector<int> front = {};     // the Pareto front of the known errors
  // Errors, or the uncertainty of the reference where it is larger.
  std::vector<double> known() const {
    std::vector<double> known;
    for (double e : found) known.push_back(known_error(e, uncertain));
    return known;
  }
};

// Writes error_<quantity>.csv and error_<quantity>_front.csv, and draws the work-precision diagram.
// The levels of the front are numbered in the picture; their names are notes below it, because
// names of this length would overlap next to the points.
void draw(const Job<TuneConfig>& job, Pictures& pictures, const std::string& quantity,
          const Levels& levels, const std::vector<double>& cpu, const LevelErrors& errors) {
  const std::string name = "error_" + quantity;
  const std::string head = "level,cpu_s,error_percent,error_low,error_high";
  std::string all = head + "\n";
  std::string best = head + ",number\n";
  std::vector<std::string> notes;
  const auto line = [&](std::size_t i) {
    // The lower end of an error bar must not be 0 on a logarithmic axis.
    const double e = errors.found[i];
    const double low = std::max(e - errors.uncertain, 0.1 * e);
    return fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g}", csv_cell(name_of(levels.members[i])),
                       cpu[i], e, low, e + errors.uncertain);
  };
  for (std::size_t i = 0; i < cpu.size(); ++i)
    if (std::isfinite(cpu[i]) && errors.found[i] > 0) all += line(i) + "\n";
  for (int i : errors.front) {
    const auto k = static_cast<std::size_t>(i);
    if (!(errors.found[k] > 0)) continue;
    best += line(k) + fmt::format(",{}\n", notes.size() + 1);
    notes.push_back(fmt::format("{}  {}", notes.size() + 1, name_of(levels.members[k])));
  }
  write_text_file(job.side_file(name + ".csv"), all);
  write_text_file(job.side_file(name + "_front.csv"), best);
  Plot plot;
  plot.title = job.config.title;
  plot.x_label = "CPU time (s)";
  plot.y_label = "error of " + literal(quantity) + " (%)";
  plot.scale = AxisScale::log;
  plot.lines = {{name + "_front.csv", "cpu_s", "error_percent", "front"},
                {name + ".csv", "cpu_s", "error_percent", "levels"}};
  plot.lines[0].names = "number";
  plot.notes = std::move(notes);
  plot.lines[1].points = true;
  if (errors.uncertain > 0) {
    plot.lines[1].low = "error_low";
    plot.lines[1].high = "error_high";
  }
  pictures.draw(name, plot);
}

// Prints the cheapest level for each wanted error; returns the lines of cheapest.csv.
std::string choose(const Job<TuneConfig>& job, const std::string& quantity, const Levels& levels,
                   const std::vector<double>& cpu, const std::vector<double>& memory,
                   const LevelErrors& errors) {
  std::string choice;
  for (double wanted : job.config.wanted) {
    const int i = cheapest(cpu, errors.known(), wanted);
    if (i < 0) {
      if (wanted < errors.uncertain)
        job.say("  {:g} %: not known, the reference itself is not that accurate", wanted);
      else
        job.say("  {:g} %: no level", wanted);
      choice += fmt::format("{},{:g},,,,\n", quantity, wanted);
      continue;
    }
    const auto k = static_cast<std::size_t>(i);
    const double error = errors.known()[k];
    std::string bound;
    if (errors.found[k] < errors.uncertain) bound = "at most ";
    job.say("  {:g} %: {} ({}{:.2g} %, {:.3g} s, {:.0f} MB)", wanted, name_of(levels.members[k]),
            bound, error, cpu[k], memory[k]);
    choice += fmt::format("{},{:g},{},{:.4g},{:.4g},{:.4g}\n", csv_cell(quantity), wanted,
                          csv_cell(name_of(levels.members[k])), error, cpu[k], memory[k]);
  }
  return choice;
}

// Errors in percent. A level that the reference is taken from has no error of its own.
LevelErrors errors_of(const std::vector<double>& values, const std::vector<double>& cpu,
                      const Reference& reference) {
  const double right = reference.limit.value;
  LevelErrors errors{.uncertain = 100 * reference.limit.uncertainty / std::abs(right)};
  for (double v : values) errors.all.push_back(100 * std::abs(v - right) / std::abs(right));
  errors.found = errors.all;
  for (std::size_t i : reference.members) errors.found[i] = NAN;
  errors.front = pareto_front(cpu, errors.known());
  return errors;
}

// The uncertainty and the order of an extrapolated reference; empty for a member.
std::string reference_words(const Job<TuneConfig>& job, const LevelErrors& errors,
                            const Limit& limit) {
  if (!job.config.reference.member.empty()) return "";
  std::string order = ", no order seen";
  if (limit.order > 0) order = fmt::format(", order {:.2g}", limit.order);
  return fmt::format(" +- {:.2g} %{}", errors.uncertain, order);
}

std::vector<Summary> tune(const Job<TuneConfig>& job) {
  const Levels levels = levels_of(job);
  std::vector<SweepAxis> axes;
  for (const GatherAxis& a : job.config.axes) axes.push_back({a.name, a.unit, {}});
  const Sweep values = gather(job.config.quantities, axes, levels.members, job.where("quantities"));
  Sweep sweep = values;
  // The cost of each level is part of the table.
  std::vector<double> cpu;
  std::vector<double> wall;
  std::vector<double> memory;
  for (const Cost& c : levels.cost) {
    cpu.push_back(c.cpu);
    wall.push_back(c.wall);
    memory.push_back(c.memory);
  }
  sweep.columns.push_back({"cpu", "s", cpu});
  sweep.columns.push_back({"wall", "s", wall});
  sweep.columns.push_back({"memory", "MB", memory});

  Pictures pictures(job.side_file(""), job.config.figure_style);
  std::string choice = "quantity,wanted_percent,level,error_percent,cpu_s,memory_MB\n";
  std::vector<Summary> summary;
  for (const SweepColumn& column : values.columns) {
    const Reference reference = reference_of(job, levels, column.values);
    const double right = reference.limit.value;
    const LevelErrors errors = errors_of(column.values, cpu, reference);
    job.say("{}: reference {:.6g} {}{}", column.name, right, column.unit,
            reference_words(job, errors, reference.limit));
    // Errors and membership of the front become columns of the table, too.
    std::vector<double> on_front(cpu.size(), 0);
    for (int i : errors.front) on_front[static_cast<std::size_t>(i)] = 1;
    sweep.columns.push_back({column.name + "_error", "percent", errors.all});
    sweep.columns.push_back({column.name + "_front", "-", on_front});
    choice += choose(job, column.name, levels, cpu, memory, errors);
    draw(job, pictures, column.name, levels, cpu, errors);
    summary.push_back({column.name + "_reference", right, column.unit});
    summary.push_back(
        {column.name + "_reference_uncertainty", reference.limit.uncertainty, column.unit});
  }
  for (const auto& [reason, names] : pictures.failed())
    job.say("not drawn: {} ({})", names, reason);
  write_text_file(job.side_file("cheapest.csv"), choice);
  write_sweep(job.output, job.side_file("levels.csv"), sweep, nullptr, {}, job.identity);
  return summary;
}

std::vector<std::string> side_files(const TuneConfig&) { return {"cheapest.csv", "levels.csv"}; }

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::TuneConfig>(argc, argv, "tune", langer::tune,
                                               langer::side_files);
}

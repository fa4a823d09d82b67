// langer-fit: parameters of a law from measured tests.
//   langer-fit abdomen.yaml -o material.h5        also writes fit.csv (measured stress, model, error) and the law as input
//                                                 of other programs: abaqus.inp, ansys.txt, febio.xml, calculix.inp
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/base/interrupt.hpp"
#include "core/hdf5/replace.hpp"
#include "core/hdf5/seal.hpp"
#include "export/cards.hpp"
#include "identification/fit/cross_check.hpp"
#include "identification/fit/doubts.hpp"
#include "identification/fit/left_out.hpp"
#include "identification/fit/stiffness_at_rest.hpp"
#include "identification/inverse/inverse_fit.hpp"
#include "identification/inverse/scene_candidates.hpp"
#include "identification/inverse/wave_tests.hpp"
#include "identification/laws/law_comparison.hpp"
#include "identification/population/population_fit.hpp"
#include "identification/posterior/posterior.hpp"
#include "identification/sensitivity/long_work.hpp"
#include "identification/setup/fit_report.hpp"
#include "identification/setup/priors.hpp"
#include "identification/statistics/study_files.hpp"
#include "results/store/curves_file.hpp"
#include "stage.hpp"

namespace langer {
namespace {

// A fit to homogeneous tests. Errors of the data name the first file.
FitResult best_fit(const FitConfig& config, const FitProblem& problem) {
  try {
    return fit(problem, {config.searches(), static_cast<unsigned>(config.seed), {}});
  } catch (const Failure& failure) {
    std::vector<Error> errors = failure.errors();
    for (Error& e : errors) e.where.file = config.data.front().file.path;
    throw Failure(failure.code(), errors);
  }
}

// Writes what a search without an optimum has reached. Where a file of somebody else is in the way,
// the reason of the search is still the error of the run, and the file a warning.
void try_to_write(const Job<FitConfig>& job, const std::function<void()>& write) {
  try {
    write();
  } catch (const Failure& failure) {
    job.warn("what the search reached is not kept: {}", failure.what());
  }
}

// A search without an optimum: the parameters that it reached, and the curves that they make. They
// have names of their own, so that nothing takes them for a result.
void write_reached(const Job<FitConfig>& job, const FitProblem& problem, const FitResult& found,
                   const std::optional<InverseFit>& scenes) {
  if (!std::isfinite(found.best.cost)) return;
  std::string text = "parameter,key,reached,lower,upper\n";
  const std::vector<std::string> names = parameter_names(problem);
  for (std::size_t i = 0; i < problem.free.size(); ++i) {
    const FreeParameter& p = problem.free[i];
    text += fmt::format("{},{},{},{},{}\n", csv_cell(names[i]), csv_cell(p.key),
                        found.best.p[static_cast<Eigen::Index>(i)], p.lower, p.upper);
  }
  write_text_file(job.side_file("reached.csv"), text);
  FitRecord record = fit_record(problem, found);
  if (scenes) record.curves = scenes->curves(found);
  if (!record.tests.empty()) write_text_file(job.side_file("reached_fit.csv"), fit_csv(record));
  for (const NamedTable& table : curve_tables(record))
    write_text_file(job.side_file("reached_" + table.name + ".csv"), table.text);
  job.say(
      "the parameters that the search reached are in {}: start from them, or judge their curves",
      job.side_file("reached.csv"));
}

// Those of an earlier run that found no optimum. A reached.csv of somebody else stays.
void remove_reached(const Job<FitConfig>& job) {
  std::error_code ignored;
  const std::string reached = job.side_file("reached.csv");
  if (!std::filesystem::is_regular_file(reached, ignored)) return;
  std::string columns;
  std::getline(std::ifstream(reached), columns);
  if (!columns.starts_with("parameter,key,reached,")) return;
  for (const char* name : {"reached.csv", "reached_fit.csv", "reached_specimens.csv"})
    std::filesystem::remove(job.side_file(name), ignored);
}

// The lines of a study that a reader acts on: what is known least, and the test to make next.
bool is_main_line(const std::string& line) {
  return line.starts_with("least identifiable") || line.starts_with("advice:");
}

// The search of a fit with or without scenes.
FitResult search(const Job<FitConfig>& job, const FitProblem& problem,
                 std::optional<InverseFit>& scenes) {
  if (scenes) {
    try {
      return scenes->search();
    } catch (const Failure& failure) {
      if (scenes->reached())
        try_to_write(job, [&] { write_reached(job, problem, *scenes->reached(), scenes); });
      throw;
    }
  }
  FitResult found = best_fit(job.config, problem);
  if (found.best.converged) return found;
  try_to_write(job, [&] { write_reached(job, problem, found, scenes); });
  throw Failure(
      Exit::not_converged,
      {job.where("parameters"), "parameters",
       fmt::format("no optimum from {} starts: {}; KKT residual {:.2g}, cost {:.6g} MPa^2",
                   job.config.searches(), found.best.why, found.best.kkt, found.best.cost),
       "", "more starts, other start values or narrower bounds"});
}

// A law that misses the data by more than their own mean does is no result; it is written all the
// same, so that the user sees how it misses them.
void require_description(const Job<FitConfig>& job, const FitRecord& record) {
  if (!(record.r2 < 0)) {
    return;
  }
  throw Failure(
      Exit::not_converged,
      {job.where("data"), "data",
       fmt::format("R2 {:.3g}: the law describes the data worse than their mean does", record.r2),
       "R2 above 0",
       job.output +
           " holds what was found; check the signs (sign: -1), the measures and the units of "
           "the data, and the bounds of the parameters"});
}

// tables and figures of what was measured in scenes
void write_curves_of_scenes(const Job<FitConfig>& job, const FitRecord& record) {
  for (const NamedTable& table : curve_tables(record))
    write_text_file(job.side_file(table.name + ".csv"), table.text);
  if (!job.config.study || !job.config.study->figures) return;
  for (const std::string& line :
       draw_curves(record.curves, job.config.figure_style, job.side_file("")))
    job.say("{}", line);
}

// A table with other columns than those of this fit is somebody else's. It is found before the
// search, not after it.
void check_side_files(const Job<FitConfig>& job, const FitProblem& problem) {
  FitRecord columns;
  for (const Test& test : problem.tests) {
    FittedTest one;
    one.kind = names(test.kind)[static_cast<std::size_t>(test.kind)];
    one.measure = names(test.measure)[static_cast<std::size_t>(test.measure)];
    columns.tests.push_back(one);
  }
  if (!columns.tests.empty()) require_replaceable_by(job.side_file("fit.csv"), fit_csv(columns));
  require_replaceable_by(job.side_file("parameters.csv"), parameters_csv(columns));
  for (const Card& card : cards(job.config.law)) {
    require_replaceable_by(job.side_file(card.file), card.text);
  }
}

// Samples of the posterior. Their scenes are solved at some of them only.
Posterior sampled_posterior(const Job<FitConfig>& job, const FitProblem& problem,
                            const FitResult& found, const std::optional<InverseFit>& scenes) {
  const PosteriorConfig& asked = *job.config.study->posterior;
  const int threads = job.config.study->threads;
  std::vector<std::string> lines, warnings;
  Posterior sampled;
  if (scenes) {
    const CostlyPosterior costly = costly_posterior(
        scenes->costly(), found, asked, threads,
        [&](const std::string& line) { job.detail("{}", line); },
        progress_of("fit", "posterior", job.quiet));
    lines = costly_posterior_lines(costly);
    warnings = costly_posterior_warnings(costly, asked);
    sampled = costly.posterior;
  } else {
    sampled = posterior(problem, found, asked, threads, progress_of("fit", "posterior", job.quiet));
    lines = posterior_lines(sampled);
    warnings = posterior_warnings(sampled);
  }
  for (const std::string& line : lines) job.say("{}", line);
  for (const std::string& line : warnings) job.warn("{}", line);
  return sampled;
}

// A fit of one law: read, search, report, then tables, figures and the study. `tables`: of a
// comparison in which this law was chosen.
std::vector<Summary> fit_one_law(const Job<FitConfig>& job,
                                 const std::vector<RecordTable>& tables = {}) {
  const FitConfig& config = job.config;
  FitProblem problem = fit_problem(config);
  check_side_files(job, problem);
  if (tables.empty()) {  // else the comparison has printed them
    for (const std::string& line : doubts(problem.tests)) job.warn("{}", line);
  }
  const std::vector<Prior> priors = priors_of(config, problem, job.where);
  const bool only_tests = !config.has_scenes();
  if (!priors.empty() && only_tests) {
    weigh_by_noise(problem, {config.searches(), static_cast<unsigned>(config.seed), {}});
    problem.further = with_priors(priors, {});
    problem.noise = NoiseKind::white;
  }
  std::optional<InverseFit> scenes;
  std::optional<Interruptible> at_the_end_of_an_increment;
  if (config.has_scenes()) {
    at_the_end_of_an_increment.emplace();
    scenes.emplace(job.voice(), config, job.where, problem,
                   job.has("curves") ? job.inputs.at("curves") : std::vector<std::string>(),
                   job.output + ".runs");
    if (!priors.empty()) scenes->set_priors(priors);
  }
  std::shared_ptr<WaveTests> waves;
  if (config.has_waves()) {
    waves = std::make_shared<WaveTests>(config, job.where, problem);
    problem.further = waves;
  }
  FitResult found = search(job, problem, scenes);
  remove_reached(job);
  const auto at_rest =
      scenes || waves ? std::nullopt
                      : stiffen_at_rest(problem, found,
                                        {config.searches(), static_cast<unsigned>(config.seed), {}},
                                        config.noise());
  FitRecord record = fit_record(problem, found);
  record.tables = tables;
  record.at_rest = at_rest;
  if (config.leave_one_out) record.left_out_error_percent = left_out_error(problem, found);
  for (std::size_t i = 0; i < config.parameters.size(); ++i)
    record.parameters[i].truth = config.parameters[i].truth.value_or(std::nan(""));
  if (scenes)
    for (const std::string& line : scenes->add_curves(found, record)) job.say("{}", line);
  if (waves) record.curves = waves->fitted(found, problem.tests.size());
  for (const std::string& line : fit_results(record)) job.say("{}", line);
  for (const std::string& line : fit_warnings(record, found.material)) job.warn("{}", line);
  if (scenes)
    for (const std::string& line : scenes->cost()) job.detail("{}", line);
  if (config.cross_check == SecondAnswer::nlopt) {
    const Comparison second = cross_check(likelihood_problem(problem, found), found.best,
                                          static_cast<unsigned>(config.seed));
    if (second.agrees) {
      job.detail("{}", second.text);
    } else {
      job.warn("{}", second.text);
    }
  }
  if (!scenes && !waves) record.study.range = fitted_range(found.material, problem.tests);
  if (config.study) {
    const SceneCandidates next = scene_candidates(config, problem, found, job.where);
    for (const std::string& line : next.without) job.warn("{}", line);
    record.study = study(
        problem, found, *config.study,
        [&](const std::string& what) { return progress_of("fit", what, job.quiet); },
        next.candidates);
    for (const std::string& line : study_lines(record.study)) {
      if (is_main_line(line)) {
        job.say("{}", line);
      } else {
        job.detail("{}", line);
      }
    }
    for (const std::string& line :
         write_study_files(record.study, *config.study, config.figure_style, job.side_file("")))
      job.say("{}", line);
  }
  if (scenes && config.study && config.study->held.value_or(true))
    for (const InverseFit::Widening& widening : scenes->widenings(found))
      job.say("{}", in_words(widening));
  if (config.study && config.study->posterior) {
    const Posterior sampled = sampled_posterior(job, problem, found, scenes);
    record.tables.push_back(sampled.table);
    write_text_file(job.side_file("posterior.csv"), csv(sampled.table));
    write_text_file(job.side_file("posterior_samples.csv"), posterior_csv(sampled));
  }
  if (!record.tests.empty()) write_text_file(job.side_file("fit.csv"), fit_csv(record));
  write_text_file(job.side_file("parameters.csv"), parameters_csv(record));
  write_curves_of_scenes(job, record);
  if (config.study && config.study->figures && !scenes && !waves && problem.tests.size() == 1 &&
      problem.tests[0].kind == TestKind::uniaxial)
    for (const std::string& line : draw_fit(csv_name(record.tests[0].measure + "_stress", "MPa"),
                                            config.figure_style, job.side_file("")))
      job.say("{}", line);
  for (const Card& card : cards(found.material))
    write_text_file(job.side_file(card.file), card.text);
  write_material(job.output, found.material, record, job.identity);
  if (scenes) scenes->done();
  require_description(job, record);
  return read_summary(job.output);
}

// `laws` or `discover`: all of them are compared, the best becomes the material.
std::vector<Summary> fit_best_law(const Job<FitConfig>& job) {
  const bool discover = job.config.discover.has_value();
  require_replaceable_by(job.side_file("laws.csv"), "law,");
  for (const std::string& line : doubts(measured_tests(job.config))) job.warn("{}", line);
  const auto progress = [&](const std::string& law) {
    job.say("fitting {}", law);
  };
  LawComparison comparison;
  if (discover) {
    comparison = discover_terms(job.config, progress);
  } else {
    comparison = compare_laws(job.config, progress);
  }
  for (const std::string& line : law_lines(comparison)) job.say("{}", line);
  std::vector<RecordTable> tables{law_table(comparison)};
  write_text_file(job.side_file("laws.csv"), csv(tables.front()));
  if (discover) {
    tables.push_back(term_table(comparison));
    write_text_file(job.side_file("terms.csv"), csv(tables.back()));
  }
  write_text_file(job.side_file("separating_tests.csv"), separation_csv(comparison));
  Job<FitConfig> best = job;
  best.config = comparison.laws.front().config;
  job.say("the material is {}", comparison.laws.front().name);
  return fit_one_law(best, tables);
}

// `specimens`: the material is that of the median specimen.
std::vector<Summary> fit_specimens(const Job<FitConfig>& job) {
  for (const std::string& name : population_files(job.config))
    require_replaceable_by(job.side_file(name), "");
  const auto at = [&](const std::string& key) {
    return job.where(key);
  };
  const PopulationOutcome outcome =
      fit_population(job.config, at, [&](const std::string& line) { job.say("{}", line); });
  if (outcome.no_result) {
    try_to_write(job, [&] {
      for (const PopulationFile& file : outcome.files)
        write_text_file(job.side_file(file.name), file.text);
      job.say("what the search reached, and the fits of the specimens alone, are in {} and {}",
              job.side_file(outcome.files.front().name), job.side_file(outcome.files.back().name));
    });
    throw Failure(Exit::not_converged, *outcome.no_result);
  }
  remove_reached(job);
  for (const std::string& line : outcome.lines) job.say("{}", line);
  for (const std::string& line : outcome.warnings) job.warn("{}", line);
  for (const PopulationFile& file : outcome.files)
    write_text_file(job.side_file(file.name), file.text);
  write_text_file(job.side_file("parameters.csv"), parameters_csv(outcome.record));
  for (const Card& card : cards(outcome.median))
    write_text_file(job.side_file(card.file), card.text);
  write_material(job.output, outcome.median, outcome.record, job.identity);
  return read_summary(job.output);
}

std::vector<Summary> fit_stage(const Job<FitConfig>& job) {
  if (job.config.specimens) return fit_specimens(job);
  if (!job.config.laws.empty() || job.config.discover) return fit_best_law(job);
  return fit_one_law(job);
}

// Files next to the output that the stage writes.
std::vector<std::string> side_files(const FitConfig& config) {
  std::vector<std::string> names{"parameters.csv"};
  if (config.specimens) {
    const std::vector<std::string> more = population_files(config);
    names.insert(names.end(), more.begin(), more.end());
    for (const Card& card : cards(config.law)) names.push_back(card.file);
    return names;
  }
  if (!config.laws.empty() || config.discover) {
    names.push_back("laws.csv");
    names.push_back("separating_tests.csv");
    if (config.discover) names.push_back("terms.csv");
  }
  if (config.study && config.study->posterior) {
    names.push_back("posterior.csv");
    names.push_back("posterior_samples.csv");
  }
  if (!config.data.empty()) names.push_back("fit.csv");
  for (const Card& card : cards(config.law)) names.push_back(card.file);
  return names;
}

}  // namespace
}  // namespace langer

int main(int argc, char** argv) {
  return langer::run_stage<langer::FitConfig>(argc, argv, "fit", langer::fit_stage,
                                              langer::side_files);
}

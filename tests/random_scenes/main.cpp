// Whether an accuracy that is asked for is kept, on scenes drawn at random
// (random_scenes/draw.hpp), and whether error bars hold.
//   langer-random-scenes FOLDER [seed=1] [scenes=24] [from=0] [asked=1] [seconds=120] [kind=any | section | suction | <name of a kind>] [steps] [default]
// Each scene is written to FOLDER/<name>.yaml, solved as langer-solve does with `accuracy`, and
// again on shorter cells and half the increments, whose limit is the truth and whose own error bar
// is what remains unknown of it; scenes that this would take longer than `seconds` of CPU have no
// truth. One line a scene, then the counts. default: the scene as it is drawn, without `accuracy`,
// is judged, by the bars that a config without `estimate` gets; its truth is the limit of the
// solution for the accuracy that is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "accuracy/checks/run_watch.hpp"
#include "accuracy/estimate/recovered_path.hpp"
#include "accuracy/refinement/accuracy.hpp"
#include "core/base/stopwatch.hpp"
#include "random_scenes/draw.hpp"
#include "random_scenes/tools.hpp"
#include "scene/model/solve_config_io.hpp"
#include "scene/run/body_mesh.hpp"
#include "scene/run/dry_run.hpp"

using namespace langer;

namespace {

struct Options {
  std::string folder;
  std::uint64_t seed = 1;
  int scenes = 24, from = 0;
  double asked = 1, seconds = 120;
  std::string kind = "any";
  bool steps = false;  // bars along the path are judged, too
  bool by_default = false;
};

bool is_kind(const std::string& name) {
  const std::vector<std::string> single = test::names_of_kinds();
  return name == "any" || name == "section" || name == "suction" ||
         std::find(single.begin(), single.end(), name) != single.end();
}

// Files of a config are relative to it.
std::string with_folder(std::string yaml, const std::string& folder) {
  const std::string key = "file: ";
  if (const auto at = yaml.find(key); at != std::string::npos)
    yaml.insert(at + key.size(), std::filesystem::absolute(folder).string() + "/");
  return yaml;
}

Options options_of(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    const auto at = text.find('=');
    const std::string key = text.substr(0, at),
                      value = at == std::string::npos ? "" : text.substr(at + 1);
    if (key == "steps")
      o.steps = true;
    else if (key == "default")
      o.by_default = true;
    else if (value.empty() && !text.starts_with("-"))
      o.folder = text;
    else if (key == "seed")
      o.seed = std::stoull(value);
    else if (key == "scenes")
      o.scenes = std::stoi(value);
    else if (key == "from")
      o.from = std::stoi(value);
    else if (key == "asked")
      o.asked = std::stod(value);
    else if (key == "seconds")
      o.seconds = std::stod(value);
    else if (key == "kind" && is_kind(value))
      o.kind = value;
    else
      throw std::invalid_argument(text);
  }
  if (o.folder.empty()) throw std::invalid_argument("no folder");
  return o;
}

const auto nowhere = [](const std::string&) {
  return Place{};
};
const Voice silent{"scenes", true};

struct Solved {
  double forecast = 0, took = 0;  // CPU seconds of the path
  std::vector<ErrorEstimate> errors;
  std::vector<StepForces> path;
  std::map<std::string, std::vector<double>> along;  // bars at each step
  double share = 1;                                  // of the cells that was solved
};
struct Answer {
  SolveConfig config;  // that it was solved with
  Solved solved;
  double seconds = 0;
  std::vector<double> forecasts;  // of each level of some seconds: what it took over what was told
};

constexpr double shortest = 0.2;  // CPU seconds that a clock tells

// Scenes that would take longer than that are left.
struct TooLong {
  double seconds;
};
double need_time(const SolveConfig& config, Run& run, double seconds) {
  const double takes = forecast_of(config, run.body, run.increment, run.scene).seconds();
  if (takes > seconds) throw TooLong{takes};
  return takes;
}

Solved solved_once(const SolveConfig& config, double seconds) {
  Run run(body_mesh(config, "", nowhere), config, config.material, nowhere);
  Solved out;
  out.forecast = need_time(config, run, seconds);
  out.share = run.share_of_cells();
  const double begun = cpu_seconds();
  const RunEnd end = run.follow(collecting({}, config, run, out.path));
  out.took = cpu_seconds() - begun;
  if (!end.path.complete)
    throw Failure(Exit::not_converged, Error{{}, "", "no equilibrium: " + end.path.why, "", ""});
  try {
    const PathErrors found =
        estimated(config, config.material, nowhere, run, end.last, out.path, {});
    out.errors = found.at_end, out.along = found.along;
  } catch (const Failure& failure) {
    if (failure.code() != Exit::not_converged)
      throw;  // else as accuracy/report_errors.hpp: not known
  }
  return out;
}

// as stages/solve.cpp, without files
Answer asked_for(const SolveConfig& config, double seconds) {
  const double start = cpu_seconds();
  Accuracy accuracy(silent, config, config.material, nowhere, false);
  Answer answer;
  for (bool again = true; again;) {
    answer.config = accuracy.config();
    try {
      answer.solved = solved_once(answer.config, seconds);
      if (answer.solved.took >= shortest)
        answer.forecasts.push_back(answer.solved.took / answer.solved.forecast);
      accuracy.solves_part(answer.solved.share);
      again = accuracy.decide(answer.solved.errors).action == Decision::Action::refine;
    } catch (const Failure& failure) {
      again = accuracy.retry_after(failure);
      if (!again) throw;
    }
  }
  answer.seconds = cpu_seconds() - start;
  accuracy.require(answer.solved.errors, "");
  accuracy.name_answers(answer.solved.errors);
  return answer;
}

Answer by_default(SolveConfig config) {
  const double start = cpu_seconds();
  config.accuracy.reset();
  Run run(body_mesh(config, "", nowhere), config, config.material, nowhere);
  RecoveredPath recovered(run, config, recovered_by_default(config, run));
  Answer answer;
  const Observer beside = recovered.beside({});
  RunWatch watch(run, config, nowhere, {});
  RunListener watched;
  watched.of_part = [&](StepRecord& record) {
    return watch.of_part(record);
  };
  watched.of_whole = [&](StepRecord& record, const SolveReport& report) {
    watch.of_whole(record, report);
  };
  const RunListener collect = collecting(watched, config, run, answer.solved.path);
  const RunEnd end = run.follow(beside.along ? beside.along(collect) : collect);
  if (!end.path.complete)
    throw Failure(Exit::not_converged, Error{{}, "", "no equilibrium: " + end.path.why, "", ""});
  if (recovered.wanted()) {
    const PathErrors found = recovered.errors(
        end.last, valued(config, run.scene, run.mesh, end.last), watch.contact_warnings().empty());
    answer.solved.errors = found.at_end, answer.solved.along = found.along;
  }
  answer.seconds = cpu_seconds() - start;
  return answer;
}

// on cells of 0.8 times the length; of sections, which are cheap, of half
Solved truth_of(SolveConfig config, double seconds) {
  scale_cells(config.mesh->geometry, is_section(config.mesh->geometry) ? 0.5 : 0.8);
  config.path.use_increment(0.5 * config.path.largest_increment());
  return solved_once(config, seconds);
}

struct Counts {
  int ended = 0, within = 0, outside = 0, undecided = 0, refused = 0, left = 0, without_truth = 0;
  int bars = 0, hold = 0, wide = 0;  // of forces
  int others = 0, others_hold = 0;   // of what no accuracy is asked of
  int steps = 0, steps_hold = 0;
  int nearer = 0;                 // limits than what was found, of forces
  int by_limit = 0;               // answers that are limits
  std::vector<double> forecasts;  // sorted at the end
};

// Bars of the steps before the end against the truth's forces there, each known to half its own
// bar.
void judge_steps(const std::string& name, const Solved& found, const Solved& truth,
                 Counts& counts) {
  for (const auto& [force, bars] : found.along) {
    if (!truth.along.contains(force)) continue;
    std::string words;
    for (std::size_t i = 0; i + 1 < bars.size() && i < found.path.size(); ++i) {
      const double t = found.path[i].t, q = found.path[i].of.at(force);
      if (q == 0) continue;
      double unknown = -1;  // between its steps the truth is known to nobody
      for (std::size_t k = 0; k < truth.path.size(); ++k)
        if (std::abs(truth.path[k].t - t) < 1e-9) unknown = 0.5 * truth.along.at(force)[k];
      if (unknown < 0) continue;
      const double off = q - force_at(truth.path, force, t);
      const bool holds = std::abs(off) <= bars[i] + unknown;
      ++counts.steps, counts.steps_hold += holds;
      words += fmt::format(" {:.3g}: {:+.2f} bar {:.2g} unknown {:.2g}{};", t, 100 * off / q,
                           100 * bars[i] / q, 100 * unknown / q, holds ? "" : " FAILS");
    }
    if (!words.empty()) fmt::print("| {} | {} at |{} | | | | | | |\n", name, force, words);
  }
}

void judge(const Options& o, const std::string& name, const Answer& answer,
           const std::vector<ErrorEstimate>& truths, Counts& counts) {
  const std::vector<ErrorEstimate> judged = forces_judged(answer.solved.errors);
  for (const ErrorEstimate& e : answer.solved.errors) {
    if (o.kind == "suction" && e.of.name == "von_mises_max")
      continue;                     // it has no limit at a rim where stresses are singular
    if (e.of.value == 0) continue;  // a rim that is held
    if (e.grows) continue;          // it has no bar, and says so
    const bool asked = std::any_of(judged.begin(), judged.end(),
                                   [&](const ErrorEstimate& j) { return j.of.name == e.of.name; });
    const auto t = std::find_if(truths.begin(), truths.end(), [&](const ErrorEstimate& other) {
      return other.of.name == e.of.name;
    });
    if (t == truths.end()) {
      fmt::print("| {} | {} | {:.4g} | no truth | | {:.2g} | | | {:.1f} |\n", name, e.of.name,
                 e.of.value, e.in_percent(e.total()), answer.seconds);
      counts.without_truth += asked;
      continue;
    }
    // The limit of the truth is known to half its bar, which is that of its value.
    const double truth = t->limit(), unknown = e.in_percent(0.5 * t->total());
    const double found = e.limit_answers ? e.limit() : e.of.value;
    const double off = e.in_percent(found - truth);
    const double bar = e.limit_answers ? e.limit_percent() : e.in_percent(e.total());
    counts.by_limit += asked && e.limit_answers;
    std::string verdict;
    if (asked) {
      const bool in = std::abs(off) <= o.asked, sure = std::abs(std::abs(off) - o.asked) > unknown;
      ++(in || !sure ? in ? counts.within : counts.undecided : counts.outside);
      if (!in) verdict = sure ? "OUTSIDE" : "outside?";
      ++counts.bars;
    } else {
      ++counts.others;
    }
    const bool holds = std::abs(off) <= bar + unknown;
    (asked ? counts.hold : counts.others_hold) += holds;
    if (asked) counts.wide += bar > 5 * (std::abs(off) + unknown);
    const double limit = e.in_percent(e.limit() - truth);
    counts.nearer += asked && e.has_limit && std::abs(limit) < std::abs(off);
    if (e.limit_answers) verdict += " limit";
    if (!holds) verdict += " bar fails";
    fmt::print("| {} | {} | {:.4g} | {:+.2f} | {:.2f} | {:.2g} | {} | {} | {:.1f} |\n", name,
               e.of.name, found, off, unknown, bar,
               e.has_limit ? fmt::format("{:+.2f}", limit) : "", verdict, answer.seconds);
  }
}

void say_forecasts(Counts& counts) {
  std::vector<double>& took = counts.forecasts;
  std::sort(took.begin(), took.end());
  if (took.empty()) return;
  const auto within =
      std::count_if(took.begin(), took.end(), [](double x) { return x > 1 / 1.5 && x < 1.5; });
  fmt::print(
      "{} of {} limits are nearer. {} of {} levels of {:g} s and more took what was told within 1.5 times; {:.2f} to {:.2f} times.\n",
      counts.nearer, counts.bars, within, took.size(), shortest, took.front(), took.back());
}

}  // namespace

int main(int argc, char** argv) try {
  const Options o = options_of(argc, argv);
  std::filesystem::create_directories(o.folder);
  test::write_tools(o.folder);
  Counts counts;
  fmt::print(
      "| scene | quantity | found | off by % | unknown +- % | bar +- % | limit: off by % | | CPU s |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (int i = o.from; i < o.from + o.scenes; ++i) {
    const test::DrawnScene scene = test::drawn_scene(o.seed, i, o.kind);
    const std::string file = o.folder + "/" + scene.name + ".yaml";
    std::ofstream(file) << scene.yaml << "accuracy: " << o.asked << "%\n";
    try {
      SolveConfig config =
          read_config<SolveConfig>(parse_yaml(with_folder(scene.yaml, o.folder), file)).config;
      config.accuracy = fmt::format("{:g}%", o.asked);
      const Answer answer = asked_for(config, o.seconds);
      ++counts.ended;
      counts.forecasts.insert(counts.forecasts.end(), answer.forecasts.begin(),
                              answer.forecasts.end());
      if (o.by_default) {
        const Answer plain = by_default(config);
        if (plain.solved.errors.empty()) fmt::print("| {} | no bar | | | | | | | |\n", scene.name);
        judge(o, scene.name, plain, answer.solved.errors, counts);
        if (o.steps) judge_steps(scene.name, plain.solved, answer.solved, counts);
        std::fflush(stdout);
        continue;
      }
      Solved truth;
      try {
        truth = truth_of(answer.config, o.seconds);
      } catch (const TooLong& too_long) {
        fmt::print("| {} | truth: {:.0f} s for one solve | | | | | | | |\n", scene.name,
                   too_long.seconds);
      } catch (const Failure& failure) {
        fmt::print("| {} | truth | {} | | | | | | |\n", scene.name, failure.what());
      }
      judge(o, scene.name, answer, truth.errors, counts);
      if (o.steps) judge_steps(scene.name, answer.solved, truth, counts);
    } catch (const TooLong& too_long) {
      ++counts.left;
      fmt::print("| {} | left: {:.0f} s for one solve | | | | | | | |\n", scene.name,
                 too_long.seconds);
    } catch (const Failure& failure) {
      ++counts.refused;
      fmt::print("| {} | ended with code {} | {} | | | | | | |\n", scene.name,
                 static_cast<int>(failure.code()), failure.what());
    }
    std::fflush(stdout);
  }
  fmt::print(
      "\n{} scenes of seed {}, asked for {:g} %: {} ended with success, {} with a code of their own, {} were left.\n",
      o.scenes, o.seed, o.asked, counts.ended, counts.refused, counts.left);
  fmt::print("Asked of: {} within, {} outside, {} not decided, {} without a truth. ", counts.within,
             counts.outside, counts.undecided, counts.without_truth);
  fmt::print(
      "Their bars: {} of {} hold, {} more than five times the error; {} are limits. All else: {} of {} bars hold.\n",
      counts.hold, counts.bars, counts.wide, counts.by_limit, counts.others_hold, counts.others);
  say_forecasts(counts);
  if (o.steps)
    fmt::print("At steps before the end: {} of {} hold.\n", counts.steps_hold, counts.steps);
  return 0;
} catch (const std::logic_error& wrong) {
  fmt::print(
      stderr,
      "langer-random-scenes FOLDER [seed=1] [scenes=24] [from=0] [asked=1] [seconds=120] [kind=any | section | suction | <name of a kind>] [steps] [default]; found {}\n",
      wrong.what());
  return 2;
}

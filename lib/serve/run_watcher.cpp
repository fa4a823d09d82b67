#include "serve/run_watcher.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "report/json.hpp"
#include "serve/child.hpp"

namespace langer {

namespace {

constexpr std::size_t longest_log = 200'000;  // bytes; the beginning is cut off
constexpr int deepest = 6;                    // folders of a sweep in each other
constexpr std::size_t most_series = 40;       // curves that the page shows

// A clock that is never set back [s].
double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

// Folders below a run that hold the journal of a solve.
// The journals of solves are found by their name: which steps a sweep has, langer-plan knows alone.
void find_journals(const ServedFolder& folder, const std::string& at, int depth,
                   std::vector<std::string>& found) {
  if (depth > deepest || found.size() >= most_series) return;
  for (const std::string& name : folder.files(at))
    if (name == "solution.h5.steps") found.push_back(at);
  for (const std::string& name : folder.folders(at))
    find_journals(folder, at + "/" + name, depth + 1, found);
}

}  // namespace

// Without an indenter the force is that on the nodes that are moved: where a node has moved along
// an axis and there is a reaction along it. Free nodes have none, held ones do not move.
ProgressPoint progress_point(const StepRecord& step) {
  ProgressPoint point;
  point.t = step.t;
  for (const Vec3& u : step.u) point.largest = std::max(point.largest, u.norm());
  if (!step.contacts.empty()) {
    point.travel = step.u_ind.norm();
    point.force = step.force_ind.norm();
  } else {
    Vec3 sum = Vec3::Zero();
    double most = 0;
    for (const Vec3& r : step.reaction) most = std::max(most, r.cwiseAbs().maxCoeff());
    for (std::size_t i = 0; i < std::min(step.u.size(), step.reaction.size()); ++i)
      for (int k = 0; k < 3; ++k) {
        if (step.u[i][k] == 0 || std::abs(step.reaction[i][k]) < 1e-6 * most) continue;
        sum[k] += step.reaction[i][k];
        point.travel = std::max(point.travel, std::abs(step.u[i][k]));
      }
    point.force = sum.norm();
  }
  for (const auto& [name, value] : step.scalars) {
    if (name.starts_with("travel_")) point.travel = std::abs(value);
    if (name.starts_with("angle_") && std::abs(value) > std::abs(point.angle)) point.angle = value;
    if (name.starts_with("torque_") && std::abs(value) > std::abs(point.torque))
      point.torque = value;
  }
  return point;
}

RunWatcher::RunWatcher(const ServedFolder& folder, std::string bin)
    : folder_(folder), bin_(std::move(bin)) {}

// A run does not outlive the server: the thread ends when its program has ended.
RunWatcher::~RunWatcher() {
  stop();
  if (thread_.joinable()) thread_.join();
}

// The thread outlives the request that starts it. Its end is the state that the page asks for.
void RunWatcher::start(const std::string& project) {
  const std::lock_guard lock(mutex_);
  if (state_ == "running")
    throw Failure(Exit::input, Error{{text_or(project_, "this project")},
                                     "",
                                     "a run is going on",
                                     "",
                                     "wait for it, or stop it"});
  if (thread_.joinable()) thread_.join();
  project_ = project;
  state_ = "running";
  log_.clear();
  series_.clear();
  ends_ = false;
  code_ = 0;
  begun_ = now();
  thread_ = std::thread([this, project] {
    int code = 1;
    try {
      code = work(project);
    } catch (const std::exception& failure) {
      add_log(failure.what() + std::string("\n"));
    }
    const std::lock_guard lock(mutex_);
    code_ = code;
    ended_ = now();
    state_ = "failed";
    if (code == 0) state_ = "done";
    if (ends_) state_ = "stopped";
  });
}

void RunWatcher::stop() {
  const std::lock_guard lock(mutex_);
  ends_ = true;
}

bool RunWatcher::is_running(const std::string& project) {
  const std::lock_guard lock(mutex_);
  return state_ == "running" && project_ == project;
}

// The beginning of a long log is dropped; the files *.log in the run's folder have all of it.
void RunWatcher::add_log(std::string_view text) {
  const std::lock_guard lock(mutex_);
  log_ += text;
  if (log_.size() > longest_log) log_.erase(0, log_.size() - longest_log / 2);
}

// Runs one program and looks for new steps of solves while it works.
int RunWatcher::command(const std::vector<std::string>& words, const std::string& project) {
  double looked = 0;
  return run_child({words, folder_.absolute(project)}, [&](bool, std::string_view text) {
    if (!text.empty()) add_log(text);
    if (now() - looked > 0.3) {
      follow();
      looked = now();
    }
    const std::lock_guard lock(mutex_);
    return !ends_;
  });
}

// The same as `make` with the Makefile of a starter. That file itself is not used: one that came by
// mail may start anything.
int RunWatcher::work(const std::string& project) {
  const std::string run = below(project, "run");
  folder_.has_folder(run);  // throws if it is a link
  const int planned = command({bin_ + "/langer-plan", "pipeline.yaml", "-o", "run"}, project);
  if (planned != 0) return planned;
  folder_.read(run + "/Makefile", 10'000'000);  // throws if it is a link
  const std::string jobs = fmt::format("-j{}", std::max(1u, std::thread::hardware_concurrency()));
  const int made =
      command({"make", "--no-print-directory", "-f", "Makefile", "-C", "run", jobs}, project);
  follow();
  return made;
}

// The files are read without the mutex; only this thread uses the followers.
void RunWatcher::follow() {
  std::vector<std::string> found;
  const std::string run = below(project_, "run");
  if (!folder_.has_folder(run)) return;
  find_journals(folder_, run, 0, found);
  for (const std::string& at : found) {
    const std::string name = at.substr(run.size() + (at.size() > run.size() ? 1 : 0));
    const std::lock_guard lock(mutex_);
    if (!series_.contains(name) && series_.size() < most_series)
      series_[name] = std::make_unique<Series>(folder_.absolute(at + "/solution.h5"));
  }
  for (auto& [name, series] : series_) {
    bool anew = false;
    const std::vector<StepRecord> steps = series->follower.more(anew);
    const std::lock_guard lock(mutex_);
    if (anew) series->points.clear();
    for (const StepRecord& step : steps) series->points.push_back(progress_point(step));
  }
}

// Columns instead of points: the page draws any of them over any other.
std::string RunWatcher::progress(const std::string& project) {
  using namespace report;
  const std::lock_guard lock(mutex_);
  if (project_ != project || state_ == "none") return object({{"state", words("none")}}).text;
  std::string series;
  for (const auto& [name, one] : series_) {
    const auto& points = one->points;
    if (points.empty()) continue;
    const auto column = [&](double ProgressPoint::*value) {
      return list(points, [&](const ProgressPoint& p) { return number(p.*value); });
    };
    append(series, ",",
           words(name).text + ":" +
               object({{"t", column(&ProgressPoint::t)},
                       {"travel", column(&ProgressPoint::travel)},
                       {"force", column(&ProgressPoint::force)},
                       {"angle", column(&ProgressPoint::angle)},
                       {"torque", column(&ProgressPoint::torque)},
                       {"largest", column(&ProgressPoint::largest)}})
                   .text);
  }
  const double until = state_ == "running" ? now() : ended_;
  return object({{"state", words(state_)},
                 {"code", number(code_)},
                 {"seconds", number(until - begun_)},
                 {"log", words(log_)},
                 {"series", Json{"{" + series + "}"}}})
      .text;
}

}  // namespace langer

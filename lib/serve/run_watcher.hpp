// The run of a project: langer-plan, then make in the folder of the run. One at a time.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "results/store/step_journal.hpp"
#include "serve/folder.hpp"

namespace langer {

// One accepted step of a solve, as the page draws it.
struct ProgressPoint {
  double t = 0;
  double travel = 0;   // of the indenter, or of what is moved [mm]
  double force = 0;    // on the indenter, or on what is moved [N]
  double angle = 0;    // of what is turned [deg]
  double torque = 0;   // [N mm]
  double largest = 0;  // displacement of any node [mm]
};
ProgressPoint progress_point(const StepRecord& step);

class RunWatcher {
 public:
  RunWatcher(const ServedFolder& folder, std::string bin);
  ~RunWatcher();  // ends the run

  // Throws Failure(input) if one is running.
  void start(const std::string& project);
  void stop();
  // {project, state: none | running | done | failed | stopped, code, seconds, log,
  //  series: {<folder of a solve>: {t: [], travel: [], ...}}}
  std::string progress(const std::string& project);
  bool is_running(const std::string& project);

 private:
  struct Series {
    StepFollower follower;
    std::vector<ProgressPoint> points;
    explicit Series(const std::string& output) : follower(output) {}
  };
  int work(const std::string& project);
  int command(const std::vector<std::string>& words, const std::string& project);
  void follow();
  void add_log(std::string_view text);

  const ServedFolder& folder_;
  std::string bin_;
  std::mutex mutex_;
  std::thread thread_;
  std::string project_, state_ = "none", log_;
  int code_ = 0;
  bool ends_ = false;
  double begun_ = 0, ended_ = 0;  // [s]
  std::map<std::string, std::unique_ptr<Series>> series_;
};

}  // namespace langer

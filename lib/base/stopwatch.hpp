// CPU seconds of this process, all its threads; adds the time of its own life to a total.
#pragma once

#include <ctime>

namespace langer {

inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(cpu_seconds()) {}
  ~Stopwatch() { total_ += cpu_seconds() - start_; }

 private:
  double& total_;
  double start_;
};

}  // namespace langer

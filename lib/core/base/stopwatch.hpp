// CPU seconds of this process, all its threads; a stopwatch adds the time of its own life to a
// total. Seconds since the start.
#pragma once

#include <ctime>

namespace langer {

inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// by the clock, since the first call; main calls it first
inline double wall_seconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  static const timespec start = now;
  return static_cast<double>(now.tv_sec - start.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec - start.tv_nsec);
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

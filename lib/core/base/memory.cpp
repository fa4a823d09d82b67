#include "core/base/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace langer {

namespace {
constexpr double nothing = std::numeric_limits<double>::infinity();

// "key:  123 kB" of a /proc file, in bytes
double line_of(const char* file, const std::string& key) {
  std::ifstream in(file);
  for (std::string word; in >> word;)
    if (word == key) {
      double kilobytes = 0;
      if (in >> kilobytes) return 1024 * kilobytes;
      return nothing;
    }
  return nothing;
}

double number_in(const std::string& file) {  // "max" and missing files: no limit
  std::ifstream in(file);
  double value = 0;
  return in >> value ? value : nothing;
}

double group_bytes() {
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("0::", 0) != 0) continue;
    const std::string folder = "/sys/fs/cgroup" + line.substr(3);
    const double limit = number_in(folder + "/memory.max");
    const double used = number_in(folder + "/memory.current");
    if (limit < nothing && used < nothing) return limit - used;
  }
  return nothing;
}
}  // namespace

double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double total = 0, resident = 0;
  if (in >> total >> resident) {
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
  }
  return 0;
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

double free_memory() {
  return std::max(0.0, std::min(line_of("/proc/meminfo", "MemAvailable:"), group_bytes()));
}

double free_address() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return nothing;
  const double taken = line_of("/proc/self/status", "VmSize:");
  if (taken < nothing) {
    return std::max(0.0, static_cast<double>(limit.rlim_cur) - taken);
  }
  return nothing;
}

}  // namespace langer

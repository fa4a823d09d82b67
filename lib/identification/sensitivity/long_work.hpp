// Progress of long work on the terminal: a line for each tenth, once it has taken longer than two
// seconds, with an estimate of the remaining time.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "core/base/say.hpp"

namespace langer {

inline std::function<void(double)> progress_of(const std::string& stage, const std::string& what,
                                               bool quiet) {
  if (quiet) return {};
  const auto start = std::chrono::steady_clock::now();
  int said = 0;
  return [=](double part) mutable {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const int tenths = static_cast<int>(10 * part);
    if (seconds < 2 || tenths <= said || tenths >= 10) return;
    said = tenths;
    say_line("{}: {} {} %, about {:.0f} s more", stage, what, 10 * tenths,
             seconds * (1 - part) / part);
  };
}

}  // namespace langer

// Floating-point traps: a build with LANGER_TRAPS stops at the first invalid operation, division by
// zero or overflow. Calls of other libraries, and the few places of ours that compute first and
// check afterwards, are guarded by a NoTraps. If another library calls us back, Traps sets them
// again. Without LANGER_TRAPS all are empty.
#pragma once

#ifdef LANGER_TRAPS
#include <cfenv>
#endif

namespace langer {

#ifdef LANGER_TRAPS
inline void set_traps() { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }

class NoTraps {
 public:
  NoTraps() { std::feholdexcept(&before_); }
  ~NoTraps() { std::fesetenv(&before_); }  // raised flags are forgotten
  NoTraps(const NoTraps&) = delete;
  NoTraps& operator=(const NoTraps&) = delete;

 private:
  std::fenv_t before_;
};

class Traps {
 public:
  Traps() {
    std::feholdexcept(&before_);
    set_traps();
  }
  ~Traps() { std::fesetenv(&before_); }
  Traps(const Traps&) = delete;
  Traps& operator=(const Traps&) = delete;

 private:
  std::fenv_t before_;
};
#else
inline void set_traps() {}

class NoTraps {
 public:
  NoTraps() {}
  ~NoTraps() {}
  NoTraps(const NoTraps&) = delete;
  NoTraps& operator=(const NoTraps&) = delete;
};

using Traps = NoTraps;
#endif

}  // namespace langer

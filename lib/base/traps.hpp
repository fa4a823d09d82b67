// Floating-point traps: a build with LANGER_TRAPS stops at the first invalid operation, division by zero or overflow.
// Third parties, and the few places of ours that compute first and look afterwards, stand behind a NoTraps.
// Without LANGER_TRAPS both are empty.
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
#else
inline void set_traps() {}

class NoTraps {
 public:
  NoTraps() {}
  ~NoTraps() {}
  NoTraps(const NoTraps&) = delete;
  NoTraps& operator=(const NoTraps&) = delete;
};
#endif

}  // namespace langer

// Signals that ask a program to end: SIGINT (Ctrl-C) and SIGTERM.
// The first is noted, for work that comes to a good place to stop soon; the second (0.2 s later or
// more), or the first where nothing waits for such a place, ends the program at once. Either way
// the exit code is 128 + signal: 130, 143.
#pragma once

#include "core/base/error.hpp"

namespace langer {

// Call once, first of all. Also: a closed pipe and a file beyond the size limit become errors of
// writing, not deaths. silent: another rank speaks
void listen_to_signals(bool silent = false);

// While one of these lives, the first signal waits for interrupted() to be asked.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
};

// While one of these lives as well, nothing would be lost but what was begun last: where the signal
// is not asked for within `seconds`, since a large tangent is analysed or factorized, the program
// ends by itself.
class EndsSoon {
 public:
  static constexpr int seconds = 2;
  explicit EndsSoon(int after = 0);  // 0: either signal
  ~EndsSoon();
  EndsSoon(const EndsSoon&) = delete;
  EndsSoon& operator=(const EndsSoon&) = delete;
};

int interrupted();             // the signal, 0 where none has come
void note_signal(int signal);  // that has come to another rank

Exit exit_code_of(int signal);
const char* signal_name(int signal);  // "SIGINT"

}  // namespace langer

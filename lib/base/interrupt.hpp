// Signals that ask a program to end: SIGINT (Ctrl-C) and SIGTERM.
// The first is noted, for work that comes to a good place to stop soon; the second (0.2 s later or more), or the first where nothing waits for
// such a place, ends the program at once. Either way the exit code is 128 + signal: 130, 143.
#pragma once

#include "base/error.hpp"

namespace langer {

// Call once, first of all. Also: a closed pipe and a file beyond the size limit become errors of writing, not deaths.
void listen_to_signals();

// While one of these lives, the first signal waits for interrupted() to be asked.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
};

int interrupted();  // the signal, 0 where none has come

Exit exit_code_of(int signal);
const char* signal_name(int signal);  // "SIGINT"

}  // namespace langer

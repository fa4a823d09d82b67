// Signals that ask a program to end: SIGINT (Ctrl-C) and SIGTERM.
// While an Interruptible lives, the first signal is only noted: the work stops at its next safe
// place. A second signal (0.2 s later or more) ends the program at once, and so does the first one
// without an Interruptible. In all cases the exit code is 128 + signal: 130 or 143.
#pragma once

#include "core/base/error.hpp"

namespace langer {

// Call once, first of all. Afterwards a closed pipe, and a file beyond the size limit, are errors
// of writing and no longer end the program. silent: another rank writes the messages
void listen_to_signals(bool silent = false);

// While one of these lives, the first signal waits for interrupted() to be asked.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
};

// While one of these lives as well, all finished steps are on the disk. If no part of the program
// asks for the signal within `seconds`, as during the factorization of a large tangent, the program
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

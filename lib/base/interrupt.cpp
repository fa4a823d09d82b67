#include "base/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <ctime>
#include <string>

namespace langer {

namespace {

volatile std::sig_atomic_t signal_seen = 0, places_to_stop = 0;
timespec seen_at;

void on_signal(int signal) {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (signal_seen != 0) {
    // one wish may come twice, from the terminal or scheduler and from make
    const double later =
        static_cast<double>(now.tv_sec - seen_at.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - seen_at.tv_nsec);
    if (later < 0.2) return;
  }
  if (signal_seen != 0 || places_to_stop == 0) {
    const char* words = signal == SIGINT ? "ended by SIGINT\n" : "ended by SIGTERM\n";
    [[maybe_unused]] const ssize_t n = write(2, words, std::char_traits<char>::length(words));
    _exit(128 + signal);
  }
  seen_at = now;
  signal_seen = signal;
}

}  // namespace

void listen_to_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // writing and reading go on
  sigemptyset(&action.sa_mask);
  for (int signal : {SIGINT, SIGTERM}) {
    struct sigaction inherited {};
    // `nohup` and shells in the background have it ignored on purpose
    if (sigaction(signal, nullptr, &inherited) == 0 && inherited.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

Interruptible::Interruptible() { places_to_stop = 1; }

Interruptible::~Interruptible() { places_to_stop = 0; }

int interrupted() { return signal_seen; }

Exit exit_code_of(int signal) { return static_cast<Exit>(128 + signal); }

const char* signal_name(int signal) { return signal == SIGINT ? "SIGINT" : "SIGTERM"; }

}  // namespace langer

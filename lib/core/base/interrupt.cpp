#include "core/base/interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <ctime>
#include <string>

namespace langer {

namespace {

volatile std::sig_atomic_t signal_seen = 0, places_to_stop = 0,
                           patience = 0;  // patience: with which signal it ends
constexpr int any = -1;
timespec seen_at;

bool is_awaited(int signal) { return patience == any || patience == signal; }

bool other_speaks = false;

void say(const char* words) {
  if (!other_speaks) [[maybe_unused]]
    const ssize_t n = write(2, words, std::char_traits<char>::length(words));
}

[[noreturn]] void end_at_once(int signal) {
  say(signal == SIGINT ? "ended by SIGINT\n" : "ended by SIGTERM\n");
  _exit(128 + signal);
}

void on_alarm(int) {
  if (signal_seen != 0) end_at_once(signal_seen);
}

void on_signal(int signal) {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  if (signal_seen != 0) {
    // one wish may come twice, from the terminal or scheduler and from make
    const double later = static_cast<double>(now.tv_sec - seen_at.tv_sec) +
                         1e-9 * static_cast<double>(now.tv_nsec - seen_at.tv_nsec);
    if (later < 0.2) return;
  }
  if (signal_seen != 0 || places_to_stop == 0) end_at_once(signal);
  seen_at = now;
  signal_seen = signal;
  if (is_awaited(signal))
    alarm(EndsSoon::seconds);
  else
    say("\nends after this iteration; a second signal ends at once\n");
}

}  // namespace

void listen_to_signals(bool silent) {
  other_speaks = silent;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // writing and reading go on
  sigemptyset(&action.sa_mask);
  for (int signal : {SIGINT, SIGTERM}) {
    struct sigaction inherited {};
    // `nohup` and shells in the background have it ignored on purpose
    if (sigaction(signal, nullptr, &inherited) == 0 && inherited.sa_handler != SIG_IGN)
      sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

Interruptible::Interruptible() { places_to_stop = 1; }

Interruptible::~Interruptible() { places_to_stop = 0; }

EndsSoon::EndsSoon(int after) {
  patience = after;
  if (after == 0) patience = any;
  std::signal(SIGALRM, on_alarm);
  if (signal_seen != 0 && is_awaited(signal_seen)) alarm(seconds);  // it came just before
}

EndsSoon::~EndsSoon() {
  patience = 0;
  alarm(0);
}

int interrupted() { return signal_seen; }

void note_signal(int signal) {
  if (signal_seen == 0) signal_seen = signal;
}

Exit exit_code_of(int signal) { return static_cast<Exit>(128 + signal); }

const char* signal_name(int signal) {
  if (signal == SIGINT) return "SIGINT";
  return "SIGTERM";
}

}  // namespace langer

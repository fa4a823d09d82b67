// Messages to the user, on stderr. A closed stderr (`2>&1 | head`) does not stop a run. On a
// terminal there may be a status line below the messages, which is rewritten in place; warnings and
// errors are coloured there, unless NO_COLOR is set. All messages also go to the log (--log), and
// with them the details that stderr has with -v only.
#pragma once

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace langer {

namespace said {
inline std::FILE* log = nullptr;
inline bool status = false;  // a status line stands on the terminal
inline bool silent = false;  // another rank speaks
inline std::string unsaid;   // then: what this one said last
}  // namespace said

inline bool on_terminal() {
  static const bool is = [] {
    const char* term = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && term && *term && std::strcmp(term, "dumb") != 0;
  }();
  return is;
}

inline bool in_colour() {
  const char* no = std::getenv("NO_COLOR");
  return on_terminal() && !(no && *no);
}

inline void log_line(const std::string& plain) {
  if (!said::log) return;
  std::fwrite(plain.data(), 1, plain.size(), said::log);
  std::fputc('\n', said::log);
  std::fflush(said::log);
}

// A terminal may show the status line of another program too, as under make -j: its line is cleared
// before anything is written there.
inline void say_raw(const std::string& shown, const std::string& plain) {
  if (said::silent) {
    said::unsaid = plain;
    return;
  }
  const std::string text = (on_terminal() ? "\r\033[K" : "") + shown + "\n";
  said::status = false;
  std::fwrite(text.data(), 1, text.size(), stderr);
  log_line(plain);
}

inline void say_line(const std::string& line) {
  std::size_t warning = std::string::npos;
  if (in_colour()) warning = line.find("warning: ");
  if (warning == std::string::npos) return say_raw(line, line);
  say_raw(line.substr(0, warning) + "\033[33mwarning:\033[0m" + line.substr(warning + 8), line);
}

template <class... Parts>
void say_line(fmt::format_string<Parts...> form, Parts&&... parts) {
  say_line(fmt::format(form, std::forward<Parts>(parts)...));
}

// A line for those who look closely: on stderr with -v, in the log in any case.
inline void detail_line(const std::string& line, bool verbose) {
  if (verbose || said::silent) return say_line(line);
  log_line(line);
}

// why a program ends; the first line in red
inline void say_error(const std::string& lines) {
  if (!in_colour()) return say_raw(lines, lines);
  const std::size_t end = std::min(lines.find('\n'), lines.size());
  say_raw("\033[31m" + lines.substr(0, end) + "\033[0m" + lines.substr(end), lines);
}

// Replaces the status line; does nothing if stderr is no terminal.
inline void say_status(const std::string& line) {
  if (!on_terminal() || said::silent) return;
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  const std::string text = "\r\033[K" + line.substr(0, known ? size.ws_col - 1u : 79u);
  std::fwrite(text.data(), 1, text.size(), stderr);
  said::status = true;
}

// How far a program is. With -v and in the log stands every line, in full. A terminal has the brief
// one in its status line. Any other stderr, such as the log of a batch system, gets a brief line
// every half minute.
inline void progress_line(const std::string& brief, const std::string& full, bool verbose) {
  if (verbose || said::silent) return say_line(full);
  log_line(full);
  if (on_terminal()) return say_status(brief);
  using Clock = std::chrono::steady_clock;
  static Clock::time_point last = Clock::now();
  if (Clock::now() - last < std::chrono::seconds(30)) return;
  last = Clock::now();
  const std::string text = brief + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
}

// A line whose words the log and -v have already, for those who see neither.
inline void brief_line(const std::string& line, bool verbose) {
  if (verbose || said::silent) return;
  std::FILE* const log = said::log;
  said::log = nullptr;
  say_line(line);
  said::log = log;
}

}  // namespace langer

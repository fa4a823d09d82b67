// Messages to the user, on stderr. A closed stderr (`2>&1 | head`) does not stop a run. On a
// terminal there may be a status line below the messages, which is rewritten in place; warnings and
// errors are coloured there, unless NO_COLOR is set. All messages also go to the log (--log).
#pragma once

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
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

inline void say_raw(const std::string& shown, const std::string& plain) {
  if (said::silent) {
    said::unsaid = plain;
    return;
  }
  const std::string text = (said::status ? "\r\033[K" : "") + shown + "\n";
  said::status = false;
  std::fwrite(text.data(), 1, text.size(), stderr);
  if (said::log) {
    std::fwrite(plain.data(), 1, plain.size(), said::log);
    std::fputc('\n', said::log);
    std::fflush(said::log);
  }
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

}  // namespace langer

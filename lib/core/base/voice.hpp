// What a program says on stderr while it works:
//   say      results and what changes them: unless --quiet
//   detail   sizes, choices, every step: with -v; the log (--log) has it in any case
//   warn     always
#pragma once

#include <string>

#include <fmt/format.h>

#include "core/base/say.hpp"

namespace langer {

struct Voice {
  std::string who;  // stage
  bool quiet = false;
  bool verbose = false;

  template <class... Parts>
  void say(fmt::format_string<Parts...> form, Parts&&... parts) const {
    if (!quiet) say_line("{}: {}", who, fmt::format(form, std::forward<Parts>(parts)...));
  }
  template <class... Parts>
  void detail(fmt::format_string<Parts...> form, Parts&&... parts) const {
    if (quiet) return;
    const std::string line = fmt::format(form, std::forward<Parts>(parts)...);
    detail_line(fmt::format("{}: {}", who, line), verbose);
  }
  // How far a run is; the log has every line.
  void progress(const std::string& words) const {
    if (quiet) return;
    const std::string line = fmt::format("{}: {}", who, words);
    progress_line(line, line, verbose);
  }
  // A result among the details, shown where those are not.
  void brief(const std::string& words) const {
    if (!quiet) brief_line(fmt::format("{}: {}", who, words), verbose);
  }
  void warn(const std::string& words) const { say_line("{}: warning: {}", who, words); }
};

}  // namespace langer

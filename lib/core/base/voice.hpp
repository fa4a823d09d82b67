// What a program says on stderr while it works: words unless --quiet, warnings always.
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
  void warn(const std::string& words) const { say_line("{}: warning: {}", who, words); }
};

}  // namespace langer

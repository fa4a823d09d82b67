// Words to the person who waits, on stderr. That nobody reads any more (`2>&1 | head`) is no reason to stop working.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace langer {

inline void say_line(const std::string& line) {
  const std::string text = line + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
}

template <class... Parts>
void say_line(fmt::format_string<Parts...> form, Parts&&... parts) {
  say_line(fmt::format(form, std::forward<Parts>(parts)...));
}

}  // namespace langer

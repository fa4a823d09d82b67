// What every fuzz target asks: a reader reads, or refuses by a Failure that names its file; it
// never does anything else.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/base/error.hpp"

namespace langer::fuzz {

inline void reads_or_refuses(const std::string& file, auto&& read) {
  try {
    read();
  } catch (const Failure& failure) {
    bool named = !failure.errors().empty() &&
                 (failure.code() == Exit::config || failure.code() == Exit::input);
    for (const Error& e : failure.errors())
      named = named && e.where.file.find(file) != std::string::npos && text(e) != "";
    if (named) return;
    std::fprintf(stderr, "a refusal without its file, or a bug: %s\n", failure.what());
    std::abort();
  }
}

}  // namespace langer::fuzz

// How reading or writing a file is refused.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <string>

#include "core/base/error.hpp"

namespace langer::example {

// the message with which it ends; "" where it succeeds
inline std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    return failure.what();
  }
  return "";
}

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace langer::example

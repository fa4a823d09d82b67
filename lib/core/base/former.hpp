// Former names of keys and words of configs: old files are still read, and a notice gives the new
// name.
//   v(&Fit::cross_check, "cross_check", unit::none, "...", Formerly{"check"});          a key
//   constexpr auto former_names(Kind) { return std::array{FormerWord{"rung", "refinement"}}; }   a word of an enum, next to names()
#pragma once

namespace langer {

struct Formerly {
  const char* key;
};

struct FormerWord {
  const char *was, *is;
};

}  // namespace langer

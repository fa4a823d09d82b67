// Words for config listings. A config struct is public members with defaults plus one listing:
//
//   struct Yeoh {
//     static constexpr const char* key = "yeoh";            // its name where it is one of several (std::variant)
//     double a1 = 0, a2 = 0, a3 = 0;
//     static void fields(auto& v) {
//       v(&Yeoh::a1, "a1", unit::MPa, "half the initial shear modulus of the matrix", required);
//       v(&Yeoh::a2, "a2", unit::MPa, "second coefficient");
//     }
//   };
//
// The same listing reads, checks, echoes the effective config, prints --describe and feeds the
// hash. A key without `required` may be left out; the member's initial value is then its default.
// A struct may add `std::vector<Complaint> complaints() const` for rules between keys.
// Member types: bool, int, double, std::string, InputPath, enum (with names()), nested struct with
// a listing, std::optional, std::vector, std::array<T, N>, std::map<std::string, T> (named things),
// std::variant<A, B> (a map with exactly one key, the alternative's `key`),
// std::vector<std::variant<A, B>> (a sum: a map with one or more such keys, or a list of one-key
// maps). An enum lists its words:  constexpr auto names(Formulation) { return
// std::array{"displacement", "mean_dilatation"}; }
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace langer {

namespace unit {
inline constexpr const char* none = "-";
inline constexpr const char* mm = "mm";
inline constexpr const char* N = "N";
inline constexpr const char* MPa = "MPa";
inline constexpr const char* per_MPa = "1/MPa";
inline constexpr const char* deg = "deg";
inline constexpr const char* s = "s";
}  // namespace unit

// instead of a key, for a std::variant: the one key of its alternative stands among the keys of the
// struct
inline constexpr const char* among_keys = "";

struct Required {};
inline constexpr Required required{};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true, high_included = true;
};
inline constexpr Range positive{0, std::numeric_limits<double>::infinity(), false, true};
constexpr Range at_least(double low) {
  return {low, std::numeric_limits<double>::infinity(), true, true};
}
constexpr Range between(double low, double high) { return {low, high, true, true}; }

// allowed words of a std::string member
struct OneOf {
  std::vector<std::string> words;
};
template <class... Words>
OneOf one_of(Words... words) {
  return {{words...}};
}

// an extra line printed under an error about this key
struct Hint {
  const char* text;
};

struct Complaint {
  std::string key, found, expected, hint;
};

}  // namespace langer

// A config with a member of every kind, for tests of reading and writing.
#pragma once

#include <map>
#include <optional>
#include <variant>

#include "core/base/fields.hpp"
#include "core/base/input_path.hpp"

namespace langer::sample {

enum class Colour { red, green };
constexpr auto names(Colour) { return std::array{"red", "green"}; }

struct Linear {
  static constexpr const char* key = "linear";
  double slope = 0;
  static void fields(auto& v) { v(&Linear::slope, "slope", unit::MPa, "slope", required); }
  bool operator==(const Linear&) const = default;
};

struct Power {
  static constexpr const char* key = "power";
  double factor = 1;
  int exponent = 2;
  static void fields(auto& v) {
    v(&Power::factor, "factor", unit::MPa, "factor");
    v(&Power::exponent, "exponent", unit::none, "exponent", between(1, 9));
  }
  bool operator==(const Power&) const = default;
};

struct Part {
  double from = 0, to = 1;
  static void fields(auto& v) {
    v(&Part::from, "from", unit::mm, "begin");
    v(&Part::to, "to", unit::mm, "end", required);
  }
  std::vector<Complaint> complaints() const {
    if (from < to) return {};
    return {{"to", "an end before the begin", "to > from", ""}};
  }
  bool operator==(const Part&) const = default;
};

struct Sample {
  bool flag = false;
  int count = 3;
  double length = 1.5;
  std::string title = "none", choice = "a";
  Colour colour = Colour::green;
  Part part;
  std::optional<double> friction;
  std::optional<Part> second;
  std::vector<double> values;
  std::vector<Part> parts;
  std::array<double, 3> point{};
  std::map<std::string, Part> named;
  std::variant<Linear, Power> law;
  std::vector<std::variant<Linear, Power>> sum;
  InputPath curve;
  double fraction = 0.5;
  static void fields(auto& v) {
    v(&Sample::flag, "flag", unit::none, "a flag");
    v(&Sample::count, "count", unit::none, "a count", at_least(1));
    v(&Sample::length, "length", unit::mm, "a length", positive, Hint{"30 in the paper"});
    v(&Sample::title, "title", unit::none, "a text");
    v(&Sample::choice, "choice", unit::none, "a word", one_of("a", "b"));
    v(&Sample::colour, "colour", unit::none, "a colour");
    v(&Sample::part, "part", unit::none, "a part", required);
    v(&Sample::friction, "friction", unit::none, "an optional number", at_least(0));
    v(&Sample::second, "second", unit::none, "an optional part");
    v(&Sample::values, "values", unit::MPa, "a list of numbers", at_least(0));
    v(&Sample::parts, "parts", unit::none, "a list of parts");
    v(&Sample::point, "point", unit::mm, "a point");
    v(&Sample::named, "named", unit::none, "named parts");
    v(&Sample::law, "law", unit::none, "one law");
    v(&Sample::sum, "sum", unit::none, "several laws");
    v(&Sample::curve, "curve", unit::none, "a file");
    v(&Sample::fraction, "fraction", unit::none, "a fraction", positive, between(0, 1));
  }
};

}  // namespace langer::sample

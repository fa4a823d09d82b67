#include "core/config/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <tuple>

#include "core/base/text.hpp"

namespace langer {

namespace {

// YAML 1.1 reads 010 as an octal number: such texts are refused rather than read either way.
bool has_leading_zero(std::string_view digits) {
  if (!digits.empty() && (digits[0] == '-' || digits[0] == '+')) digits.remove_prefix(1);
  return digits.size() > 1 && digits[0] == '0' && digits[1] >= '0' && digits[1] <= '9';
}

// std::from_chars does not accept a leading plus.
std::string_view without_plus(const Tree& tree) {
  std::string_view s = tree.scalar;
  if (s.size() > 1 && s[0] == '+' && s[1] != '-') s.remove_prefix(1);
  return s;
}

// The usual reasons why a text is not a number: quotes, a leading zero, a decimal comma, a unit.
std::string number_hint(const Tree& tree, const Member& m) {
  const std::string& s = tree.scalar;
  if (tree.quoted) return "write numbers without quotes";
  const bool digit = !s.empty() && ((s[0] >= '0' && s[0] <= '9') || s[0] == '-' || s[0] == '.');
  if (digit && has_leading_zero(s)) return "leave out the leading zero";
  if (digit && s.find(',') != std::string::npos)
    return "a decimal comma: the decimal sign is a point, as in 2.5";
  if (digit && s.find(' ') != std::string::npos && std::string(m.unit) != unit::none)
    return fmt::format("a plain number; the unit is always {}", m.unit);
  return m.hint;
}

bool within(double x, const Range& r) {
  const bool above = x > r.low || (r.low_included && x == r.low);
  const bool below = x < r.high || (r.high_included && x == r.high);
  return above && below;
}

}  // namespace

std::string list_words(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string number_words(const Member& m, bool whole) {
  std::string s = whole ? "a whole number" : "a number";
  const Range& r = m.range;
  const bool low = std::isfinite(r.low);
  const bool high = std::isfinite(r.high);
  if (low) s += fmt::format(" {} {}", r.low_included ? ">=" : ">", r.low);
  if (low && high) s += " and";
  if (high) s += fmt::format(" {} {}", r.high_included ? "<=" : "<", r.high);
  if (std::string(m.unit) != unit::none) s += fmt::format(" in {}", m.unit);
  return s;
}

// A multiple of 15 degrees in radians, with three digits or more.
static bool looks_like_radians(double x) {
  if (std::abs(x) > 6.5) return false;  // more than a full turn
  const double parts = std::abs(x) * 12 / std::numbers::pi;
  const double whole = std::round(parts);
  return whole >= 1 && std::abs(parts - whole) < 6e-4 * whole;
}

// Limits for lengths, which are positive, and for positions, both in mm: squares and ratios of
// values within them neither overflow nor underflow.
static bool is_length(double x, const Member& m) {
  const bool positive_only = m.range.low == 0 && !m.range.low_included;
  return std::abs(x) <= 1e9 && (!positive_only || x >= 1e-9);
}

void read_leaf(const Tree& tree, const std::string& path, const Member& m, bool& out, Findings& f) {
  if (tree.kind == Tree::Kind::scalar && !tree.quoted &&
      (tree.scalar == "true" || tree.scalar == "false"))
    out = tree.scalar == "true";
  else
    f.say(tree.place, path, "found " + description(tree), "true or false", m.hint);
}

void read_leaf(const Tree& tree, const std::string& path, const Member& m, double& out,
               Findings& f) {
  const auto wrong = [&](const std::string& hint) {
    f.say(tree.place, path, "found " + description(tree), number_words(m, false), hint);
  };
  if (tree.kind != Tree::Kind::scalar) return wrong(m.hint);
  const std::string_view s = without_plus(tree);
  double x = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  if (error == std::errc::result_out_of_range) return wrong("too large or too small for a double");
  if (tree.quoted || error != std::errc{} || end != s.data() + s.size() || has_leading_zero(s))
    return wrong(number_hint(tree, m));
  if (!std::isfinite(x)) return wrong("numbers must be finite");
  if (!within(x, m.range)) return wrong(m.hint);
  if (std::string_view(m.unit) == unit::mm && !is_length(x, m))
    return wrong("lengths and positions are at most 1e9 mm, lengths at least 1e-9 mm");
  if (std::string_view(m.unit) == unit::deg && looks_like_radians(x))
    f.notices.push_back(text(Error{
        tree.place, path, fmt::format("found {:g}, read as degrees", x), "an angle in degrees",
        fmt::format("if it is in radians: {:.5g} degrees", x * 180 / std::numbers::pi)}));
  out = x;
}

void read_history(const Tree& tree, const std::string& path, const Member& m, HistoryConfig& out,
                  Findings& f) {
  out = {};
  if (tree.kind == Tree::Kind::scalar) return read_leaf(tree, path, m, out.value, f);
  if (tree.kind != Tree::Kind::list)
    return f.say(tree.place, path, "found " + description(tree), type_words<HistoryConfig>(m),
                 m.hint);
  const std::size_t before = f.errors.size();
  read_items(tree, path, m, out.points, f);
  if (f.errors.size() > before) return;
  for (const Complaint& c : place_complaints(out.points, "", "{t: 1, to: ...}"))
    f.say(tree.place, path, c.found, c.expected, c.hint);
  // each value of the list obeys the range of the key, as a single number does
  for (std::size_t i = 0; i < out.points.size(); ++i)
    if (const Tree* to = tree.list[i].find("to"))
      read_leaf(*to, join(item(path, i), "to"), m, out.points[i].to, f);
}

long long read_whole(const Tree& tree, const std::string& path, const Member& m, long long low,
                     long long high, Findings& f) {
  const auto wrong = [&](const std::string& hint) {
    f.say(tree.place, path, "found " + description(tree), number_words(m, true), hint);
    return 0LL;
  };
  if (tree.kind != Tree::Kind::scalar) return wrong(m.hint);
  const std::string_view s = without_plus(tree);
  long long x = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  if (error == std::errc::result_out_of_range) return wrong("too large for a whole number");
  if (tree.quoted || error != std::errc{} || end != s.data() + s.size() || has_leading_zero(s))
    return wrong(number_hint(tree, m));
  if (!within(static_cast<double>(x), m.range)) return wrong(m.hint);
  if (x < low || x > high) return wrong("too large for a whole number");
  return x;
}

int read_word(const Tree& tree, const std::string& path, const Member& m,
              const std::vector<std::string>& words, Findings& f,
              const std::vector<FormerWord>& former) {
  if (tree.kind == Tree::Kind::scalar) {
    std::string word = tree.scalar;
    for (const FormerWord& name : former)
      if (word == name.was) {
        f.notice(tree.place, path, name.was, name.is);
        word = name.is;
      }
    if (const auto it = std::find(words.begin(), words.end(), word); it != words.end())
      return static_cast<int>(it - words.begin());
  }
  std::string hint = m.hint;
  if (tree.kind == Tree::Kind::scalar)
    if (const std::string near = nearest(tree.scalar, words); !near.empty())
      hint = did_you_mean(near);
  f.say(tree.place, path, "found " + description(tree), "one of " + list_words(words), hint);
  return -1;
}

void read_leaf(const Tree& tree, const std::string& path, const Member& m, std::string& out,
               Findings& f) {
  if (!m.words.empty()) {
    if (const int i = read_word(tree, path, m, m.words, f); i >= 0)
      out = m.words[static_cast<std::size_t>(i)];
  } else if (tree.kind == Tree::Kind::scalar)
    out = tree.scalar;
  else
    f.say(tree.place, path, "found " + description(tree), "a text", m.hint);
}

void read_leaf(const Tree& tree, const std::string& path, const Member& m, InputPath& out,
               Findings& f) {
  if (tree.kind == Tree::Kind::scalar && !tree.scalar.empty())
    out.path = (std::filesystem::path(tree.base) / tree.scalar).lexically_normal().string();
  else
    f.say(tree.place, path, "found " + description(tree),
          "the path of a file, relative to this one", m.hint);
}

void report_unknown_key(const Tree::Entry& entry, const std::string& path,
                        const std::vector<std::string>& known, Findings& f) {
  // `radius: 2,5` in braces is the key `radius` with 2, and a key `5` without a value
  const bool digits =
      !entry.key.empty() &&
      std::all_of(entry.key.begin(), entry.key.end(), [](char c) { return c >= '0' && c <= '9'; });
  const bool empty = entry.value.kind == Tree::Kind::null ||
                     (entry.value.kind == Tree::Kind::scalar && entry.value.scalar.empty());
  if (digits && empty)
    return f.say(entry.value.place, path,
                 fmt::format("found \",{}\" behind a number: a decimal comma", entry.key),
                 "a decimal point, as in 2.5");
  const std::string near = nearest(entry.key, known);
  std::string found = fmt::format("unknown key \"{}\"; known: {}", entry.key, list_words(known));
  if (!near.empty()) found += "; " + did_you_mean(near);
  f.say(entry.value.place, path, found);
}

namespace {

// Which of several files a value comes from: 0 is the file itself, 1 a file that it includes, and
// so on; -1 is a value set after reading (--set, a sweep), which overrides all files.
int layer_of(const Tree& tree) {
  if (tree.set_later) return -1;
  return std::countr_zero(tree.layers);
}

}  // namespace

const Tree* find_member(const Tree& tree, const std::string& path, const Member& m, Findings& f) {
  const Tree* given = tree.find(m.key);
  const Tree* old = nullptr;
  if (*m.former) old = tree.find(m.former);
  if (!old) return given;
  if (given && layer_of(*given) == layer_of(*old)) {
    f.say(old->place, join(path, m.former),
          fmt::format("found together with {}, its new name", m.key), "one of the two");
    return given;
  }
  f.notice(old->place, path, m.former, m.key);
  if (given && layer_of(*given) < layer_of(*old)) return given;
  return old;
}

Tree part_of(const Tree& tree, const std::vector<std::string>& keys) {
  Tree part;
  part.kind = Tree::Kind::map;
  part.place = tree.place;
  part.base = tree.base;
  part.layers = tree.layers;
  for (const Tree::Entry& entry : tree.map)
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) part.map.push_back(entry);
  return part;
}

Tree as_entry(const char* key, const Tree& value) {
  Tree map;
  map.kind = Tree::Kind::map;
  map.place = value.place;
  map.base = value.base;
  map.layers = value.layers;
  map.map.push_back({key, value});
  return map;
}

std::vector<const Tree::Entry*> chosen(const Tree& tree, const std::string& path, bool is_sum,
                                       Findings& f) {
  using Entries = std::vector<const Tree::Entry*>;
  const auto those = [&](auto&& hold) {
    Entries found;
    for (const Tree::Entry& entry : tree.map)
      if (hold(entry.value)) found.push_back(&entry);
    return found;
  };
  const auto words = [](const Entries& entries) {
    std::vector<std::string> keys;
    for (const Tree::Entry* e : entries) keys.push_back(e->key);
    return list_words(keys);
  };
  const Entries later = those(std::mem_fn(&Tree::set_later));
  if (!later.empty() && later.size() < tree.map.size()) {
    const Entries there = those([](const Tree& t) { return !t.set_later; });
    f.say(later[0]->value.place, path, fmt::format("{} added to {}", words(later), words(there)),
          "a value of the alternative that is there",
          fmt::format("to replace it: --set '{}={{{}: {{...}}}}'", path, later[0]->key));
    return {};
  }
  std::uint64_t used = 0;
  for (const Tree::Entry& entry : tree.map) used |= entry.value.layers;
  const int top = std::countr_zero(used);
  const auto of_layer = [&](int layer) {
    return those([&](const Tree& t) { return layer < 64 && t.layers >> layer & 1; });
  };
  const Entries over = used ? of_layer(top) : those([](const Tree&) { return true; });
  for (int layer = top + 1; layer < 64; ++layer) {
    const Entries under = of_layer(layer);
    if (under.empty() || under == over) continue;
    const bool others = std::none_of(
        over.begin(), over.end(), [&](const Tree::Entry* e) { return e->value.layers >> layer; });
    if (others) break;
    std::string hint = "leave this key out of the included file";
    if (is_sum)
      hint = fmt::format("a list replaces what is included: [{{{}: {{...}}}}]", over[0]->key);
    f.say(tree.place, path,
          fmt::format("found {} together with an included {}", words(over), words(under)),
          "the alternatives that are included, with other numbers, or only others, which replace "
          "them",
          hint);
    return {};
  }
  return over;
}

void throw_sorted(std::vector<Error> errors) {
  std::stable_sort(errors.begin(), errors.end(), [](const Error& a, const Error& b) {
    return std::tie(a.where.file, a.where.line, a.where.column) <
           std::tie(b.where.file, b.where.line, b.where.column);
  });
  throw Failure(Exit::config, std::move(errors));
}

// Names may be parts of file names, of HDF5 paths and of paths of keys.
bool is_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '+' || c == '-';
  });
}

std::string join(const std::string& path, const std::string& key) {
  if (path.empty()) return key;
  return path + "." + key;
}
std::string item(const std::string& path, std::size_t index) {
  return fmt::format("{}[{}]", path, index);
}

}  // namespace langer

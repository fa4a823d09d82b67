// Writes and reads a struct with a listing (base/fields.hpp) as nested groups of a file, in the
// same way as its YAML nests:
//   numbers and switches   scalar datasets with `unit` (bool as 0 or 1)
//   words and enums        strings
//   structs                groups; of a variant the group of the chosen alternative
//   lists                  groups 0, 1, ...
//   empty optionals        left out
// Reading refuses a value that is missing, not finite or out of the range of its listing, and a
// word that the listing does not know.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "core/config/member.hpp"
#include "core/hdf5/h5.hpp"
#include "core/hdf5/unit_attribute.hpp"

namespace langer {

template <Listed T>
void write_listing(const h5::Group& group, const T& object);
template <Listed T>
void read_listing(const h5::Group& group, T& object);

// The group of a variant's alternatives. Their keys may be among the keys of the struct itself.
template <class V>
h5::Group choice_group(const Member& m, const h5::Group& group, const std::string& name,
                       bool make) {
  if (is_among_keys<V>(m)) return group;
  if (make) return group.make_group(name);
  return group.group(name);
}

// Writes one member of a struct, by its type.
template <class V>
void write_member(const h5::Group& group, const Member& m, const std::string& name,
                  const V& value) {
  if constexpr (std::is_arithmetic_v<V>)
    group.write_scalar(name, static_cast<double>(value), m.unit);
  else if constexpr (std::is_same_v<V, std::string>)
    group.write_text(name, value);
  else if constexpr (Named<V>)
    group.write_text(name, words_of<V>()[static_cast<std::size_t>(value)]);
  else if constexpr (is_optional<V>) {
    if (value) write_member(group, m, name, *value);
  } else if constexpr (is_choice<V>) {
    const h5::Group choice = choice_group<V>(m, group, name, true);
    std::visit(
        [&](const auto& a) {
          write_listing(choice.make_group(std::remove_cvref_t<decltype(a)>::key), a);
        },
        value);
  } else if constexpr (is_vector<V>) {
    const h5::Group list = group.make_group(name);
    for (std::size_t i = 0; i < value.size(); ++i)
      write_member(list, m, std::to_string(i), value[i]);
  } else
    write_listing(group.make_group(name), value);
}

// Whether a number is finite and in a range, whose ends belong to it or not.
inline bool is_in(const Range& r, double x) {
  if (!std::isfinite(x) || x < r.low || x > r.high) return false;
  if (x == r.low && !r.low_included) return false;
  return x != r.high || r.high_included;
}

// Reads one member of a struct, by its type.
template <class V>
void read_member(const h5::Group& group, const Member& m, const std::string& name, V& value) {
  if constexpr (std::is_arithmetic_v<V>) {
    const double x = group.read_scalar(name);
    require_unit(group, name, m.unit);
    if (!is_in(m.range, x)) group.refuse(name, std::to_string(x), type_words<V>(m));
    value = static_cast<V>(x);
  } else if constexpr (std::is_same_v<V, std::string>)
    value = group.read_text(name);
  else if constexpr (Named<V>) {
    const auto words = words_of<V>();
    const std::string word = group.read_text(name);
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) group.refuse(name, "\"" + word + "\"", type_words<V>(m));
    value = static_cast<V>(found - words.begin());
  } else if constexpr (is_optional<V>) {
    value.reset();
    if (group.has(name)) read_member(group, m, name, value.emplace());
  } else if constexpr (is_choice<V>) {
    const h5::Group choice = choice_group<V>(m, group, name, false);
    bool found = false;
    for_each_alternative<V>([&](auto alternative) {
      if (found || !choice.has(decltype(alternative)::key)) return;
      read_listing(choice.group(decltype(alternative)::key), alternative);
      value = alternative;
      found = true;
    });
    if (!found) group.refuse(name, "no known alternative", type_words<V>(m));
  } else if constexpr (is_vector<V>) {
    const h5::Group list = group.group(name);
    value.clear();
    for (std::size_t i = 0; list.has(std::to_string(i)); ++i)
      read_member(list, m, std::to_string(i), value.emplace_back());
  } else
    read_listing(group.group(name), value);
}

template <Listed T>
void write_listing(const h5::Group& group, const T& object) {
  for_each_line(object,
                [&](const Member& m, const auto& value) { write_member(group, m, m.key, value); });
}

template <Listed T>
void read_listing(const h5::Group& group, T& object) {
  for_each_line(object, [&](const Member& m, auto& value) { read_member(group, m, m.key, value); });
}

}  // namespace langer

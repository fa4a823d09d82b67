// One line of a config listing (base/fields.hpp) as a value, and the kinds of member types that a
// listing may name.
#pragma once

#include <array>
#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/fields.hpp"
#include "core/base/former.hpp"
#include "core/base/history.hpp"
#include "core/base/input_path.hpp"
#include "core/base/search_bounds.hpp"

namespace langer {

struct Member {
  const char* key = "";
  const char* unit = unit::none;
  const char* doc = "";
  bool required = false;
  Range range;
  std::vector<std::string> words;
  const char* hint = "";
  const char* former = "";  // its key in old files
  std::optional<SearchBounds> search;
  const char* sign_of = "";

  void add(Required) { required = true; }
  // of several ranges, their intersection
  void add(const Range& r) {
    if (r.low > range.low || (r.low == range.low && !r.low_included)) {
      range.low = r.low;
      range.low_included = r.low_included;
    }
    if (r.high < range.high || (r.high == range.high && !r.high_included)) {
      range.high = r.high;
      range.high_included = r.high_included;
    }
  }
  void add(const OneOf& one) { words = one.words; }
  void add(const Hint& h) { hint = h.text; }
  void add(const Formerly& f) { former = f.key; }
  void add(const SearchBounds& bounds) { search = bounds; }
  void add(const SignOf& other) { sign_of = other.key; }
};

Member member(const char* key, const char* unit, const char* doc, const auto&... extras) {
  Member m{key, unit, doc, false, {}, {}, ""};
  (m.add(extras), ...);
  return m;
}

// Visits the listing of a struct: on(Member, value) for each line.
template <class Object, class On>
struct Lines {
  Object& object;
  On& on;
  void operator()(auto pointer, const char* key, const char* unit, const char* doc,
                  const auto&... extras) {
    on(member(key, unit, doc, extras...), object.*pointer);
  }
};
template <class Object>
void for_each_line(Object& object, auto&& on) {
  Lines<Object, std::remove_reference_t<decltype(on)>> lines{object, on};
  std::remove_const_t<Object>::fields(lines);
}

struct AnyLine {
  void operator()(auto&&...) {}
};
// a struct with a listing
template <class T>
concept Listed = requires(AnyLine& v) {
  T::fields(v);
};

// an enum with names()
template <class T>
concept Named = std::is_enum_v<T> && requires(T e) {
  names(e).size();
};

// a struct with a short form: a scalar is the value of one of its keys, the others have defaults
template <class T>
concept Shortened = Listed<T> && requires {
  { T::short_key } -> std::convertible_to<const char*>;
};

// a struct that a list may stand for: the value of one of its keys
template <class T>
concept ShortenedList = Listed<T> && requires {
  { T::list_key } -> std::convertible_to<const char*>;
};

// a struct with rules between its keys
template <class T>
concept Complaining = requires(const T& t) {
  { t.complaints() } -> std::same_as<std::vector<Complaint>>;
};

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <class T>
inline constexpr bool is_vector = false;
template <class T>
inline constexpr bool is_vector<std::vector<T>> = true;
template <class T>
inline constexpr bool is_array = false;
template <class T, std::size_t n>
inline constexpr bool is_array<std::array<T, n>> = true;
template <class T>
inline constexpr bool is_named_things = false;
template <class T>
inline constexpr bool is_named_things<std::map<std::string, T>> = true;
template <class T>
inline constexpr bool is_choice = false;  // one of several structs
template <class... T>
inline constexpr bool is_choice<std::variant<T...>> = true;
template <class T>
inline constexpr bool is_sum = false;  // several such choices
template <class... T>
inline constexpr bool is_sum<std::vector<std::variant<T...>>> = true;

template <class T>
inline constexpr bool is_history =
    std::is_same_v<T, HistoryConfig>;  // a number, or a list of points

template <class T>
inline constexpr bool is_whole_number = std::is_integral_v<T> && !std::is_same_v<T, bool>;
template <class T>
inline constexpr bool is_leaf = std::is_arithmetic_v<T> || std::is_enum_v<T> ||
                                std::is_same_v<T, std::string> || std::is_same_v<T, InputPath>;

// calls on(alternative) with a default value of each alternative of a std::variant
template <class Choice>
void for_each_alternative(auto&& on) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (on(std::variant_alternative_t<i, Choice>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Choice>>{});
}
template <class Choice>
std::vector<std::string> alternatives() {
  std::vector<std::string> words;
  for_each_alternative<Choice>(
      [&](const auto& a) { words.push_back(std::remove_cvref_t<decltype(a)>::key); });
  return words;
}

// the key of the alternative is one of the keys of the struct (among_keys in base/fields.hpp)
template <class V>
bool is_among_keys(const Member& m) {
  return is_choice<V> && !*m.key;
}

// keys of a listing, in order
template <Listed T>
std::vector<std::string> keys_of() {
  std::vector<std::string> keys;
  T object{};
  for_each_line(object, [&](const Member& m, const auto& value) {
    if constexpr (is_choice<std::remove_cvref_t<decltype(value)>>)
      if (is_among_keys<std::remove_cvref_t<decltype(value)>>(m))
        for (const std::string& key : alternatives<std::remove_cvref_t<decltype(value)>>())
          keys.push_back(key);
    if (*m.key) keys.push_back(m.key);
  });
  return keys;
}

template <Named E>
std::vector<std::string> words_of() {
  const auto list = names(E{});
  return {list.begin(), list.end()};
}

// words that an enum had under other names; empty where none was renamed
template <Named E>
std::vector<FormerWord> former_words_of() {
  if constexpr (requires { former_names(E{}); }) {
    const auto list = former_names(E{});
    return {list.begin(), list.end()};
  } else
    return {};
}

// How a message or the reference names what a member may hold, e.g. "a number > 0 in MPa", "one of
// a, b".
std::string number_words(const Member& m, bool whole);
std::string list_words(const std::vector<std::string>& words);  // "a, b, c"

template <class T>
std::string type_words(const Member& m) {
  if constexpr (is_optional<T>)
    return type_words<typename T::value_type>(m);
  else if constexpr (std::is_same_v<T, bool>)
    return "true or false";
  else if constexpr (is_whole_number<T> || std::is_floating_point_v<T>)
    return number_words(m, is_whole_number<T>);
  else if constexpr (is_history<T>)
    return number_words(m, false) + ", or a list of {t, to}";
  else if constexpr (Named<T>)
    return "one of " + list_words(words_of<T>());
  else if constexpr (std::is_same_v<T, std::string>) {
    if (m.words.empty()) return "a text";
    return "one of " + list_words(m.words);
  } else if constexpr (std::is_same_v<T, InputPath>)
    return "the path of a file, relative to this one";
  else if constexpr (is_choice<T>)
    return "a map with exactly one of the keys " + list_words(alternatives<T>());
  else if constexpr (is_sum<T>)
    return "a map with one or more of the keys " +
           list_words(alternatives<typename T::value_type>());
  else if constexpr (is_vector<T>)
    return "a list; each item " + type_words<typename T::value_type>(m);
  else if constexpr (is_array<T>)
    return "a list of " + std::to_string(std::tuple_size_v<T>) + "; each item " +
           type_words<typename T::value_type>(m);
  else if constexpr (is_named_things<T>)
    return "a map of names; each value " + type_words<typename T::mapped_type>(m);
  else {
    static_assert(Listed<T>, "base/fields.hpp lists the types of members; this is none of them");
    std::string words = "a map with the keys " + list_words(keys_of<T>());
    if constexpr (Shortened<T>)
      words = std::string("the value of ") + T::short_key + ", or " + words;
    if constexpr (ShortenedList<T>)
      words = std::string("the list of ") + T::list_key + ", or " + words;
    return words;
  }
}

}  // namespace langer

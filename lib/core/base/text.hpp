// Small helpers for messages and lists of words.
#pragma once

#include <string>
#include <string_view>

namespace langer {

// Appends an item to a list in words: the separator comes only between items.
inline void append(std::string& list, std::string_view separator, std::string_view item) {
  if (!list.empty()) list += separator;
  list += item;
}

// The hint for a misspelt name: nothing if no known name is close to it.
inline std::string did_you_mean(std::string_view close_name) {
  if (close_name.empty()) return "";
  return "did you mean \"" + std::string(close_name) + "\"?";
}

// The text, or the alternative if it is empty.
inline std::string text_or(std::string text, std::string_view alternative) {
  if (text.empty()) return std::string(alternative);
  return text;
}

// The ending of a counted noun: "1 element", "2 elements".
template <class Number>
std::string_view plural_s(Number n) {
  if (n == 1) return "";
  return "s";
}

// The value of a key, or the alternative if the map does not have it.
template <class Map>
typename Map::mapped_type value_or(const Map& map, const typename Map::key_type& key,
                                   typename Map::mapped_type alternative) {
  const auto found = map.find(key);
  if (found == map.end()) return alternative;
  return found->second;
}

}  // namespace langer

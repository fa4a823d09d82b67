// Config struct -> canonical YAML text (every key, defaults filled in; equal structs give equal
// text), and --describe. Keys are in the order of the listing, absent optional keys and files are
// left out, numbers are the shortest that read back the same.
//
//   std::string effective = to_yaml(config);
//   std::string reference = describe<SolveConfig>();     // key, type, unit, default, range, meaning
//
// Input paths are written as they are held, or rewritten by the function given with the config.
#pragma once

#include <functional>

#include "core/config/member.hpp"
#include "core/config/tree.hpp"

namespace langer {

using PathText = std::function<std::string(const std::string& path)>;
std::string as_held(const std::string& path);
std::string file_name(const std::string& path);  // without folders: the same in every place
std::string relative_path(const std::string& path,
                          const std::string& folder);  // symbolic links are followed
PathText relative_to(const std::string& folder);       // as seen from a file in that folder

std::string to_text(const Tree& tree);  // block YAML; lists of scalars in one line
std::string number_text(double x);      // shortest text that reads back the same; never "-0"
Tree text_tree(const std::string& s);   // a text, quoted where it could be read as something else
Tree plain_tree(const std::string& s);  // a number, a bool or a word

// Dispatches on the type of the member, as read_value of config/reader.hpp does.
template <class T>
Tree to_tree(const T& value, const PathText& path_text = as_held) {
  Tree t;
  if constexpr (std::is_same_v<T, bool>)
    return plain_tree(value ? "true" : "false");
  else if constexpr (is_whole_number<T>)
    return plain_tree(std::to_string(value));
  else if constexpr (std::is_floating_point_v<T>)
    return plain_tree(number_text(value));
  else if constexpr (is_history<T>)
    return value.points.empty() ? to_tree(value.value) : to_tree(value.points);
  else if constexpr (Named<T>)
    return plain_tree(words_of<T>()[static_cast<std::size_t>(value)]);
  else if constexpr (std::is_same_v<T, std::string>)
    return text_tree(value);
  else if constexpr (std::is_same_v<T, InputPath>)
    return text_tree(path_text(value.path));
  else if constexpr (is_choice<T>) {
    t.kind = Tree::Kind::map;
    std::visit(
        [&](const auto& a) {
          t.map.push_back({std::remove_cvref_t<decltype(a)>::key, to_tree(a, path_text)});
        },
        value);
  } else if constexpr (is_sum<T>) {
    // a map if each kind of term occurs once, otherwise a list
    t.kind = Tree::Kind::map;
    for (const auto& term : value) {
      Tree choice = to_tree(term, path_text);
      if (t.find(choice.map[0].key)) t.kind = Tree::Kind::list;
      t.map.push_back(choice.map[0]);
      t.list.push_back(std::move(choice));
    }
    if (t.kind == Tree::Kind::map)
      t.list.clear();
    else
      t.map.clear();
  } else if constexpr (is_vector<T> || is_array<T>) {
    t.kind = Tree::Kind::list;
    for (const auto& one : value) t.list.push_back(to_tree(one, path_text));
  } else if constexpr (is_named_things<T>) {
    t.kind = Tree::Kind::map;
    for (const auto& [name, one] : value) t.map.push_back({name, to_tree(one, path_text)});
  } else {
    static_assert(Listed<T>);
    t.kind = Tree::Kind::map;
    for_each_line(value, [&](const Member& m, const auto& part) {
      using Part = std::remove_cvref_t<decltype(part)>;
      if constexpr (std::is_same_v<Part, InputPath>) {
        if (!part.path.empty()) t.map.push_back({m.key, to_tree(part, path_text)});
      } else if constexpr (is_optional<Part>) {
        if (part) t.map.push_back({m.key, to_tree(*part, path_text)});
      } else if (is_among_keys<Part>(m))
        t.map.push_back(to_tree(part, path_text).map.at(0));
      else
        t.map.push_back({m.key, to_tree(part, path_text)});
    });
    // the short form if it says everything, so that the text of such a config stays as it was
    if constexpr (Shortened<T>) {
      if (t.map.size() == 1 && t.map.front().key == T::short_key) {
        const Tree only = t.map.front().value;
        return only;
      }
    }
  }
  return t;
}

template <Listed Config>
std::string to_yaml(const Config& config, const PathText& path_text = as_held) {
  return to_text(to_tree(config, path_text));
}

// The files that a config names, with the path of the key that names them.
struct NamedFile {
  std::string key, path;
};
template <class T>
void collect_files(const T& value, const std::string& path, std::vector<NamedFile>& files) {
  const auto below = [&](const std::string& key) {
    if (path.empty()) return key;
    return path + "." + key;
  };
  if constexpr (std::is_same_v<T, InputPath>) {
    if (!value.path.empty()) files.push_back({path, value.path});
  } else if constexpr (is_optional<T>) {
    if (value) collect_files(*value, path, files);
  } else if constexpr (is_choice<T>) {
    std::visit(
        [&](const auto& a) {
          collect_files(a, below(std::remove_cvref_t<decltype(a)>::key), files);
        },
        value);
  } else if constexpr (is_vector<T> || is_array<T>) {
    for (std::size_t i = 0; i < value.size(); ++i)
      collect_files(value[i], path + "[" + std::to_string(i) + "]", files);
  } else if constexpr (is_named_things<T>) {
    for (const auto& [name, one] : value) collect_files(one, below(name), files);
  } else if constexpr (Listed<T>)
    for_each_line(value, [&](const Member& m, const auto& part) {
      collect_files(part, *m.key ? below(m.key) : path, files);
    });
}
template <Listed Config>
std::vector<NamedFile> files_named_by(const Config& config) {
  std::vector<NamedFile> files;
  collect_files(config, "", files);
  return files;
}

// The config as results record it. Input files count by their content, not by their place.
struct ConfigText {
  std::string full;    // effective YAML
  std::string hashed;  // the same with input files by name
  std::vector<NamedFile> files;
};
template <Listed Config>
ConfigText config_text(const Config& config) {
  return {to_yaml(config), to_yaml(config, file_name), files_named_by(config)};
}

// The outermost keys that may be absent: what a config switches on, for --dry-run.
struct ConfigPart {
  std::string key;
  bool active = false;
  std::size_t count = 0;  // of a list or of named things
};
template <Listed Config>
std::vector<ConfigPart> parts_of(const Config& config) {
  std::vector<ConfigPart> parts;
  for_each_line(config, [&](const Member& m, const auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if constexpr (is_optional<V>)
      parts.push_back({m.key, value.has_value()});
    else if constexpr (is_vector<V> || is_named_things<V>)
      parts.push_back({m.key, !value.empty(), value.size()});
  });
  return parts;
}

// The reference of a config: one line per key, nested ones indented.
struct DescribedKey {
  int level;
  std::string key, kind, otherwise, doc;  // otherwise: "required", "optional" or the default
};
std::string reference_text(const std::vector<DescribedKey>& keys);

template <class T>
void describe_parts(int level, std::vector<DescribedKey>& keys);

// a list or a map whose items have keys of their own
template <class T>
inline constexpr bool has_parts = false;
template <class T>
inline constexpr bool has_parts<std::vector<T>> = Listed<T> || is_choice<T> || has_parts<T>;
template <class T>
inline constexpr bool has_parts<std::map<std::string, T>> =
    Listed<T> || is_choice<T> || is_sum<T> || has_parts<T>;

template <class T>
std::string kind_words(const Member& m) {
  if constexpr (is_optional<T>)
    return kind_words<typename T::value_type>(m);
  else if constexpr (is_sum<T>)
    return "a sum of";
  else if constexpr (is_choice<T>)
    return "exactly one of";
  else if constexpr (is_vector<T> && has_parts<T>)
    return "a list, each item";
  else if constexpr (is_named_things<T> && has_parts<T>)
    return "a map of names, each value";
  else if constexpr (Listed<T>)
    return "a map";
  else
    return type_words<T>(m);
}

// The lines of a struct, its default values read from a default-constructed object.
template <Listed T>
void describe_lines(int level, std::vector<DescribedKey>& keys) {
  T object{};
  for_each_line(object, [&](const Member& m, const auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if constexpr (is_choice<V>)
      if (is_among_keys<V>(m)) {
        const std::size_t first = keys.size();
        describe_parts<V>(level, keys);
        for (std::size_t i = first; i < keys.size(); ++i)
          if (keys[i].level == level) {
            keys[i].otherwise = "one of " + list_words(alternatives<V>());
            keys[i].doc = m.doc;
          }
        return;
      }
    std::string otherwise;
    if (m.required)
      otherwise = "required";
    else if constexpr (is_optional<V>)
      otherwise = "optional";
    else if constexpr (is_leaf<V>)
      otherwise = "default " + to_text(to_tree(value));
    else if constexpr (is_array<V>)
      otherwise = "default " + to_text(to_tree(value));
    else if constexpr (is_vector<V> || is_named_things<V>)
      otherwise = value.empty() ? "default none" : "default given below";
    keys.push_back({level, m.key, kind_words<V>(m), otherwise, m.doc});
    describe_parts<V>(level + 1, keys);
  });
}

template <class T>
void describe_parts(int level, std::vector<DescribedKey>& keys) {
  if constexpr (is_optional<T>)
    describe_parts<typename T::value_type>(level, keys);
  else if constexpr (is_choice<T>)
    for_each_alternative<T>([&](const auto& a) {
      using A = std::remove_cvref_t<decltype(a)>;
      keys.push_back({level, A::key, "a map", "", ""});
      describe_lines<A>(level + 1, keys);
    });
  else if constexpr (is_vector<T> || is_array<T>)
    describe_parts<typename T::value_type>(level, keys);
  else if constexpr (is_named_things<T>)
    describe_parts<typename T::mapped_type>(level, keys);
  else if constexpr (Listed<T>)
    describe_lines<T>(level, keys);
}

// only the keys of the outermost map
template <Listed Config>
std::vector<DescribedKey> top_keys() {
  std::vector<DescribedKey> keys;
  describe_lines<Config>(0, keys);
  std::erase_if(keys, [](const DescribedKey& k) { return k.level > 0; });
  return keys;
}

template <Listed Config>
std::string describe() {
  std::vector<DescribedKey> keys;
  describe_lines<Config>(0, keys);
  return reference_text(keys);
}

}  // namespace langer

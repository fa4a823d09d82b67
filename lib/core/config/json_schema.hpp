// JSON Schema (draft 7) of a config from its listing: what an editor needs to complete keys and to
// mark mistakes. It says what one key may hold; rules between keys (complaints()) are the reader's.
// A file or a map that includes another need not have the keys that are required: each struct with
// required keys has a second definition without them.
#pragma once

#include <cxxabi.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <typeinfo>

#include "core/config/writer.hpp"

namespace langer {

// JSON of a tree: quoted scalars are texts, plain ones stand as they are
std::string json_of(const Tree& tree, int indent = 0);

namespace schema {

inline Tree word(const std::string& s) {
  Tree t = plain_tree(s);
  t.quoted = true;
  return t;
}
inline Tree list(std::vector<Tree> items) {
  Tree t;
  t.kind = Tree::Kind::list;
  t.list = std::move(items);
  return t;
}
inline Tree object(std::vector<Tree::Entry> entries = {}) {
  Tree t;
  t.kind = Tree::Kind::map;
  t.map = std::move(entries);
  return t;
}
inline Tree words(const std::vector<std::string>& all) {
  std::vector<Tree> items;
  for (const std::string& s : all) items.push_back(word(s));
  return list(std::move(items));
}
inline Tree type(const std::string& name) { return object({{"type", word(name)}}); }
inline Tree types(const std::vector<std::string>& names) {
  return object({{"type", words(names)}});
}
inline Tree reference(const std::string& name) {
  return object({{"$ref", word("#/definitions/" + name)}});
}

Tree included();  // what `include` may hold
Tree number(const Member& m, bool whole);
Tree text_schema(const Member& m);             // any text, or one of the member's words
Tree described(Tree schema, const Member& m);  // with its meaning and unit
void refuse_others(Tree& object);
// for a struct or a choice: `whole`, or `part` where `include` brings in the rest
Tree or_included(Tree whole, const std::string& part);

using Definitions = std::map<std::string, Tree>;

template <class T>
std::string type_name() {
  int status = 0;
  char* text = abi::__cxa_demangle(typeid(T).name(), nullptr, nullptr, &status);
  std::string name = status == 0 ? text : typeid(T).name();
  std::free(text);
  if (const std::size_t colon = name.rfind(':'); colon != std::string::npos)
    name.erase(0, colon + 1);
  return name;
}

template <class T>
inline constexpr bool is_words = std::is_same_v<T, std::string> || Named<T>;

// whether a map of this type cannot be empty
template <class T>
bool asks() {
  if constexpr (is_optional<T> || is_vector<T> || is_array<T> || is_named_things<T> || is_leaf<T> ||
                is_history<T>)
    return false;
  else if constexpr (is_choice<T>)
    return true;
  else {
    bool any = false;
    T object{};
    for_each_line(object, [&](const Member& m, const auto&) { any = any || m.required; });
    return any;
  }
}
// whether anything in it is required, so that an included file makes a difference
template <class T>
bool asks_within() {
  if constexpr (is_leaf<T> || is_history<T>)
    return false;
  else if constexpr (is_optional<T> || is_vector<T>)
    return asks_within<typename T::value_type>();
  else if constexpr (is_named_things<T>)
    return asks_within<typename T::mapped_type>();
  else if constexpr (is_array<T>)
    return false;
  else if constexpr (is_choice<T>)
    return true;
  else {
    bool any = asks<T>();
    T object{};
    for_each_line(object, [&](const Member&, const auto& value) {
      any = any || asks_within<std::remove_cvref_t<decltype(value)>>();
    });
    return any;
  }
}

template <class T>
Tree value_schema(const Member& m, bool whole, Definitions& definitions);

template <Listed T>
Tree struct_schema(bool whole, Definitions& definitions);

// The schema of a struct itself. `whole`: its required keys must be there.
template <Listed T>
Tree lines_schema(bool whole, Definitions& definitions) {
  Tree properties = object(), needed = list({}), one_of = list({});
  T defaults{};
  for_each_line(defaults, [&](const Member& m, const auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if constexpr (is_choice<V>)
      if (is_among_keys<V>(m)) {
        for_each_alternative<V>([&](const auto& a) {
          using A = std::remove_cvref_t<decltype(a)>;
          properties.map.push_back({A::key, struct_schema<A>(whole, definitions)});
          one_of.list.push_back(object({{"required", words({A::key})}}));
        });
        return;
      }
    Tree one = described(value_schema<V>(m, whole, definitions), m);
    if constexpr ((is_leaf<V> && !std::is_same_v<V, InputPath>) || is_array<V>)
      if (!m.required) {
        Tree otherwise = to_tree(value);
        if constexpr (is_words<V>) otherwise.quoted = true;
        if constexpr (is_array<V>)
          if constexpr (is_words<typename V::value_type>)
            for (Tree& item : otherwise.list) item.quoted = true;
        one.map.push_back({"default", std::move(otherwise)});
      }
    properties.map.push_back({m.key, std::move(one)});
    if (m.required && whole) needed.list.push_back(word(m.key));
  });
  properties.map.push_back({"include", included()});
  Tree t = object({{"type", words({"object", "null"})}, {"properties", std::move(properties)}});
  if (!needed.list.empty()) t.map.push_back({"required", std::move(needed)});
  if (!one_of.list.empty() && whole) t.map.push_back({"oneOf", std::move(one_of)});
  refuse_others(t);
  return t;
}

// A reference to the definition of a struct, which is made on first use. A struct with required
// keys has two definitions: complete, and in part for maps that include the rest.
template <Listed T>
Tree struct_schema(bool whole, Definitions& definitions) {
  const std::string name = type_name<T>(), part = name + "_in_part";
  const bool differ = asks_within<T>();
  const std::string wanted = whole || !differ ? name : part;
  if (definitions.count(wanted)) return reference(wanted);
  definitions[wanted] = object();  // stops recursion
  Tree made = lines_schema<T>(whole && differ, definitions);
  if (whole && differ) {
    struct_schema<T>(false, definitions);
    made = or_included(std::move(made), part);
  }
  definitions[wanted] = std::move(made);
  return reference(wanted);
}

template <class Choice>
Tree alternatives_schema(bool whole, Definitions& definitions) {
  Tree properties = object();
  for_each_alternative<Choice>([&](const auto& a) {
    using A = std::remove_cvref_t<decltype(a)>;
    properties.map.push_back({A::key, struct_schema<A>(whole, definitions)});
  });
  properties.map.push_back({"include", included()});
  Tree t = object({{"type", word("object")}, {"properties", std::move(properties)}});
  refuse_others(t);
  return t;
}

template <class T>
Tree value_schema(const Member& m, bool whole, Definitions& definitions) {
  if constexpr (is_optional<T>) {
    Tree t = value_schema<typename T::value_type>(m, whole, definitions);
    if constexpr (Listed<typename T::value_type>)
      return t;
    else
      return object({{"anyOf", list({std::move(t), type("null")})}});
  } else if constexpr (std::is_same_v<T, bool>)
    return type("boolean");
  else if constexpr (is_whole_number<T> || std::is_floating_point_v<T>)
    return number(m, is_whole_number<T>);
  else if constexpr (is_history<T>)
    return object({{"anyOf", list({number(m, false), value_schema<std::vector<HistoryPointConfig>>(
                                                         m, whole, definitions)})}});
  else if constexpr (Named<T>)
    return object({{"enum", words(words_of<T>())}});
  else if constexpr (std::is_same_v<T, std::string>)
    return text_schema(m);
  else if constexpr (std::is_same_v<T, InputPath>)
    return type("string");
  else if constexpr (is_choice<T>) {
    Tree t = alternatives_schema<T>(whole, definitions);
    if (whole) {
      Tree part = alternatives_schema<T>(false, definitions);
      t.map.push_back({"minProperties", plain_tree("1")});
      t.map.push_back({"maxProperties", plain_tree("1")});
      return object({{"if", object({{"type", word("object")}, {"required", words({"include"})}})},
                     {"then", std::move(part)},
                     {"else", std::move(t)}});
    }
    return t;
  } else if constexpr (is_sum<T>) {
    using Term = typename T::value_type;
    return object(
        {{"anyOf", list({alternatives_schema<Term>(whole, definitions),
                         object({{"type", word("array")},
                                 {"items", value_schema<Term>(m, whole, definitions)}})})}});
  } else if constexpr (is_vector<T> || is_array<T>) {
    Tree t = object({{"type", word("array")},
                     {"items", value_schema<typename T::value_type>(m, whole, definitions)}});
    if constexpr (is_array<T>)
      for (const char* end : {"minItems", "maxItems"})
        t.map.push_back({end, plain_tree(std::to_string(std::tuple_size_v<T>))});
    return t;
  } else if constexpr (is_named_things<T>) {
    Tree t = object({{"type", word("object")},
                     {"properties", object({{"include", included()}})},
                     {"patternProperties",
                      object({{"^(?!include$)[A-Za-z0-9_+-]+$",
                               value_schema<typename T::mapped_type>(m, whole, definitions)}})}});
    refuse_others(t);
    return t;
  } else if constexpr (Shortened<T>) {
    return object(
        {{"anyOf", list({types({"string", "number"}), struct_schema<T>(whole, definitions)})}});
  } else if constexpr (ShortenedList<T>) {
    return object({{"anyOf", list({types({"array"}), struct_schema<T>(whole, definitions)})}});
  } else
    return struct_schema<T>(whole, definitions);
}

std::string document(const std::string& title, Tree root, const Definitions& definitions);

}  // namespace schema

template <Listed Config>
std::string json_schema(const std::string& title) {
  schema::Definitions definitions;
  Tree root = schema::struct_schema<Config>(true, definitions);
  return schema::document(title, std::move(root), definitions);
}

}  // namespace langer

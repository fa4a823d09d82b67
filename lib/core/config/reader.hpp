// Tree -> config struct by the struct's listing (base/fields.hpp): the only way a config is read.
// All errors of a file are collected and thrown together as one Failure(config): unknown key (with
// the nearest known one), missing key (at the parent), wrong type, out of range, non-finite number,
// rules between keys.
//
//   auto [config, where, notices] = read_config<SolveConfig>(load_yaml("solve.yaml"));
//   where("contacts[0].friction")  ->  Place, for errors found later
//   notices                        ->  keys and words by their former names (base/former.hpp),
//                                  read as what they are called now
#pragma once

#include <algorithm>

#include "core/config/member.hpp"
#include "core/config/tree.hpp"

namespace langer {

struct Where {
  Tree tree;
  Place operator()(const std::string& key) const { return place_of(tree, key); }
};

template <class Config>
struct Loaded {
  Config config;
  Where where;
  std::vector<std::string> notices;  // one line each, with its place
};

// Errors and notices found so far. A function that reports an error leaves the value unchanged.
struct Findings {
  std::vector<Error> errors;
  std::vector<std::string> notices;
  void say(const Place& where, const std::string& key, std::string found, std::string expected = "",
           std::string hint = "") {
    errors.push_back({where, key, std::move(found), std::move(expected), std::move(hint)});
  }
  void notice(const Place& where, const std::string& key, const std::string& was,
              const std::string& is) {
    notices.push_back(text(Error{where, key, was + " is now called " + is, "", ""}));
  }
};

void read_leaf(const Tree& tree, const std::string& path, const Member& m, bool& out, Findings& f);
void read_leaf(const Tree& tree, const std::string& path, const Member& m, double& out,
               Findings& f);
void read_leaf(const Tree& tree, const std::string& path, const Member& m, std::string& out,
               Findings& f);
void read_leaf(const Tree& tree, const std::string& path, const Member& m, InputPath& out,
               Findings& f);
void read_history(const Tree& tree, const std::string& path, const Member& m, HistoryConfig& out,
                  Findings& f);
long long read_whole(const Tree& tree, const std::string& path, const Member& m, long long low,
                     long long high, Findings& f);
int read_word(const Tree& tree, const std::string& path, const Member& m,
              const std::vector<std::string>& words, Findings& f,
              const std::vector<FormerWord>& former = {});  // -1: none
void report_unknown_key(const Tree::Entry& entry, const std::string& path,
                        const std::vector<std::string>& known, Findings& f);
[[noreturn]] void throw_sorted(std::vector<Error> errors);  // by place
bool is_name(const std::string& name);  // valid in file names, HDF5 paths and paths of keys
std::string join(const std::string& path, const std::string& key);
std::string item(const std::string& path, std::size_t index);

template <class T>
void read_value(const Tree& tree, const std::string& path, const Member& m, T& out, Findings& f);

// A map with this one entry, in the place of its value.
Tree as_entry(const char* key, const Tree& value);

// The value of the member's key or of its former key: the one of the overriding file if there are
// both; nullptr if there is neither. Both in one file are an error.
const Tree* find_member(const Tree& tree, const std::string& path, const Member& m, Findings& f);

// the entries of a map that have these keys
Tree part_of(const Tree& tree, const std::vector<std::string>& keys);

// The path of a complaint's key, which is relative to its struct: empty, "[0]" or "key".
inline std::string complaint_path(const std::string& path, const std::string& key) {
  if (key.empty()) return path;
  if (key[0] == '[') return path + key;
  return join(path, key);
}

// Reads each line of the listing, then reports unknown keys, then asks the struct for complaints,
// but only if all its values were read.
template <Listed T>
void read_struct(const Tree& tree, const std::string& path, T& out, Findings& f) {
  const std::size_t before = f.errors.size();
  std::vector<std::string> known, former;
  for_each_line(out, [&](const Member& m, auto& value) {
    using V = std::remove_cvref_t<decltype(value)>;
    if constexpr (is_choice<V>)
      if (is_among_keys<V>(m)) {
        const std::vector<std::string> keys = alternatives<V>();
        known.insert(known.end(), keys.begin(), keys.end());
        const Tree part = part_of(tree, keys);
        if (!part.map.empty())
          read_value(part, path, m, value, f);
        else if (m.required)
          f.say(tree.place, path, "none of the keys " + list_words(keys),
                "exactly one of them (" + std::string(m.doc) + ")", m.hint);
        return;
      }
    known.push_back(m.key);
    const std::string key = join(path, m.key);
    if (*m.former) former.push_back(m.former);
    if (const Tree* given = find_member(tree, path, m, f))
      read_value(*given, key, m, value, f);
    else if (m.required)
      f.say(tree.place, key, "missing", type_words<V>(m) + " (" + m.doc + ")", m.hint);
  });
  for (const Tree::Entry& entry : tree.map)
    if (std::find(known.begin(), known.end(), entry.key) == known.end() &&
        std::find(former.begin(), former.end(), entry.key) == former.end())
      report_unknown_key(entry, path, known, f);
  if constexpr (Complaining<T>) {
    if (f.errors.size() > before) return;
    for (const Complaint& c : out.complaints())
      f.say(place_of(tree, c.key), complaint_path(path, c.key), c.found, c.expected, c.hint);
  }
}

// The entries of a map of alternatives that count. Alternatives of an included file are replaced as
// a whole by other ones of the including file. A mixture of the same and of other alternatives, or
// one that --set adds to those of the files, is reported as an error; then the result is empty.
std::vector<const Tree::Entry*> chosen(const Tree& tree, const std::string& path, bool is_sum,
                                       Findings& f);

// Reads the alternative that `entry` names; false if there is none of that name.
template <class Choice>
bool read_alternative(const Tree::Entry& entry, const std::string& path, const Member& m,
                      Choice& out, Findings& f) {
  bool found = false;
  for_each_alternative<Choice>([&](auto alternative) {
    if (entry.key != decltype(alternative)::key) return;
    found = true;
    read_value(entry.value, join(path, entry.key), m, alternative, f);
    out = alternative;
  });
  if (!found) report_unknown_key(entry, path, alternatives<Choice>(), f);
  return found;
}

template <class T>
void read_number(const Tree& tree, const std::string& path, const Member& m, T& out, Findings& f) {
  constexpr auto low = static_cast<long long>(std::numeric_limits<T>::min());
  constexpr auto high = sizeof(T) < 8 ? static_cast<long long>(std::numeric_limits<T>::max())
                                      : std::numeric_limits<long long>::max();
  const std::size_t before = f.errors.size();
  const long long value = read_whole(tree, path, m, low, high, f);
  if (f.errors.size() == before) out = static_cast<T>(value);
}

template <class Choice>
void read_choice(const Tree& tree, const std::string& path, const Member& m, Choice& out,
                 Findings& f) {
  const std::size_t before = f.errors.size();
  const std::vector<const Tree::Entry*> entries = chosen(tree, path, false, f);
  if (f.errors.size() > before) return;
  if (entries.size() == 1) {
    read_alternative(*entries.front(), path, m, out, f);
    return;
  }
  const std::vector<std::string> known = alternatives<Choice>();
  // a misspelt key is a better message than the number of keys
  for (const Tree::Entry* entry : entries)
    if (std::find(known.begin(), known.end(), entry->key) == known.end())
      report_unknown_key(*entry, path, known, f);
  if (f.errors.size() == before)
    f.say(tree.place, path, "found " + std::to_string(entries.size()) + " keys",
          type_words<Choice>(m), m.hint);
}

template <class Item>
void read_items(const Tree& tree, const std::string& path, const Member& m, std::vector<Item>& out,
                Findings& f) {
  for (std::size_t i = 0; i < tree.list.size(); ++i) {
    Item value{};
    read_value(tree.list[i], item(path, i), m, value, f);
    out.push_back(std::move(value));
  }
}

template <class Thing>
void read_named_things(const Tree& tree, const std::string& path, const Member& m,
                       std::map<std::string, Thing>& out, Findings& f) {
  out.clear();
  for (const Tree::Entry& entry : tree.map) {
    if (!is_name(entry.key)) {
      f.say(entry.value.place, path, "found the name \"" + entry.key + "\"",
            "letters, digits, _, + and - only");
      continue;
    }
    read_value(entry.value, join(path, entry.key), m, out[entry.key], f);
  }
}

// A sum is a list of maps with one key each, or one map whose keys are all terms.
template <class Term>
void read_sum(const Tree& tree, const std::string& path, const Member& m, std::vector<Term>& out,
              Findings& f) {
  out.clear();
  for (const Tree::Entry* entry : chosen(tree, path, true, f)) {
    Term term;
    if (read_alternative(*entry, path, m, term, f)) out.push_back(std::move(term));
  }
  read_items(tree, path, m, out, f);
}

// Dispatches on the type of the member; the kinds of types are those of config/member.hpp.
template <class T>
void read_value(const Tree& tree, const std::string& path, const Member& m, T& out, Findings& f) {
  using Kind = Tree::Kind;
  const auto wrong = [&](const std::string& found) {
    f.say(tree.place, path, found, type_words<T>(m), m.hint);
  };
  const auto wrong_kind = [&] {
    wrong("found " + description(tree));
  };
  if constexpr (is_whole_number<T>) {
    read_number(tree, path, m, out, f);
  } else if constexpr (is_history<T>) {
    read_history(tree, path, m, out, f);
  } else if constexpr (Named<T>) {
    if (const int i = read_word(tree, path, m, words_of<T>(), f, former_words_of<T>()); i >= 0)
      out = static_cast<T>(i);
  } else if constexpr (is_leaf<T>) {
    read_leaf(tree, path, m, out, f);
  } else if constexpr (is_optional<T>) {
    if (tree.kind == Kind::null && !Listed<typename T::value_type>) return;
    typename T::value_type value{};
    read_value(tree, path, m, value, f);
    out = std::move(value);
  } else if constexpr (is_choice<T>) {
    if (tree.kind != Kind::map) return wrong_kind();
    read_choice(tree, path, m, out, f);
  } else if constexpr (is_sum<T>) {
    if (tree.kind != Kind::map && tree.kind != Kind::list) return wrong_kind();
    read_sum(tree, path, m, out, f);
  } else if constexpr (is_vector<T>) {
    if (tree.kind != Kind::list) return wrong_kind();
    out.clear();
    read_items(tree, path, m, out, f);
  } else if constexpr (is_array<T>) {
    if (tree.kind != Kind::list) return wrong_kind();
    if (tree.list.size() != out.size())
      return wrong("found " + std::to_string(tree.list.size()) + " items");
    for (std::size_t i = 0; i < out.size(); ++i)
      read_value(tree.list[i], item(path, i), m, out[i], f);
  } else if constexpr (is_named_things<T>) {
    if (tree.kind != Kind::map) return wrong_kind();
    read_named_things(tree, path, m, out, f);
  } else {
    if constexpr (Shortened<T>) {
      if (tree.kind == Kind::scalar) return read_struct(as_entry(T::short_key, tree), path, out, f);
    }
    if constexpr (ShortenedList<T>) {
      if (tree.kind == Kind::list) return read_struct(as_entry(T::list_key, tree), path, out, f);
    }
    // an empty value is read as a map without keys
    if (tree.kind != Kind::map && tree.kind != Kind::null) return wrong_kind();
    read_struct(tree, path, out, f);
  }
}

// A config that takes keys from the files it names: static void complete(Tree&), before it is read.
template <class T>
concept Completing = requires(Tree& tree) {
  T::complete(tree);
};

// Throws one Failure(config) with everything that is wrong.
template <Listed Config>
Loaded<Config> read_config(Tree tree) {
  Findings f;
  if constexpr (Completing<Config>) Config::complete(tree);
  Config config{};
  if (tree.kind == Tree::Kind::map || tree.kind == Tree::Kind::null)
    read_struct(tree, "", config, f);
  else
    f.say(tree.place, "", "found " + description(tree),
          "a map with the keys " + list_words(keys_of<Config>()));
  if (!f.errors.empty()) throw_sorted(std::move(f.errors));
  return {std::move(config), {std::move(tree)}, std::move(f.notices)};
}

}  // namespace langer

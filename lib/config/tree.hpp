// A YAML file as a tree that knows where each part stands. The parser itself stays behind tree.cpp.
// `include: file` (path relative to the including file) is merged first, keys beside it win; deep for maps.
// Refused with the right line: duplicate keys, `<<`, anchors' cycles, include cycles, non-YAML.
#pragma once

#include <string>
#include <vector>

#include "base/error.hpp"

namespace langer {

struct Tree {
  enum class Kind { null, scalar, list, map } kind = Kind::null;
  std::string scalar;   // text as written
  bool quoted = false;  // a quoted scalar is a string, never a number or a bool
  struct Entry;
  std::vector<Entry> map;   // in file order
  std::vector<Tree> list;
  Place place;  // of the value's key, or of the list item
  const Tree* find(const std::string& key) const;
};
struct Tree::Entry {
  std::string key;
  Tree value;
};

Tree load_yaml(const std::string& path);                                  // throws Failure(config) or Failure(input) if missing
Tree parse_yaml(const std::string& text, const std::string& shown_name);  // for tests, --set and sweeps

// Sets the value at a path like "contacts[0].friction", making maps on the way; throws Failure(config) where it cannot.
void set_value(Tree& tree, const std::string& path, Tree value);

}  // namespace langer

// A YAML file as a tree that knows where each part stands. The parser itself stays behind tree.cpp.
// `include: file` (or a list of files; paths relative to the including file) is merged first, keys
// beside it win; deep for maps, and `key: null` takes an included key away. Of keys that choose or
// sum alternatives (a law's matrix, an indenter's shape), what stands beside the include replaces
// the included alternatives as a whole; `layers` tells the reader which are which. Refused with the
// right line: duplicate keys, `<<`, tags, anchors that contain themselves, include cycles, more
// than one document, nesting deeper than 64 and more than 100 000 parts (aliases counted as often
// as they are used), non-YAML.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace langer {

struct Tree {
  enum class Kind { null, scalar, list, map } kind = Kind::null;
  std::string scalar;   // text as written
  bool quoted = false;  // a quoted scalar is a string, never a number or a bool
  struct Entry;
  std::vector<Entry> map;  // in file order
  std::vector<Tree> list;
  Place place;       // of the value's key, or of the list item
  std::string base;  // folder that paths written here are relative to; empty: the working directory
  // which files of a stack of includes gave this part: bit 0 the one that includes, bits above
  // those that lie under it
  std::uint64_t layers = 1;
  bool set_later = false;  // this key was added by --set or a sweep
  const Tree* find(const std::string& key) const;
};
struct Tree::Entry {
  std::string key;
  Tree value;
};

Tree load_yaml(
    const std::string& path);  // throws Failure(config), or Failure(input) if there is no such file
// for tests, --set and sweeps; paths in the text are relative to `base`
Tree parse_yaml(const std::string& text, const std::string& shown_name,
                const std::string& base = "");

void set_base(Tree& tree, const std::string& base);  // of all parts

// One step of a path like "contacts[0].friction": a key, or an index where the key is empty.
struct PathStep {
  std::string key;
  int index = -1;
};
std::vector<PathStep> split_path(const std::string& path);  // empty if the path is malformed

// Sets the value at a path like "contacts[0].friction", making maps on the way; throws
// Failure(config) where it cannot.
void set_value(Tree& tree, const std::string& path, Tree value);

// Place of the part at a path; of the deepest part on the way if the path leads further than the
// tree.
Place place_of(const Tree& tree, const std::string& path);

// "a list", "a map", "the text "abc"", "nothing": for messages
std::string description(const Tree& tree);

}  // namespace langer

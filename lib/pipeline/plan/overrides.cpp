#include "pipeline/plan/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/member.hpp"

namespace langer::pipeline {

namespace {

// An error of an option has no line of a file: its place is the option itself.
[[noreturn]] void refuse(const char* option, std::string found, std::string expected,
                         std::string hint = "") {
  throw Failure(Exit::config,
                Error{{option, 0, 0}, "", std::move(found), std::move(expected), std::move(hint)});
}

// A typed value was parsed like a file, so its lines would point nowhere.
void remove_lines(Tree& tree) {
  tree.place.line = 0;
  tree.place.column = 0;
  for (Tree& part : tree.list) remove_lines(part);
  for (auto& entry : tree.map) remove_lines(entry.value);
}

// The parts of [axis:]node.key=value.
struct Typed {
  std::string axis, node, key;
  Tree value;
};

// Splits an option at the first "=", the ":" before it and the first "." of the node's key. The
// value may contain any of these characters.
Typed typed(const char* option, const std::string& text, const char* example) {
  Typed t;
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.substr(0, equals).find(':');
  std::size_t begin = 0;
  if (colon != std::string::npos) {
    begin = colon + 1;
    t.axis = text.substr(0, colon);
  }
  const std::size_t dot = text.find('.', begin);
  if (equals == std::string::npos || dot == std::string::npos || dot > equals || dot == begin ||
      dot + 1 >= equals)
    refuse(option, "found \"" + text + "\"",
           fmt::format("node.key=value, for example {} {}", option, example));

  t.node = text.substr(begin, dot - begin);
  t.key = text.substr(dot + 1, equals - dot - 1);
  t.value = typed_value(text.substr(equals + 1), option);
  return t;
}

// The value of a key that may be changed; nullptr if the map does not have it.
Tree* child(Tree& tree, const std::string& key) { return const_cast<Tree*>(tree.find(key)); }

// The value of a key of a map; an empty one is added if the map does not have the key. `like` has
// the place that messages about it name.
Tree& made_child(Tree& tree, const std::string& key, const Tree& like) {
  tree.kind = Tree::Kind::map;
  if (Tree* found = child(tree, key)) return *found;
  Tree made;
  made.place = like.place;
  tree.map.push_back({key, made});
  return tree.map.back().value;
}

// The node of this name; refuses an unknown one.
Tree& node_of(Tree& pipeline, const char* option, const std::string& name) {
  Tree* nodes = child(pipeline, "nodes");
  std::vector<std::string> known;
  if (nodes)
    for (const auto& entry : nodes->map) known.push_back(entry.key);
  if (!nodes || !nodes->find(name)) {
    const std::string near = nearest(name, known);
    refuse(option, fmt::format("there is no node \"{}\"", name), "one of " + list_words(known),
           did_you_mean(near));
  }
  return *child(*nodes, name);
}

// Whether a text, or a list of texts, contains the key.
bool contains_key(const Tree* tree, const std::string& key) {
  if (!tree) return false;
  if (tree->scalar == key) return true;
  return std::ranges::find(tree->list, key, &Tree::scalar) != tree->list.end();
}

// The axis of a node that varies the key; empty if none does.
std::string axis_varying(const Tree& node, const std::string& key) {
  const Tree* sweep = node.find("sweep");
  if (!sweep) return "";
  for (const auto& [axis, value] : sweep->map) {
    if (contains_key(value.find("key"), key) || contains_key(value.find("keys"), key)) return axis;
    const Tree* grid = value.find("grid");
    if (grid && grid->find(key)) return axis;
  }
  return "";
}

// The default name of an axis: of contacts.sphere.friction it is friction, of fibre_angles[0]
// fibre_angles.
std::string axis_name(const std::string& key) {
  const auto steps = split_path(key);
  for (auto step = steps.rbegin(); step != steps.rend(); ++step)
    if (!step->key.empty()) return step->key;
  return key;
}

}  // namespace

Tree typed_value(const std::string& text, const char* option) {
  Tree value = parse_yaml(text, option);
  remove_lines(value);
  return value;
}

// A key that the pipeline itself varies cannot be set: the setting would have no effect. It can get
// other values by --sweep.
void apply(const Overrides& overrides, Tree& pipeline) {
  for (const std::string& setting : overrides.settings) {
    Typed t = typed("--set", setting, "solve.friction=0.2");
    Tree& node = node_of(pipeline, "--set", t.node);
    if (const std::string axis = axis_varying(node, t.key); !axis.empty())
      refuse(
          "--set", fmt::format("{} is varied by the axis \"{}\" of {}", t.key, axis, t.node),
          "a key that is not swept",
          fmt::format("--sweep {}:{}.{}=[...] gives the axis other values", axis, t.node, t.key));
    made_child(made_child(node, "set", t.value), t.key, t.value) = t.value;
  }
  for (const std::string& sweep : overrides.sweeps) {
    Typed t = typed("--sweep", sweep, "'solve.friction=[0, 0.2]'");
    Tree& node = node_of(pipeline, "--sweep", t.node);
    if (t.value.kind != Tree::Kind::list)
      refuse("--sweep", fmt::format("{}: found {}", t.key, description(t.value)),
             "a list of values, for example [0, 0.2]");
    Tree key = t.value;
    key.list.clear();
    key.kind = Tree::Kind::scalar;
    key.scalar = t.key;
    Tree axis = key;
    axis.scalar.clear();
    axis.kind = Tree::Kind::map;
    axis.map = {{"key", key}, {"values", t.value}};
    const std::string name = text_or(t.axis, axis_name(t.key));
    made_child(made_child(node, "sweep", t.value), name, t.value) = axis;
  }
}

}  // namespace langer::pipeline

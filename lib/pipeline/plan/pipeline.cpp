// Reads a pipeline file. Its keys depend on the stages (ports are keys of a node), so it is not
// described by a listing of fields as other configs are, but read by hand; pipeline_schema.cpp has
// the same rules for editors.
#include "pipeline/plan/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "core/base/text.hpp"
#include "core/config/reader.hpp"
#include "core/config/writer.hpp"
#include "pipeline/sweep/design.hpp"

namespace langer::pipeline {

namespace {

// The label of a value: the shortest text of a number, or a word as it is written.
std::string label_of(const Tree& value, bool& is_number) {
  double x = 0;
  Findings none;
  read_leaf(value, "", Member{}, x, none);
  is_number = none.errors.empty();
  if (is_number) return number_text(x);
  return value.scalar;
}

// Numbers that are not finite, or outside of the range of a double: nan, .inf, 1e400, 1e-400.
bool not_finite(std::string_view text) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  if (text.starts_with('.') && text.size() > 1 && std::isalpha(static_cast<unsigned char>(text[1])))
    text.remove_prefix(1);
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (text.empty() || end != text.data() + text.size()) return false;
  if (error == std::errc::result_out_of_range) return true;
  return error == std::errc{} && !std::isfinite(x);
}

// A label becomes the name of a folder.

bool is_label(const std::string& label) {
  return !label.empty() && label.find_first_not_of('.') != std::string::npos &&
         is_safe_path(label) && label.find('/') == std::string::npos;
}

bool takes_several(const Port& port) { return port.several; }

// Reads a pipeline from its YAML tree. Errors are collected in `f`, so that one run shows all.
class PipelineParser {
 public:
  Findings f;

  // Reads a whole pipeline. The names of all nodes are collected first, because a source may name a
  // node that is declared below it.
  Pipeline pipeline(const Tree& tree) {
    Pipeline p;
    p.file = tree.place.file;
    if (!is_map(tree, "")) return p;
    known_keys(tree, "", {"pipeline", "nodes"});
    if (const Tree* name = require(tree, "", "pipeline", "the pipeline's name")) {
      p.name = text(*name, "pipeline");
      if (name->kind == Tree::Kind::scalar && !is_name(p.name)) {
        bad_name(name->place, "pipeline", p.name);
      }
    }
    const Tree* nodes = require(tree, "", "nodes", "a map of nodes");
    if (!nodes || !is_map(*nodes, "nodes")) return p;
    if (nodes->map.empty()) f.say(nodes->place, "nodes", "found no nodes", "at least one");
    for (const auto& [name, value] : nodes->map) names_.push_back(name);
    for (const auto& [name, value] : nodes->map) p.nodes.push_back(node(name, value));
    return p;
  }

 private:
  std::vector<std::string> names_;  // of all nodes

  // An error if the value is not a map.
  bool is_map(const Tree& tree, const std::string& path) {
    if (tree.kind != Tree::Kind::map)
      f.say(tree.place, path, "found " + description(tree), "a map");
    return tree.kind == Tree::Kind::map;
  }
  // An error for each unknown key of a map, with a suggestion.
  void known_keys(const Tree& tree, const std::string& path,
                  const std::vector<std::string>& known) {
    for (const auto& entry : tree.map)
      if (std::ranges::find(known, entry.key) == known.end())
        report_unknown_key(entry, path, known, f);
  }
  // The value of a required key; an error and nullptr if it is missing.
  const Tree* require(const Tree& tree, const std::string& path, const std::string& key,
                      const std::string& what) {
    const Tree* found = tree.find(key);
    if (!found) f.say(tree.place, join(path, key), "missing", what);
    return found;
  }
  // A text; an error if the value is a list or a map.
  std::string text(const Tree& tree, const std::string& path) {
    std::string s;
    read_leaf(tree, path, Member{}, s, f);
    return s;
  }
  void bad_name(const Place& place, const std::string& path, const std::string& name) {
    f.say(place, path, "found the name \"" + name + "\"", "letters, digits, _, + and - only",
          "it becomes the name of a folder");
  }
  // One text, or a list of texts.
  std::vector<std::string> texts(const Tree& tree, const std::string& path) {
    std::vector<std::string> found;
    if (tree.kind != Tree::Kind::list) return {text(tree, path)};
    for (std::size_t i = 0; i < tree.list.size(); ++i)
      found.push_back(text(tree.list[i], item(path, i)));
    return found;
  }

  // Reads one node. Without a known stage its ports are unknown, so the rest is not read.
  Node node(const std::string& name, const Tree& tree) {
    const std::string path = "nodes." + name;
    Node n;
    n.name = name;
    n.place = tree.place;
    if (!is_name(name)) bad_name(tree.place, path, name);
    if (name == "all")
      f.say(tree.place, path, "found the name \"all\"", "another name",
            "make builds everything by this name");
    if (!is_map(tree, path)) return n;
    const std::string known_stages = "one of " + list_words(stage_names());
    if (const Tree* stage = require(tree, path, "stage", known_stages)) {
      const std::string wanted = text(*stage, path + ".stage");
      n.stage = find_stage(wanted);
      const std::string near = nearest(wanted, stage_names());
      if (!n.stage)
        f.say(stage->place, path + ".stage", "found " + description(*stage), known_stages,
              did_you_mean(near));
    }
    if (!n.stage) return n;
    // The ports of the stage are keys of the node.
    std::vector<std::string> known{"stage", "config", "set", "sweep", "over"};
    for (const Port& port : n.stage->inputs) known.push_back(port.name);
    known_keys(tree, path, known);
    if (const Tree* config = tree.find("config")) {
      n.config = *config;
      if (config->kind == Tree::Kind::list)
        f.say(config->place, path + ".config", "found a list", "the path of a YAML file, or a map");
    }
    if (const Tree* set = tree.find("set")) n.settings = settings(*set, path + ".set");
    for (const Port& port : n.stage->inputs) source(tree, path, port, n);
    if (const Tree* sweep = tree.find("sweep"); sweep && is_map(*sweep, path + ".sweep"))
      for (const auto& [axis_name, value] : sweep->map)
        n.sweep.push_back(axis(axis_name, value, path + ".sweep." + axis_name));
    if (const Tree* over = tree.find("over")) {
      n.over_place = over->place;
      n.over = texts(*over, path + ".over");
      if (std::ranges::none_of(n.stage->inputs, takes_several))
        f.say(over->place, path + ".over",
              fmt::format("the stage {} takes one file per port", n.stage->name),
              "a stage that gathers");
    }
    return n;
  }

  // The label that a value has on an axis: 30.0 and 3e1 are both "30".
  std::string label_text(const Tree& tree, const std::string& path) {
    bool is_number = false;
    text(tree, path);
    return label_of(tree, is_number);
  }

  // Reads the sources of one port: one, or a list if the port takes several files.
  void source(const Tree& tree, const std::string& path, const Port& port, Node& n) {
    const Tree* given = tree.find(port.name);
    const std::string key = join(path, port.name);
    if (!given) {
      if (port.required)
        f.say(tree.place, key, "missing", fmt::format("a node or a file: {}", port.says));
      return;
    }
    if (given->kind != Tree::Kind::list || !port.several) return one_source(given, key, port, n);
    for (std::size_t i = 0; i < given->list.size(); ++i)
      one_source(&given->list[i], item(key, i), port, n);
  }

  // Reads one source: the name of a node, a map that names one of its members, or a file. A text
  // with a dot or a slash is a file.
  void one_source(const Tree* given, const std::string& key, const Port& port, Node& n) {
    Source s{port.name, "", "", {}, given->place};
    std::string wanted;
    if (given->kind == Tree::Kind::map) {
      if (const Tree* node = require(*given, key, "node", "a node"))
        wanted = text(*node, key + ".node");
      for (const auto& [axis, label] : given->map)
        if (axis != "node") s.at.push_back({axis, label_text(label, join(key, axis))});
    } else {
      wanted = text(*given, key);
    }
    if (wanted.empty()) return;
    if (std::ranges::find(names_, wanted) != names_.end()) {
      s.node = wanted;
      n.sources.push_back(s);
    } else if (given->kind != Tree::Kind::map && wanted.find_first_of("./") != std::string::npos) {
      s.file = wanted;
      n.sources.push_back(s);
    } else {
      const std::string near = nearest(wanted, names_);
      f.say(given->place, key, fmt::format("there is no node \"{}\"", wanted),
            "one of " + list_words(names_) + ", or a file", did_you_mean(near));
    }
  }

  // A map of values by the paths of their keys.
  Settings settings(const Tree& tree, const std::string& path) {
    Settings found;
    if (!is_map(tree, path)) return found;
    for (const auto& [key, value] : tree.map) {
      check_key(key, value.place, path);
      found.push_back({key, value});
    }
    return found;
  }

  // Reads one axis of a sweep, of any kind.
  Axis axis(const std::string& name, const Tree& tree, const std::string& path) {
    Axis a;
    a.name = name;
    a.place = tree.place;
    if (!is_name(name)) bad_name(tree.place, path, name);
    if (!is_map(tree, path)) return a;
    // The kind of an axis follows from its key.
    if (const Tree* variants = tree.find("variants")) {
      known_keys(tree, path, {"variants"});
      points_of_variants(*variants, path + ".variants", a);
    } else if (const Tree* design = tree.find("design")) {
      known_keys(tree, path, {"design"});
      points_of_design(*design, path + ".design", a);
    } else if (const Tree* samples = tree.find("samples")) {
      known_keys(tree, path, {"samples"});
      points_of_samples(*samples, path + ".samples", a);
    } else if (const Tree* grid = tree.find("grid")) {
      known_keys(tree, path, {"grid"});
      points_of_grid(*grid, path + ".grid", a);
    } else {
      points_of_values(tree, path, a);
    }
    check_points(a, path);
    return a;
  }

  // A path of keys must have a form like contacts[0].friction. Whether the config has such a key is
  // checked when the member's config is read.
  void check_key(const std::string& key, const Place& place, const std::string& path) {
    if (split_path(key).empty())
      f.say(place, path, "found the key \"" + key + "\"",
            "a path of keys like contacts[0].friction");
  }

  static constexpr std::size_t most = 10'000;  // points of an axis

  // A variant is a map of settings, or the path of a config. An empty one leaves the config as it
  // is.
  void points_of_variants(const Tree& variants, const std::string& path, Axis& a) {
    if (!is_map(variants, path)) return;
    for (const auto& [label, value] : variants.map) {
      if (!is_label(label)) bad_name(value.place, path, label);
      AxisPoint point{label, {}, {}};
      if (value.kind == Tree::Kind::scalar)
        point.config = value;
      else if (value.kind != Tree::Kind::null)
        point.settings = settings(value, path + "." + label);
      a.points.push_back(std::move(point));
    }
  }

  // An axis {key, values, unit}. `keys` names several keys with the same value.
  void points_of_values(const Tree& tree, const std::string& path, Axis& a) {
    known_keys(tree, path,
               {"key", "keys", "values", "unit", "variants", "design", "grid", "samples"});
    if (const Tree* unit = tree.find("unit")) a.unit = text(*unit, path + ".unit");
    std::vector<std::string> keys;
    for (const char* word : {"key", "keys"})
      if (const Tree* given = tree.find(word)) keys = texts(*given, join(path, word));
    if (keys.empty())
      f.say(tree.place, path, "missing",
            "key: the path of the key that varies, or variants, grid, design or samples");
    for (const std::string& key : keys) check_key(key, tree.place, path);
    values(tree, path, keys, a);
  }

  // All combinations of the values of some keys. The last key varies fastest.
  void points_of_grid(const Tree& tree, const std::string& path, Axis& a) {
    if (!is_map(tree, path)) return;
    a.points = {{"", {}, {}}};
    for (const auto& [key, given] : tree.map) {
      const std::string here = join(path, key);
      check_key(key, given.place, here);
      if (given.kind != Tree::Kind::list || given.list.empty()) {
        f.say(given.place, here, "found " + description(given), "a list of values");
        continue;
      }
      // Checked before the points are made: their number is a product.
      if (a.points.size() * given.list.size() > most)
        return f.say(tree.place, path, "more than 10000 combinations", "10000 at most",
                     "fewer values");
      std::vector<AxisPoint> points;
      for (const AxisPoint& point : a.points)
        for (std::size_t i = 0; i < given.list.size(); ++i) {
          AxisPoint& next = points.emplace_back(point);
          append(next.label, "-", label_text(given.list[i], item(here, i)));
          next.settings.push_back({key, given.list[i]});
        }
      a.points = std::move(points);
    }
    for (const AxisPoint& point : a.points)
      if (!is_label(point.label)) bad_name(tree.place, path, point.label);
  }

  // The points of a design of experiments, numbered from 1. After an error one point is added, so
  // that no further message complains about an axis without points.
  void points_of_design(const Tree& tree, const std::string& path, Axis& a) {
    Design design;
    const std::size_t before = f.errors.size();
    read_value(tree, path, Member{}, design, f);
    if (f.errors.size() > before) return a.points.push_back({"1", {}, {}});
    const std::vector<VecX> points = design_points(design);
    if (points.size() > most)
      return f.say(tree.place, path, std::to_string(points.size()) + " members", "10000 at most",
                   "fewer trajectories or samples");
    a.numbers = true;
    a.design = to_tree(design);
    for (std::size_t i = 0; i < points.size(); ++i) {
      AxisPoint point{std::to_string(i + 1), {}, {}};
      for (std::size_t j = 0; j < design.parameters.size(); ++j) {
        Tree value = plain_tree(number_text(points[i][static_cast<Eigen::Index>(j)]));
        value.place = tree.place;
        point.settings.push_back({design.parameters[j].key, value});
      }
      a.points.push_back(std::move(point));
    }
  }

  // Sets of parameters drawn from a fit's covariance, numbered from 1. After an error one point is
  // added, as in a design.
  void points_of_samples(const Tree& tree, const std::string& path, Axis& a) {
    Member rule;
    rule.range = between(2, most);
    read_value(tree, path, rule, a.samples, f);
    a.numbers = true;
    for (int i = 1; i <= a.samples; ++i) {
      Tree number = plain_tree(std::to_string(i));
      number.place = tree.place;
      a.points.push_back({std::to_string(i), {}, {{"number", number}}});
    }
    if (a.points.empty()) a.points.push_back({"1", {}, {}});
  }

  // One point for each value: a finite number, or a word.
  void values(const Tree& tree, const std::string& path, const std::vector<std::string>& keys,
              Axis& a) {
    const Tree* list = require(tree, path, "values", "a list of values");
    if (!list) return;
    if (list->kind != Tree::Kind::list)
      return f.say(list->place, path + ".values", "found " + description(*list),
                   "a list of values");
    a.numbers = true;
    for (std::size_t i = 0; i < list->list.size(); ++i) {
      const Tree& value = list->list[i];
      const std::string here = item(path + ".values", i);
      if (value.kind != Tree::Kind::scalar) {
        f.say(value.place, here, "found " + description(value), "a number or a word",
              "maps and lists can be varied by variants");
        continue;
      }
      if (not_finite(value.scalar)) {
        f.say(value.place, here, "found " + value.scalar, "a finite number, or a word");
        continue;
      }
      bool is_number = false;
      AxisPoint point{label_of(value, is_number), {}, {}};
      a.numbers = a.numbers && is_number;
      if (!is_label(point.label)) bad_name(value.place, here, point.label);
      for (const std::string& key : keys) point.settings.push_back({key, value});
      a.points.push_back(std::move(point));
    }
  }

  // Two equal labels would be one folder.
  void check_points(const Axis& a, const std::string& path) {
    if (a.points.empty()) f.say(a.place, path, "found no values", "at least one");
    std::set<std::string> seen;
    for (const AxisPoint& point : a.points)
      if (!seen.insert(point.label).second)
        f.say(a.place, path, fmt::format("duplicate value {}", point.label), "each value once");
  }
};

}  // namespace

bool is_safe_path(const std::string& path) {
  for (const char c : path)
    if (!is_name(std::string(1, c)) && c != '.' && c != '/') return false;
  return !path.empty();
}

const Node* Pipeline::node(const std::string& wanted) const {
  for (const Node& n : nodes)
    if (n.name == wanted) return &n;
  return nullptr;
}

Pipeline read_pipeline(const Tree& tree) {
  PipelineParser parser;
  Pipeline p = parser.pipeline(tree);
  if (!parser.f.errors.empty()) throw_sorted(std::move(parser.f.errors));
  return p;
}

}  // namespace langer::pipeline

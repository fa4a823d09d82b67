// Expansion of a pipeline. A node is a vertex of a graph, its sources are the edges; axes propagate
// along the edges until a node gathers them. A step is a node at one point of its axes.
#include "pipeline/plan/expand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/text.hpp"
#include "core/config/reader.hpp"
#include "core/config/writer.hpp"

namespace langer::pipeline {

namespace {

constexpr std::size_t most_steps = 10'000;

using Point = std::map<std::string, std::size_t>;  // axis -> index of its value

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::ranges::find(list, word) != list.end();
}

// Number of digits before the decimal point.
std::size_t integer_digits(const std::string& label) {
  const std::size_t first = label.find_first_of("0123456789");
  return std::min(label.find_first_not_of("0123456789", first), label.size()) - first;
}

// The two declarations of an axis have the same points.
bool same_points(const Axis& a, const Axis& b) {
  return to_text(a.design) == to_text(b.design) &&
         std::ranges::equal(a.points, b.points, {}, &AxisPoint::label, &AxisPoint::label);
}

// The steps of a pipeline: gathers the axes, orders the nodes so that inputs come first, then makes
// the steps of each node. Errors are collected and thrown together after each of these parts.
class Expansion {
 public:
  Expansion(const Pipeline& pipeline, const ReadYaml& read) : pipeline_(pipeline), read_(read) {}

  // Each part needs the one before it without errors: unknown nodes would crash the search, wrong
  // kinds of files would give misleading messages later.
  std::vector<Step> steps() {
    gather_axes();
    for (const Node& n : pipeline_.nodes) visit(n);
    stop_if_wrong();
    for (const Node& n : pipeline_.nodes) check_kinds(n);
    stop_if_wrong();
    for (const Node* n : order_) add_steps(*n);
    stop_if_wrong();
    for (Step& step : steps_) step.final = used_.count(step.output()) == 0;
    return std::move(steps_);
  }

 private:
  const Pipeline& pipeline_;
  const ReadYaml& read_;
  Findings f_;
  std::vector<const Axis*> axes_;   // in order of declaration
  std::vector<const Node*> order_;  // inputs first
  std::vector<const Node*> open_;   // nodes whose inputs are being visited
  std::map<std::string, std::vector<const Axis*>> axes_of_;
  std::vector<Step> steps_;
  std::set<std::string> used_;  // outputs that another step reads

  void stop_if_wrong() {
    if (!f_.errors.empty()) throw_sorted(std::move(f_.errors));
  }

  // Collects the axes of all nodes. An axis that two nodes declare is one axis.
  void gather_axes() {
    std::map<std::string, std::string> folders;  // first folder of a member -> axis
    for (const Node& n : pipeline_.nodes)
      for (const Axis& axis : n.sweep) {
        const auto same = std::ranges::find(axes_, axis.name, &Axis::name);
        if (same == axes_.end()) {
          axes_.push_back(&axis);
          for (std::size_t i = 0; i < axis.points.size(); ++i)
            folders[member_folder(axis, i)] = axis.name;
          continue;
        }
        if (!same_points(axis, **same))
          f_.say(axis.place, fmt::format("nodes.{}.sweep.{}", n.name, axis.name),
                 fmt::format("the axis has other values at line {}", (*same)->place.line),
                 "the same values in the same order", "an axis that two nodes declare is one axis");
      }
    for (const Node& n : pipeline_.nodes)
      if (const auto it = folders.find(n.name); it != folders.end())
        f_.say(n.place, "nodes." + n.name,
               fmt::format("a member of the axis {} has the same folder", it->second),
               "another name");
  }

  // Whether each port of a node gets a file of the right kind.
  void check_kinds(const Node& n) {
    for (const Source& s : n.sources) {
      const std::string key = fmt::format("nodes.{}.{}", n.name, s.port);
      const Port& port = *n.stage->port(s.port);
      if (!s.node.empty()) {
        const StageSpec* makes = pipeline_.node(s.node)->stage;
        if (!contains(port.made_by, makes->name))
          f_.say(s.place, key, fmt::format("the node \"{}\" makes {}", s.node, makes->output),
                 "a node of the stage " + fmt::format("{}", fmt::join(port.made_by, " or ")));
      } else if (!is_safe_path(s.file)) {
        f_.say(s.place, key, "found " + s.file, "a path of letters, digits, _ . + - and / only",
               "make gives other characters a meaning");
      }
    }
  }

  // Orders the nodes by a depth-first search: a node comes after its inputs, and has its own axes
  // and those of its inputs that it does not gather.
  void visit(const Node& n) {
    if (contains_node(order_, n)) return;
    if (contains_node(open_, n)) {
      std::string cycle;
      for (auto it = std::ranges::find(open_, &n); it != open_.end(); ++it)
        cycle += (*it)->name + " -> ";
      f_.say(n.place, "nodes." + n.name, "the nodes depend on each other: " + cycle + n.name);
      return;
    }
    open_.push_back(&n);
    // `found`: the axes of this node; `below`: those of its inputs.
    std::vector<std::string> found;
    for (const Axis& axis : n.sweep) found.push_back(axis.name);
    std::vector<std::string> below;
    for (const Source& s : n.sources) {
      if (s.node.empty()) continue;
      visit(*pipeline_.node(s.node));
      for (const auto& [axis, label] : s.at) check_member(n, s, axis, label);
      for (const Axis* axis : axes_of_[s.node])
        if (!chosen(s, axis->name)) below.push_back(axis->name);
    }
    std::string expected = "no axis: the inputs have none";
    if (!below.empty()) expected = "an axis of the inputs: " + list_words(below);
    for (const std::string& name : n.over)
      if (!contains(below, name))
        f_.say(n.over_place, fmt::format("nodes.{}.over", n.name),
               fmt::format("found \"{}\"", name), expected);
    for (const std::string& name : below)
      if (!contains(n.over, name)) found.push_back(name);
    axes_of_[n.name] = ordered(found);
    open_.pop_back();
    order_.push_back(&n);
  }

  // The label of the axis that the source names, or nullptr.
  static const std::string* chosen(const Source& s, const std::string& axis) {
    for (const auto& [name, label] : s.at)
      if (name == axis) return &label;
    return nullptr;
  }

  // Whether the member that a source names exists.
  void check_member(const Node& n, const Source& s, const std::string& axis,
                    const std::string& label) {
    std::vector<std::string> known;
    for (const Axis* a : axes_of_[s.node]) known.push_back(a->name);
    const std::string key = fmt::format("nodes.{}.{}.{}", n.name, s.port, axis);
    if (!contains(known, axis)) {
      std::string expected = "none: it has one member";
      if (!known.empty()) expected = "one of " + list_words(known);
      return f_.say(s.place, key, fmt::format("the node {} has no such axis", s.node), expected);
    }
    std::vector<std::string> labels;
    for (const Axis* a : axes_of_[s.node])
      if (a->name == axis)
        for (const AxisPoint& point : a->points) labels.push_back(point.label);
    if (!contains(labels, label))
      f_.say(s.place, key, "found " + label, "one of " + list_words(labels));
  }

  // The position of a label that check_member() has found to exist.
  static std::size_t index_of(const Axis& axis, const std::string& label) {
    std::size_t i = 0;
    while (axis.points[i].label != label) ++i;
    return i;
  }

  static bool contains_node(const std::vector<const Node*>& list, const Node& n) {
    return std::ranges::find(list, &n) != list.end();
  }

  // The named axes in order of declaration.

  std::vector<const Axis*> ordered(const std::vector<std::string>& names) const {
    std::vector<const Axis*> found;
    for (const Axis* axis : axes_)
      if (contains(names, axis->name)) found.push_back(axis);
    return found;
  }

  // All combinations of the points of some axes. The last axis varies fastest.
  static std::vector<Point> points(const std::vector<const Axis*>& axes) {
    // Begins with one empty combination; each axis multiplies the list by its number of points.
    std::vector<Point> all{Point{}};
    for (const Axis* axis : axes) {
      std::vector<Point> longer;
      if (all.size() * axis->points.size() > most_steps)
        throw Failure(Exit::config, Error{axis->place, axis->name,
                                          fmt::format("more than {} steps", most_steps), "", ""});
      for (const Point& p : all)
        for (std::size_t i = 0; i < axis->points.size(); ++i) {
          longer.push_back(p);
          longer.back()[axis->name] = i;
        }
      all = std::move(longer);
    }
    return all;
  }

  // The folder of a member, such as "code_FER/alpha_030/".
  static std::string member(const std::vector<const Axis*>& axes, const Point& at) {
    std::string folder;
    for (const Axis* axis : axes) folder += member_folder(*axis, at.at(axis->name)) + "/";
    return folder;
  }

  // The config as written, read from its file if it is the name of one.
  Tree written(const Node& n, const Tree& config) {
    Tree tree = config;
    if (config.kind == Tree::Kind::scalar) {
      try {
        tree = read_(config.scalar);
      } catch (const Failure& failure) {
        if (failure.code() != Exit::input) throw;
        throw Failure(Exit::config,
                      Error{config.place, fmt::format("nodes.{}.config", n.name), failure.what(),
                            "a YAML file", "paths are relative to the working directory"});
      }
    }
    if (tree.place.file.empty()) tree.place = n.place;
    return tree;
  }

  // The config of one member: the node's config or that of a variant, then `set`, then the values
  // of
  // the axes.
  Tree config_at(const Node& n, const Point& at) {
    // A variant may name another config instead of changing keys.
    const Tree* source = &n.config;
    for (const Axis& axis : n.sweep)
      if (const Tree& other = axis.points[at.at(axis.name)].config;
          other.kind == Tree::Kind::scalar)
        source = &other;
    Tree config = written(n, *source);
    for (const auto& [key, value] : n.settings) set_value(config, key, value);
    for (const Axis& axis : n.sweep)
      for (const auto& [key, value] : axis.points[at.at(axis.name)].settings)
        set_value(config, key, value);
    return config;
  }

  // Members share most of their config, so an error of one is mostly an error of all.
  void add_error(const Error& e) {
    for (const Error& known : f_.errors)
      if (text(known) == text(e)) return;
    f_.errors.push_back(e);
  }

  // One step for each combination of the points of the node's axes.
  void add_steps(const Node& n) {
    for (const Point& at : points(axes_of_[n.name])) {
      Step step{n.name, n.stage, member(axes_of_[n.name], at) + n.name, {}, {}, true};
      try {
        step.config = config_at(n, at);
      } catch (const Failure& failure) {
        for (const Error& e : failure.errors()) add_error(e);
      }
      for (const Source& s : n.sources) add_inputs(n, s, at, step);
      steps_.push_back(std::move(step));
    }
  }

  // The files that one member reads from a source: of one member of the source's node, or of all
  // members along the axes that the node gathers.
  void add_inputs(const Node& n, const Source& s, const Point& at, Step& step) {
    if (s.node.empty()) {
      step.inputs.push_back({s.port, s.file, false, s.place});
      return;
    }
    const Node& from = *pipeline_.node(s.node);
    const std::vector<const Axis*>& axes = axes_of_[s.node];
    // All members along the gathered axes become inputs. On its other axes the source has the same
    // point as the node, or the one that the pipeline names.
    std::vector<const Axis*> gathered;
    for (const Axis* axis : axes)
      if (contains(n.over, axis->name) && !chosen(s, axis->name)) gathered.push_back(axis);
    const std::vector<Point> members = points(gathered);
    for (const Point& p : members) {
      Point full = p;
      for (const Axis* axis : axes) {
        const auto own = at.find(axis->name);
        if (const std::string* label = chosen(s, axis->name))
          full[axis->name] = index_of(*axis, *label);
        else if (own != at.end())
          full[axis->name] = own->second;
      }
      step.inputs.push_back(
          {s.port, member(axes, full) + s.node + "/" + from.stage->output, true, s.place});
      used_.insert(step.inputs.back().path);
    }
    if (n.stage->port(s.port)->members) describe_members(gathered, members, step);
  }

  // Writes the keys `axes` and `members` of a config of a stage that gathers.
  static void describe_members(const std::vector<const Axis*>& axes,
                               const std::vector<Point>& members, Step& step) {
    Tree axis_list;
    Tree member_list;
    axis_list.kind = Tree::Kind::list;
    member_list.kind = Tree::Kind::list;
    for (const Axis* axis : axes) {
      Tree one;
      one.kind = Tree::Kind::map;
      one.map = {{"name", text_tree(axis->name)}, {"unit", text_tree(text_or(axis->unit, "-"))}};
      if (axis->design.kind == Tree::Kind::map) one.map.push_back({"design", axis->design});
      if (axis->samples > 0)
        one.map.push_back({"samples", plain_tree(std::to_string(axis->samples))});
      axis_list.list.push_back(one);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
      Tree one;
      Tree at;
      at.kind = Tree::Kind::list;
      for (const Axis* axis : axes)
        at.list.push_back(text_tree(axis->points[members[i].at(axis->name)].label));
      one.kind = Tree::Kind::map;
      one.map = {{"path", text_tree(step.inputs[i].path)}, {"at", at}};
      member_list.list.push_back(one);
    }
    set_value(step.config, "axes", axis_list);
    set_value(step.config, "members", member_list);
  }
};

}  // namespace

// Numbers in exponential notation are not padded: their text would not sort anyway.
std::string member_folder(const Axis& axis, std::size_t point) {
  const std::string& label = axis.points[point].label;
  if (!axis.numbers || label.find('e') != std::string::npos) return axis.name + "_" + label;
  // Zeros are put between sign and digits, up to the width of the longest label.
  std::size_t width = 3;
  for (const AxisPoint& p : axis.points) width = std::max(width, integer_digits(p.label));
  std::string sign;
  if (label[0] == '-') sign = "-";
  return axis.name + "_" + sign + std::string(width - integer_digits(label), '0') +
         label.substr(sign.size());
}

std::vector<Step> expand(const Pipeline& pipeline, const ReadYaml& read) {
  return Expansion(pipeline, read).steps();
}

}  // namespace langer::pipeline

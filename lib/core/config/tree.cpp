#include "core/config/tree.hpp"
#include "core/base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace langer {

const Tree* Tree::find(const std::string& key) const {
  for (const auto& e : map)
    if (e.key == key) return &e.value;
  return nullptr;
}

void set_base(Tree& tree, const std::string& base) {
  tree.base = base;
  for (Tree& item : tree.list) set_base(item, base);
  for (auto& entry : tree.map) set_base(entry.value, base);
}

// "contacts[0].friction" -> contacts, 0, friction; nothing for a text that is not a path.
std::vector<PathStep> split_path(const std::string& path) {
  std::vector<PathStep> steps;
  std::size_t i = 0;
  while (i < path.size()) {
    if (path[i] == '[') {
      const std::size_t close = path.find(']', i);
      if (close == std::string::npos || close == i + 1 || close - i > 7 || steps.empty()) return {};
      for (std::size_t j = i + 1; j < close; ++j)
        if (path[j] < '0' || path[j] > '9') return {};
      steps.push_back({"", std::stoi(path.substr(i + 1, close - i - 1))});
      i = close + 1;
      if (i < path.size() && path[i] != '.' && path[i] != '[') return {};
    } else {
      if (path[i] == '.' && !steps.empty()) ++i;
      const std::size_t stop = std::min(path.find_first_of(".[", i), path.size());
      if (stop == i) return {};
      steps.push_back({path.substr(i, stop - i), -1});
      i = stop;
      if (i + 1 == path.size() && path[i] == '.') return {};
    }
  }
  return steps;
}

namespace {

// Layer 0 is the outermost file; whether another alternative comes from a file that overrides the
// one of this.
bool is_overridden(const Tree& one, const std::vector<Tree::Entry>& all) {
  return std::any_of(all.begin(), all.end(), [&](const Tree::Entry& e) {
    return std::countr_zero(e.value.layers) < std::countr_zero(one.layers);
  });
}

}  // namespace

// Maps and keys that are missing on the way are made; items of lists are not.
void set_value(Tree& tree, const std::string& path, Tree value) {
  const Place place = value.place;
  const auto fail = [&](std::string found, std::string expected) {
    throw Failure(Exit::config, Error{place, path, found, expected, ""});
  };
  const std::vector<PathStep> steps = split_path(path);
  if (steps.empty()) fail("this is not a path of keys", "for example contacts[0].friction");
  Tree* at = &tree;
  std::string walked;
  for (const PathStep& step : steps) {
    if (step.key.empty()) {
      const int n = static_cast<int>(at->list.size());
      if (at->kind != Tree::Kind::list)
        fail(fmt::format("{} is {}", walked, description(*at)), "a list");
      if (step.index >= n)
        fail(fmt::format("{} has {} item{}", walked, n, plural_s(n)),
             fmt::format("an index below {}", n));
      walked += fmt::format("[{}]", step.index);
      at = &at->list[static_cast<std::size_t>(step.index)];
    } else {
      if (at->kind == Tree::Kind::null) at->kind = Tree::Kind::map;
      if (at->kind != Tree::Kind::map)
        fail(fmt::format("{} is {}", walked, description(*at)), "a map");
      append(walked, ".", step.key);
      if (!at->find(step.key)) {
        Tree made;
        made.place = place;
        made.set_later = true;
        at->map.push_back({step.key, made});
      }
      Tree* next = const_cast<Tree*>(at->find(step.key));
      // a value of a higher layer may have replaced this one, so it counts as set again
      if (is_overridden(*next, at->map)) next->set_later = true;
      at = next;
    }
  }
  value.layers = at->layers;
  value.set_later = at->set_later;
  *at = std::move(value);
}

// Of a key that is missing: the place of the innermost map that is there.
Place place_of(const Tree& tree, const std::string& path) {
  const Tree* at = &tree;
  for (const PathStep& step : split_path(path)) {
    const Tree* next = nullptr;
    if (!step.key.empty())
      next = at->find(step.key);
    else if (step.index < static_cast<int>(at->list.size()))
      next = &at->list[static_cast<std::size_t>(step.index)];
    if (!next) break;
    at = next;
  }
  return at->place;
}

std::string description(const Tree& tree) {
  constexpr std::size_t longest = 40;
  switch (tree.kind) {
    case Tree::Kind::null:
      return "nothing";
    case Tree::Kind::list:
      return "a list";
    case Tree::Kind::map:
      return "a map";
    case Tree::Kind::scalar:
      break;
  }
  std::string shown = tree.scalar;
  if (tree.scalar.size() > longest) shown = tree.scalar.substr(0, longest) + "...";
  if (tree.quoted) return "the text \"" + shown + "\"";
  return shown;
}

}  // namespace langer

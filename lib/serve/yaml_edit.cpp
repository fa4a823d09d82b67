#include "serve/yaml_edit.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/config/raw_yaml.hpp"

namespace langer {

namespace {

struct Range {
  std::size_t begin = 0, end = 0;  // of bytes; end is behind the last one
};

// Finds the parts of one text.
class Editor {
 public:
  Editor(const std::string& text, const std::string& file)
      : text_(text), file_(file), root_(parse_yaml_as_written(text, file)) {
    for (std::size_t at = 0; at != std::string::npos && at <= text.size();) {
      lines_.push_back(at);
      at = text.find('\n', at);
      if (at != std::string::npos) ++at;
    }
  }

  const Tree& root() const { return root_; }

  // Walks down to the part; what is missing at the end of the path is added to its parent.
  std::string set(const std::vector<PathStep>& path, const std::string& value) {
    std::size_t n = 0;
    const Tree* parent = &root_;
    Range parent_range = whole();
    bool flow = false;
    int column = -1;  // of the key or the dash that `parent` belongs to
    for (; n < path.size(); ++n) {
      const Tree* child = find(*parent, path[n]);
      if (!child) break;
      flow = flow || is_flow(*parent, parent_range);
      column = column_of(*parent, *child, path[n], flow);
      parent_range = value_range(*parent, *child, path[n], flow);
      parent = child;
    }
    if (n == path.size()) return replaced(parent_range, value);
    if (n + 1 < path.size()) refuse("its parent is not in the file");
    if (path[n].key.empty() && path[n].index > static_cast<int>(parent->list.size()))
      refuse("an item is added behind the last one of its list");
    return added(*parent, parent_range, flow, column, path[n], value);
  }

  // Walks down to the part and takes it out, with what separates it from its siblings.
  std::string removed(const std::vector<PathStep>& path) {
    const Tree* parent = &root_;
    Range range = whole();
    bool flow = false;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const Tree* child = find(*parent, path[i]);
      if (!child) refuse("it is not in the file");
      flow = flow || is_flow(*parent, range);
      const Range value = value_range(*parent, *child, path[i], flow);
      if (i + 1 == path.size()) return without(*parent, *child, path[i], range, value, flow);
      range = value;
      parent = child;
    }
    refuse("no key is given");
  }

 private:
  const std::string& text_;
  std::string file_;
  Tree root_;
  std::vector<std::size_t> lines_;  // the first byte of each line

  [[noreturn]] void refuse(const std::string& why) const {
    throw Failure(
        Exit::config,
        Error{{file_}, "", "this part cannot be edited here: " + why, "", "edit the file itself"});
  }

  static const Tree* find(const Tree& parent, const PathStep& step) {
    if (!step.key.empty()) {
      if (parent.kind != Tree::Kind::map) return nullptr;
      return parent.find(step.key);
    }
    const auto i = static_cast<std::size_t>(step.index);
    if (parent.kind != Tree::Kind::list || i >= parent.list.size()) return nullptr;
    return &parent.list[i];
  }

  Range whole() const { return {skip_to_content(0), text_.size()}; }
  // The byte of a line and column of the parser, which counts bytes.
  std::size_t offset(const Place& place) const {
    if (place.line < 1 || place.line > static_cast<int>(lines_.size())) refuse("it has no place");
    return lines_[static_cast<std::size_t>(place.line - 1)] +
           static_cast<std::size_t>(std::max(0, place.column - 1));
  }
  std::size_t line_begin(std::size_t at) const {
    const std::size_t before = at == 0 ? std::string::npos : text_.rfind('\n', at - 1);
    return before == std::string::npos ? 0 : before + 1;
  }
  std::size_t line_end(std::size_t at) const {
    return std::min(text_.find('\n', at), text_.size());
  }
  char at(std::size_t i) const { return i < text_.size() ? text_[i] : '\n'; }

  // Past spaces, line breaks and comments.
  std::size_t skip_to_content(std::size_t i) const {
    while (i < text_.size()) {
      if (text_[i] == '#')
        i = line_end(i);
      else if (text_[i] == ' ' || text_[i] == '\n' || text_[i] == '\r' || text_[i] == '\t')
        ++i;
      else
        break;
    }
    return i;
  }
  std::size_t skip_spaces(std::size_t i) const {
    while (at(i) == ' ' || at(i) == '\t') ++i;
    return i;
  }

  // Whether a part is written in brackets; all its parts then are, too.
  bool is_flow(const Tree& tree, const Range& range) const {
    if (tree.kind != Tree::Kind::map && tree.kind != Tree::Kind::list) return false;
    const char first = at(range.begin);
    return first == '{' || first == '[';
  }

  // Behind a quoted text that begins at i.
  std::size_t behind_quotes(std::size_t i) const {
    const char quote = text_[i];
    for (++i; i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\') {
        ++i;
      } else if (text_[i] == quote) {
        if (quote == '\'' && at(i + 1) == quote)
          ++i;
        else
          return i + 1;
      }
    }
    refuse("a quote is not closed");
  }
  // Behind the bracket that closes the one at i.
  std::size_t behind_brackets(std::size_t i) const {
    int depth = 0;
    while (i < text_.size()) {
      const char c = text_[i];
      const char before = i > 0 ? text_[i - 1] : ' ';
      const bool begins = before == ' ' || before == '\n' || before == ',' || before == '[' ||
                          before == '{' || before == ':' || before == '\t';
      if ((c == '"' || c == '\'') && begins) {
        i = behind_quotes(i);
        continue;
      }
      if (c == '#' && (before == ' ' || before == '\n' || before == '\t')) {
        i = line_end(i);
        continue;
      }
      if (c == '[' || c == '{') ++depth;
      if ((c == ']' || c == '}') && --depth == 0) return i + 1;
      ++i;
    }
    refuse("a bracket is not closed");
  }
  // Behind a text without quotes. In a flow part it ends at a comma or a bracket, too.
  std::size_t behind_plain(std::size_t i, bool flow) const {
    std::size_t end = i;
    for (; end < text_.size() && text_[end] != '\n'; ++end) {
      if (text_[end] == '#' && end > i && (text_[end - 1] == ' ' || text_[end - 1] == '\t')) break;
      const bool bracket = text_[end] == ',' || text_[end] == ']' || text_[end] == '}';
      if (flow && bracket) break;
    }
    while (end > i && (text_[end - 1] == ' ' || text_[end - 1] == '\t' || text_[end - 1] == '\r'))
      --end;
    return end;
  }

  // Behind the colon of the key that begins at i.
  std::size_t behind_key(std::size_t i) const {
    if (at(i) == '"' || at(i) == '\'') {
      i = behind_quotes(i);
    } else {
      while (i < text_.size() && text_[i] != '\n' &&
             !(text_[i] == ':' && (at(i + 1) == ' ' || at(i + 1) == '\n' || at(i + 1) == '\r')))
        ++i;
    }
    i = skip_spaces(i);
    if (at(i) != ':') refuse("its key has a form that this page does not know");
    return i + 1;
  }

  // The column of the key, or of the dash of a list item.
  int column_of(const Tree& parent, const Tree& child, const PathStep& step, bool flow) const {
    const std::size_t place = offset(child.place);
    const std::size_t line = line_begin(place);
    if (flow || parent.kind == Tree::Kind::map || step.index < 0)
      return static_cast<int>(place - line);
    const std::size_t dash = text_.rfind('-', place);
    if (dash == std::string::npos || dash < line) refuse("its list has an unusual form");
    return static_cast<int>(dash - line);
  }

  // The bytes of a value. An empty one is a range of length 0 behind its key.
  Range value_range(const Tree& parent, const Tree& child, const PathStep& step, bool flow) const {
    const std::size_t place = offset(child.place);
    std::size_t begin = place;
    if (parent.kind == Tree::Kind::map) begin = behind_key(place);
    const std::size_t on_line = skip_spaces(begin);
    if (child.kind == Tree::Kind::null) {
      const bool word = at(on_line) == '~' || text_.compare(on_line, 4, "null") == 0;
      if (word) return {on_line, behind_plain(on_line, flow)};
      return {begin, begin};
    }
    begin = flow ? skip_to_content(begin) : on_line;
    const int column = column_of(parent, child, step, flow);
    const bool below = !flow && (at(begin) == '\n' || at(begin) == '\r' || at(begin) == '#');
    if (below) {
      begin = skip_to_content(begin);
    }
    const char first = at(begin);
    if (first == '&' || first == '*' || first == '!' || first == '|' || first == '>' ||
        first == '?')
      refuse("it uses an anchor, a tag or a text of several lines");
    if (first == '[' || first == '{') return {begin, behind_brackets(begin)};
    if (child.kind == Tree::Kind::scalar) {
      std::size_t end = begin;
      if (first == '"' || first == '\'')
        end = behind_quotes(begin);
      else
        end = behind_plain(begin, flow);
      return {begin, end};
    }
    return {begin, behind_block(begin, column,
                                child.kind == Tree::Kind::list && parent.kind == Tree::Kind::map)};
  }

  // The end of the last line with content that is indented more than `column` (or a dash there).
  std::size_t behind_block(std::size_t begin, int column, bool dashes) const {
    std::size_t end = line_end(begin);
    for (std::size_t line = end + 1; line < text_.size();) {
      const std::size_t content = skip_spaces(line);
      const std::size_t next = line_end(line) + 1;
      const int indent = static_cast<int>(content - line);
      const bool blank = at(content) == '\n' || at(content) == '#' || at(content) == '\r';
      const bool dash = dashes && indent == column && at(content) == '-';
      if (!blank && indent <= column && !dash) break;
      if (!blank) end = next - 1;
      line = next;
    }
    return end;
  }

  // A block part is replaced by one on the line of its key.
  std::string replaced(const Range& range, const std::string& value) const {
    std::size_t begin = range.begin;
    if (range.begin == range.end) return text_.substr(0, begin) + " " + value + text_.substr(begin);
    // between key and value there may be line breaks and comments; the line of the key stays
    const std::string between = text_.substr(line_begin(begin), begin - line_begin(begin));
    const bool below = between.find_first_not_of(" \t") == std::string::npos ||
                       (between.find_first_not_of(" \t-") == std::string::npos &&
                        at(range.end) == '\n' && text_.find('\n', begin) < range.end);
    if (below && line_begin(begin) > 0) {
      std::size_t key = line_begin(begin) - 1;
      std::size_t line = line_begin(key);
      // back over lines that are blank or comments to the line of the key
      while (line > 0 && (at(skip_spaces(line)) == '\n' || at(skip_spaces(line)) == '#')) {
        key = line - 1;
        line = line_begin(key);
      }
      const std::size_t behind = behind_content(line);
      if (behind > 0 && text_[behind - 1] == ':')
        return text_.substr(0, behind) + " " + value + text_.substr(behind, key - behind) +
               text_.substr(range.end);
    }
    return text_.substr(0, begin) + value + text_.substr(range.end);
  }
  // Behind the last letter of a line that is no comment.
  std::size_t behind_content(std::size_t line) const {
    return behind_plain(skip_spaces(line), false);
  }

  static std::string entry(const PathStep& step, const std::string& value) {
    if (step.key.empty()) return value;
    return step.key + ": " + value;
  }

  // A new entry: before the closing bracket, or on a line behind the last entry, indented alike.
  std::string added(const Tree& parent, const Range& range, bool flow, int column,
                    const PathStep& step, const std::string& value) const {
    const bool empty = parent.map.empty() && parent.list.empty();
    const bool list = step.key.empty();
    if (parent.kind == Tree::Kind::scalar) refuse("its parent is a single value");
    if (list && parent.kind == Tree::Kind::map) refuse("its parent is no list");
    if (!list && parent.kind == Tree::Kind::list) refuse("its parent is a list");
    const std::string text = entry(step, value);
    if (parent.kind == Tree::Kind::null) {
      if (&parent == &root_) return text_ + text + "\n";
      if (list) return replaced(range, "[" + text + "]");
      return replaced(range, "{" + text + "}");
    }
    if (flow || is_flow(parent, range)) {
      // behind the last part, so that a comment behind it stays where it is
      std::size_t at_end = range.end - 1;
      const bool one_line = text_.find('\n', range.begin) >= range.end;
      if (!one_line) {
        const std::size_t last = last_content(range);
        return text_.substr(0, last) + (empty ? "" : ", ") + text + text_.substr(last);
      }
      while (at_end > range.begin + 1 && text_[at_end - 1] == ' ') --at_end;
      if (at_end > range.begin + 1 && text_[at_end - 1] == ',') --at_end;
      return text_.substr(0, at_end) + (empty ? "" : ", ") + text + text_.substr(at_end);
    }
    int indent = 0;
    if (list) {
      indent = column_of(parent, parent.list.front(), {"", 0}, false);
    } else {
      const std::size_t first = offset(parent.map.front().value.place);
      indent = static_cast<int>(first - line_begin(first));
    }
    if (indent <= column && !list) refuse("its parent has an unusual form");
    std::size_t end = range.end;
    if (&parent == &root_) end = behind_block(range.begin, -1, false);
    end = line_end(end);
    std::string line(static_cast<std::size_t>(indent), ' ');
    if (list) line += "- ";
    line += text;
    return text_.substr(0, end) + "\n" + line + text_.substr(end);
  }

  // Behind the last letter inside of brackets that is no space and no comment.
  std::size_t last_content(const Range& range) const {
    std::size_t last = range.begin + 1;
    for (std::size_t i = range.begin + 1; i + 1 < range.end;) {
      i = skip_to_content(i);
      if (i + 1 >= range.end) break;
      const char c = text_[i];
      if (c == '"' || c == '\'')
        i = behind_quotes(i);
      else if (c == '[' || c == '{')
        i = behind_brackets(i);
      else
        ++i;
      last = i;
    }
    return last;
  }

  // In brackets the comma goes as well; elsewhere the lines of the part, with their comments.
  std::string without(const Tree& parent, const Tree& child, const PathStep& step,
                      const Range& parent_range, const Range& value, bool flow) const {
    const std::size_t n = std::max(parent.map.size(), parent.list.size());
    const std::size_t place = offset(child.place);
    if (flow) {
      std::size_t begin = place;
      std::size_t end = value.end;
      std::size_t after = skip_to_content(end);
      if (at(after) == ',') {
        end = skip_spaces(after + 1);
        return text_.substr(0, begin) + text_.substr(end);
      }
      std::size_t before = begin;
      while (before > parent_range.begin + 1 && text_[before - 1] != ',') {
        if (text_[before - 1] != ' ') break;
        --before;
      }
      if (text_[before - 1] == ',') begin = before - 1;
      return text_.substr(0, begin) + text_.substr(end);
    }
    if (n == 1) {
      if (&parent == &root_) refuse("it is the only key of the file");
      if (parent.kind == Tree::Kind::list) return replaced(parent_range, "[]");
      refuse("it is the only key of its part; remove the part as a whole");
    }
    const std::size_t line = line_begin(place);
    const std::size_t end = std::max(line_end(value.end), line_end(place));
    const std::string before = text_.substr(line, place - line);
    if (parent.kind == Tree::Kind::map && before.find_first_not_of(' ') != std::string::npos) {
      // the first key of a list item: the next one takes its place behind the dash
      const std::size_t next = offset(parent.map[1].value.place);
      return text_.substr(0, place) + text_.substr(next);
    }
    if (parent.kind == Tree::Kind::list && before.find_first_not_of(" ") != before.find('-'))
      refuse("its list has an unusual form");
    (void)step;
    return text_.substr(0, line) + text_.substr(std::min(end + 1, text_.size()));
  }
};

// Whether two trees have the same values; places and quotes do not count.
bool same(const Tree& a, const Tree& b) {
  if (a.kind != b.kind || a.scalar != b.scalar) return false;
  if (a.list.size() != b.list.size() || a.map.size() != b.map.size()) return false;
  for (std::size_t i = 0; i < a.list.size(); ++i)
    if (!same(a.list[i], b.list[i])) return false;
  for (std::size_t i = 0; i < a.map.size(); ++i)
    if (a.map[i].key != b.map[i].key || !same(a.map[i].value, b.map[i].value)) return false;
  return true;
}

// The tree as it should be after the edit.
void change(Tree& tree, const std::vector<PathStep>& path, std::size_t n, const Tree* value) {
  const PathStep& step = path[n];
  const bool last = n + 1 == path.size();
  if (tree.kind == Tree::Kind::null) {
    tree.kind = step.key.empty() ? Tree::Kind::list : Tree::Kind::map;
    tree.scalar.clear();
  }
  if (step.key.empty()) {
    const auto i = static_cast<std::size_t>(step.index);
    if (i < tree.list.size()) {
      if (!last) return change(tree.list[i], path, n + 1, value);
      if (value)
        tree.list[i] = *value;
      else
        tree.list.erase(tree.list.begin() + step.index);
    } else if (last && value) {
      tree.list.push_back(*value);
    }
    return;
  }
  for (std::size_t i = 0; i < tree.map.size(); ++i) {
    if (tree.map[i].key != step.key) continue;
    if (!last) return change(tree.map[i].value, path, n + 1, value);
    if (value)
      tree.map[i].value = *value;
    else
      tree.map.erase(tree.map.begin() + static_cast<std::ptrdiff_t>(i));
    return;
  }
  if (last && value) tree.map.push_back({step.key, *value});
}

[[noreturn]] void refuse(const std::string& file, const std::string& found,
                         const std::string& hint) {
  throw Failure(Exit::config, Error{{file}, "", found, "", hint});
}

}  // namespace

std::string edit_yaml(const std::string& text, const std::string& file, const std::string& path,
                      const std::optional<std::string>& value) {
  const std::vector<PathStep> steps = split_path(path);
  if (steps.empty()) refuse(file, "found the path \"" + path + "\"", "a path such as loads[0].on");
  Editor editor(text, file);
  Tree expected = editor.root();
  std::string changed;
  if (value) {
    if (value->size() > 100'000) refuse(file, "the value is too long", "");
    if (value->find('\n') != std::string::npos) refuse(file, "the value has several lines", "");
    const Tree parsed = parse_yaml_as_written("[" + *value + "]", "the value");
    // blanks around it belong to the line, and an edit made twice would add them twice
    const std::size_t first = value->find_first_not_of(" \t\r");
    if (first == std::string::npos || parsed.kind != Tree::Kind::list || parsed.list.size() != 1)
      refuse(file, "found \"" + *value + "\"", "a single value");
    change(expected, steps, 0, &parsed.list.front());
    if (std::string("&*!|>").find((*value)[first]) != std::string::npos)
      refuse(file, "found \"" + *value + "\"", "a value without anchor, alias, tag or block text");
    const std::size_t last = value->find_last_not_of(" \t\r");
    changed = editor.set(steps, value->substr(first, last + 1 - first));
  } else {
    change(expected, steps, 0, nullptr);
    changed = editor.removed(steps);
  }
  Tree now;
  try {
    now = parse_yaml_as_written(changed, file);
  } catch (const Failure&) {
    refuse(file, "this part cannot be edited here: its form is unusual", "edit the file itself");
  }
  if (!same(now, expected))
    refuse(file, "this part cannot be edited here: its form is unusual", "edit the file itself");
  return changed;
}

}  // namespace langer

#include "core/config/yaml_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <vector>

#include "core/base/text.hpp"

namespace langer {

namespace {

struct TextLine {
  std::string text;
  std::size_t indent = 0;  // blanks and tabs at its begin
  bool empty = true;       // nothing, or a comment
};

std::vector<TextLine> lines_of(const std::string& text) {
  std::vector<TextLine> lines;
  std::istringstream stream(text);
  for (std::string s; std::getline(stream, s);) {
    const std::size_t first = s.find_first_not_of(" \t\r");
    const std::size_t indent = std::min(first, s.size());
    const bool is_empty = indent == s.size() || s[indent] == '#';
    lines.push_back({s, indent, is_empty});
  }
  return lines;
}

// The mark that closes a bracket, a brace or a quote.
char closing(char mark) {
  if (mark == '[') return ']';
  if (mark == '{') return '}';
  return mark;
}

// A bracket or quote that is open at the end of a line, with its place. Quotes in comments do not
// count.
struct Opened {
  std::size_t line = 0, column = 0;
  char mark = 0;
};
std::optional<Opened> first_open(const std::vector<TextLine>& lines, std::size_t until) {
  std::vector<Opened> open;
  for (std::size_t i = 0; i <= until && i < lines.size(); ++i) {
    const std::string& s = lines[i].text;
    for (std::size_t k = 0; k < s.size(); ++k) {
      const bool quoted = !open.empty() && (open.back().mark == '"' || open.back().mark == '\'');
      if (quoted) {
        if (s[k] == open.back().mark && !(s[k] == '"' && k > 0 && s[k - 1] == '\\'))
          open.pop_back();
      } else if (s[k] == '#' && (k == 0 || s[k - 1] == ' ' || s[k - 1] == '\t')) {
        break;
      } else if (s[k] == '[' || s[k] == '{' ||
                 ((s[k] == '"' || s[k] == '\'') &&
                  (k == 0 || std::string(" \t[{,:").find(s[k - 1]) != std::string::npos))) {
        open.push_back({i, k, s[k]});
      } else if ((s[k] == ']' || s[k] == '}') && !open.empty() &&
                 closing(open.back().mark) == s[k]) {
        open.pop_back();
      }
    }
  }
  if (open.empty()) return std::nullopt;
  return open.front();
}

// The columns at which the blocks begin that are open before a line, ascending. An item of a list
// opens a block behind its dash.
std::vector<std::size_t> levels_before(const std::vector<TextLine>& lines, std::size_t at) {
  std::vector<std::size_t> levels;
  for (std::size_t i = 0; i < at; ++i) {
    if (lines[i].empty) continue;
    while (!levels.empty() && levels.back() > lines[i].indent) levels.pop_back();
    if (levels.empty() || levels.back() < lines[i].indent) levels.push_back(lines[i].indent);
    const std::string& s = lines[i].text;
    if (s.compare(lines[i].indent, 2, "- ") == 0)
      levels.push_back(std::min(s.find_first_not_of(" -", lines[i].indent), s.size()));
  }
  return levels;
}

std::string words_of(const std::vector<std::size_t>& levels) {
  std::string s;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const bool is_last = i + 1 == levels.size();
    append(s, is_last ? " or " : ", ", std::to_string(levels[i]));
  }
  return s;
}

// "friction:0.3" is one word for YAML
std::optional<std::size_t> colon_without_blank(const TextLine& line) {
  const std::string& s = line.text;
  std::size_t k = line.indent;
  if (s.compare(k, 2, "- ") == 0) k += 2;
  while (k < s.size() && (std::isalnum(static_cast<unsigned char>(s[k])) || s[k] == '_')) ++k;
  if (k == line.indent || k + 1 >= s.size() || s[k] != ':' || s[k + 1] == ' ' || s[k + 1] == '\t' ||
      s[k + 1] == '\r')
    return std::nullopt;
  return k;
}

}  // namespace

// yaml-cpp names the place where it gave up, not the mistake. The usual mistakes are looked for in
// the text before that place: a tab, a missing blank behind a colon, an open bracket, an indent.
YamlTrouble yaml_trouble(const std::string& text, int line, int column, const std::string& words) {
  const std::vector<TextLine> lines = lines_of(text);
  const auto at = static_cast<std::size_t>(std::max(line, 1) - 1);
  const auto last = std::min(at, lines.empty() ? 0 : lines.size() - 1);
  const auto place = [](std::size_t row, std::size_t k) {
    return std::pair{static_cast<int>(row) + 1, static_cast<int>(k) + 1};
  };
  for (std::size_t i = 0; i <= last && i < lines.size(); ++i)
    if (const std::size_t tab = lines[i].text.find('\t');
        tab < lines[i].indent && !lines[i].empty) {
      const auto [row, k] = place(i, tab);
      return {row, k, "found a tab in the indentation", "blanks",
              "YAML is indented by blanks: replace each tab by two"};
    }
  for (std::size_t i = last + 1; i-- > 0 && i + 2 > last && i < lines.size();)
    if (const auto colon = colon_without_blank(lines[i]); colon && !lines[i].empty) {
      const auto [row, k] = place(i, *colon);
      return {row, k,
              "found a colon without a blank behind it: " + lines[i].text.substr(lines[i].indent),
              "key: value", ""};
    }
  if (const auto open = first_open(lines, lines.size()); open && open->line <= last) {
    const auto [row, k] = place(open->line, open->column);
    return {row, k, fmt::format("{} is never closed", open->mark),
            std::string(1, closing(open->mark)), ""};
  }
  if (last < lines.size() && !lines[last].empty) {
    const std::vector<std::size_t> levels = levels_before(lines, last);
    const bool known = std::find(levels.begin(), levels.end(), lines[last].indent) != levels.end();
    if (!levels.empty() && !known) {
      const auto [row, k] = place(last, lines[last].indent);
      return {row, k,
              fmt::format("indented by {} blanks; the lines above it by {}", lines[last].indent,
                          words_of(levels)),
              "as many blanks as the keys that it belongs to",
              "a key deeper than its neighbours needs a line above it that ends in a colon"};
    }
  }
  return {line, column, "this is not YAML: " + words, "", ""};
}

}  // namespace langer

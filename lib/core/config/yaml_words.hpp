// Where a text stops being YAML, in the words of somebody who typed it: tabs, indentation, a
// missing blank behind a colon, a bracket or quote without its end. The parser's own words where it
// is none of these.
#pragma once

#include <string>

namespace langer {

struct YamlTrouble {
  int line = 0, column = 0;  // from 1
  std::string found, expected, hint;
};

// line, column: where the parser gave up, from 1; 0: unknown
YamlTrouble yaml_trouble(const std::string& text, int line, int column, const std::string& words);

}  // namespace langer

#include "report/labels.hpp"

#include <algorithm>
#include <string_view>

#include "results/post/quantity.hpp"

namespace langer::report {

std::string plain_label(const char* label) {
  std::string s = label;
  std::erase_if(s, [](char c) { return c == '{' || c == '}'; });
  for (const char* greek : {"σ", "ε"})
    if (const auto at = s.find(greek + std::string("_")); at != s.npos)
      s.erase(at + std::string_view(greek).size(), 1);
  return s;
}

std::string in_words(const std::string& column) {
  const QuantityLine* best = nullptr;
  std::size_t length = 0;
  for (const QuantityLine& line : quantity_lines()) {
    const std::string_view word = line.word;
    const bool begins =
        column.starts_with(word) && (column.size() == word.size() || column[word.size()] == '_');
    if (begins && word.size() > length) {
      best = &line;
      length = word.size();
    }
  }
  std::string rest = column.substr(length);
  if (best && length == 1 && !rest.empty()) {
    // t_half is no path parameter
    best = nullptr;
    rest = column;
  }
  std::replace(rest.begin(), rest.end(), '_', ' ');
  if (!best) return rest;
  return plain_label(best->label) + (rest.empty() ? "" : "," + rest);
}

}  // namespace langer::report

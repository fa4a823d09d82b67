#include "report/labels.hpp"

#include <algorithm>
#include <string_view>

#include "results/post/quantity.hpp"

namespace langer::report {

// Labels of quantities are written for gnuplot, which sets sigma_{xx} as a subscript.
std::string plain_label(const char* label) {
  std::string s = label;
  std::erase(s, '{');
  std::erase(s, '}');
  // σ_xx becomes σxx; an underscore after other letters is part of the name.
  for (const char* greek : {"σ", "ε"})
    if (const auto at = s.find(greek + std::string("_")); at != s.npos)
      s.erase(at + std::string_view(greek).size(), 1);
  return s;
}

// The quantity is the longest known word that the name begins with: sigma_1 before sigma.
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
    // A single letter is a quantity only without a suffix: t_half is not the path parameter t.
    best = nullptr;
    rest = column;
  }
  std::replace(rest.begin(), rest.end(), '_', ' ');
  if (!best) return rest;
  if (!rest.empty()) rest = "," + rest;
  return plain_label(best->label) + rest;
}

}  // namespace langer::report

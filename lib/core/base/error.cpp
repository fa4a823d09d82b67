#include "core/base/error.hpp"
#include "core/base/text.hpp"

#include <algorithm>

#include "core/base/lower_case.hpp"
#include "core/base/printable.hpp"

namespace langer {

std::string text(const Error& e) {
  // Names come from files that somebody else wrote: their control characters are shown, not obeyed.
  const auto words = [](const std::string& part) {
    return printable(part, "\n\t");
  };
  std::string s = printable(e.where.file);
  if (e.where.line > 0)
    s += ":" + std::to_string(e.where.line) + ":" + std::to_string(e.where.column);
  if (!e.key.empty()) append(s, ": ", printable(e.key));
  if (!e.found.empty()) append(s, ": ", words(e.found));
  if (!e.expected.empty()) s += "; expected " + words(e.expected);
  if (!e.hint.empty()) s += "\n  hint: " + words(e.hint);
  return s;
}

Failure::Failure(Exit code, std::vector<Error> errors) : code_(code), errors_(std::move(errors)) {
  constexpr std::size_t most = 50;  // a file of another kind may have a hundred thousand
  for (std::size_t i = 0; i < std::min(most, errors_.size()); ++i)
    append(message_, "\n", text(errors_[i]));
  if (errors_.size() > most)
    message_ += "\n... and " + std::to_string(errors_.size() - most) + " more";
}

Failure::Failure(Exit code, Error error) : Failure(code, std::vector<Error>{std::move(error)}) {}

namespace {
// Levenshtein distance
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      std::size_t best = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = row[j];
      row[j] = best;
    }
  }
  return row.back();
}
}  // namespace

std::string nearest(const std::string& name, const std::vector<std::string>& known) {
  const auto same = std::find_if(known.begin(), known.end(), [&](const std::string& k) {
    return k != name && lower_case(k) == lower_case(name);
  });
  if (same != known.end()) return *same;
  std::string best;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& k : known)  // something of the name must remain
    if (name.size() < k.size() + least && k.size() < name.size() + least)
      if (std::size_t d = distance(name, k); d < least && d < std::max(name.size(), k.size())) {
        least = d;
        best = k;
      }
  if (!best.empty() || name.size() < 3) return best;
  for (const std::string& k :
       known) {  // begun and not ended: gauge for gauge_length, though there is gauge_length_z too
    if (!k.starts_with(name) || (!best.empty() && k.starts_with(best))) continue;
    if (!best.empty() && !best.starts_with(k)) return "";
    best = k;
  }
  return best;
}

}  // namespace langer

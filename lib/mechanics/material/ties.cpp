#include "mechanics/material/ties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "mechanics/material/parameters.hpp"

namespace langer {

namespace {

// Reads a number at the beginning of the text and removes it. Without a number there the text stays
// as it is.
std::optional<double> number_at(std::string_view& text) {
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc() || !std::isfinite(x)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return x;
}

}  // namespace

std::optional<Tie> parse_tie(const std::string& key, const std::string& written) {
  std::string plain;
  for (const char c : written)
    if (c != ' ' && c != '\t') plain += c;
  std::string_view text = plain;
  Tie tie{key, "", 1, 0};
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    tie.factor = text[0] == '-' ? -1 : 1;
    text.remove_prefix(1);
  }
  if (!text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || text[0] == '.')) {
    const auto factor = number_at(text);
    if (!factor || text.empty() || text[0] != '*') return std::nullopt;
    tie.factor *= *factor;
    text.remove_prefix(1);
  }
  const auto of_key = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '[' ||
           c == ']';
  };
  const auto end = std::find_if_not(text.begin(), text.end(), of_key);
  tie.of.assign(text.begin(), end);
  text.remove_prefix(tie.of.size());
  if (tie.of.empty() || std::isdigit(static_cast<unsigned char>(tie.of[0]))) return std::nullopt;
  if (text.empty()) return tie;
  const double sign = text[0] == '-' ? -1 : 1;
  if (text[0] != '-' && text[0] != '+') return std::nullopt;
  text.remove_prefix(1);
  if (text.empty() || text[0] == '-') return std::nullopt;
  const auto offset = number_at(text);
  if (!offset || !text.empty()) return std::nullopt;
  tie.offset = sign * *offset;
  return tie;
}

std::string tie_text(const Tie& tie) {
  std::string text;
  if (tie.factor == -1)
    text = "-";
  else if (tie.factor != 1)
    text = fmt::format("{} * ", tie.factor);
  text += tie.of;
  if (tie.offset != 0)
    text += fmt::format(" {} {}", tie.offset < 0 ? '-' : '+', std::abs(tie.offset));
  return text;
}

// Each chain is followed for at most as many steps as there are ties; one that is longer is a
// circle.
ResolvedTies resolved(const std::vector<Tie>& ties) {
  ResolvedTies result;
  for (const Tie& tie : ties) {
    Tie whole = tie;
    for (std::size_t steps = 0; steps <= ties.size(); ++steps) {
      const auto next =
          std::find_if(ties.begin(), ties.end(), [&](const Tie& t) { return t.key == whole.of; });
      if (next == ties.end()) break;
      if (steps == ties.size()) {
        if (result.circle.empty()) result.circle = tie.key;
        break;
      }
      //   f (f' x + o') + o
      whole.offset += whole.factor * next->offset;
      whole.factor *= next->factor;
      whole.of = next->of;
    }
    result.ties.push_back(whole);
  }
  return result;
}

TiedNumbers::TiedNumbers(Material& material, const std::vector<Tie>& ties) {
  std::vector<MaterialParameter> all;
  if (!ties.empty()) all = parameters(material);
  const auto number = [&](const std::string& key) {
    for (const MaterialParameter& p : all)
      if (p.key == key) return p.value;
    throw std::logic_error("the material has no parameter " + key);
  };
  for (const Tie& tie : ties)
    all_.push_back({number(tie.key), number(tie.of), tie.factor, tie.offset});
}

void TiedNumbers::follow() const {
  for (const One& one : all_) *one.number = one.factor * *one.of + one.offset;
}

}  // namespace langer

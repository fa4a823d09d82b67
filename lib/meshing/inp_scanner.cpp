#include "meshing/inp_scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/split.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t deepest_inclusion = 16;
constexpr int most_inclusions = 1000;
constexpr double largest_coordinate = 1e30;  // its cube, a volume, is a number still

std::string trimmed(const std::string& text, const char* what) {
  const std::size_t from = text.find_first_not_of(what);
  if (from == std::string::npos) return "";
  const std::size_t to = text.find_last_not_of(what);
  return text.substr(from, to - from + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  for (const std::string& cell : split(line, ',')) {
    cells.push_back(trimmed(cell, " \t\r\""));
  }
  return cells;
}

bool is_inside(const fs::path& folder, const fs::path& file) {
  const auto [rest, other] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return rest == folder.end();
}

}  // namespace

std::string InpCard::value(const std::string& key) const {
  const auto found = parameters.find(key);
  if (found == parameters.end()) return "";
  return found->second;
}

InpOpener inp_opener(const std::string& main_file) {
  // The opener keeps the real folder, without links, so that no link leads out of it.
  const fs::path own_folder = fs::path(main_file).parent_path();
  std::error_code ignored;
  fs::path root = fs::weakly_canonical(own_folder.empty() ? fs::path(".") : own_folder, ignored);
  return [root](const std::string& from, std::string named) {
    // Abaqus on Windows writes paths with backslashes.
    std::ranges::replace(named, '\\', '/');
    InpInclusion inclusion;
    const fs::path path = (fs::path(from).parent_path() / named).lexically_normal();
    inclusion.path = path.string();
    std::error_code error;
    // A path that is not there would otherwise stay relative.
    const fs::path real = fs::weakly_canonical(fs::absolute(path), error);
    if (fs::path(named).is_absolute() || error || !is_inside(root, real)) {
      inclusion.trouble = "is not in the folder of the main file";
      return inclusion;
    }
    const fs::file_status status = fs::status(real, error);
    if (!fs::exists(status)) {
      inclusion.trouble = "there is no such file";
      return inclusion;
    }
    if (!fs::is_regular_file(status)) {
      inclusion.trouble = "is no plain file";
      return inclusion;
    }
    std::ifstream file(real, std::ios::binary);
    std::ostringstream text;
    if (fs::file_size(real, error) > 0) text << file.rdbuf();
    if (!file || error) inclusion.trouble = "cannot be read";
    inclusion.text = text.str();
    return inclusion;
  };
}

void refuse_inp(const Place& place, const std::string& found, const std::string& expected,
                const std::string& hint) {
  throw Failure(Exit::input, Error{place, "", found, expected, hint});
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

bool is_digits(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

long long whole_number(const std::string& text, const Place& place) {
  long long n = 0;
  const char* end = text.data() + text.size();
  const auto [read_to, error] = std::from_chars(text.data(), end, n);
  if (error != std::errc() || read_to != end) {
    refuse_inp(place, "found \"" + text + "\"", "a whole number");
  }
  return n;
}

double real_number(std::string text, const Place& place) {
  if (text.empty()) return 0;
  // Fortran writes the exponent with a D.
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  const char* begin = text.data();
  if (*begin == '+') ++begin;
  const char* end = text.data() + text.size();
  double x = 0;
  const auto [read_to, error] = std::from_chars(begin, end, x);
  if (error != std::errc() || read_to != end || !(std::abs(x) < largest_coordinate)) {
    refuse_inp(place, "found \"" + text + "\"", "a number");
  }
  return x;
}

InpScanner::InpScanner(std::string text, const std::string& shown_name, InpOpener opener)
    : opener_(std::move(opener)) {
  open_.push_back({shown_name, std::move(text)});
}

// the next line that is no comment and not empty
bool InpScanner::read_line(Open& file, std::string& line) {
  while (file.at < file.text.size()) {
    const std::size_t end = std::min(file.text.find('\n', file.at), file.text.size());
    line = trimmed(file.text.substr(file.at, end - file.at), " \t\r\"");
    file.at = end + 1;
    ++file.line;
    if (!line.empty() && !line.starts_with("**")) return true;
  }
  return false;
}

InpCard InpScanner::read_card(Open& file, std::string line) {
  InpCard card;
  card.place = {file.path, file.line, 1};
  while (line.ends_with(',')) {
    std::string more;
    if (!read_line(file, more)) break;
    line += more;
  }
  const std::vector<std::string> cells = cells_of(line.substr(1));
  if (!cells.empty()) card.word = upper_case(cells[0]);
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const std::size_t equals = cells[i].find('=');
    const std::string key = upper_case(trimmed(cells[i].substr(0, equals), " \t\r\""));
    std::string value;
    if (equals != std::string::npos) value = trimmed(cells[i].substr(equals + 1), " \t\r\"");
    card.parameters[key] = value;
  }
  return card;
}

void InpScanner::include(const InpCard& card) {
  const std::string named = card.value("INPUT");
  if (named.empty()) refuse_inp(card.place, "*INCLUDE without a file", "INPUT=file");
  if (card.has("PASSWORD")) {
    refuse_inp(card.place, "found *INCLUDE of an encrypted file", "a file of plain text");
  }
  if (!opener_) {
    refuse_inp(card.place, "found *INCLUDE", "all nodes and elements written out in this file");
  }
  if (open_.size() > deepest_inclusion) {
    refuse_inp(card.place, fmt::format("found *INCLUDE {} files deep", open_.size()),
               fmt::format("at most {}", deepest_inclusion));
  }
  if (++n_inclusions_ > most_inclusions) {
    refuse_inp(card.place, fmt::format("found more than {} *INCLUDE", most_inclusions),
               fmt::format("at most {}", most_inclusions));
  }
  InpInclusion inclusion = opener_(open_.back().path, named);
  if (!inclusion.trouble.empty()) {
    refuse_inp(card.place, fmt::format("*INCLUDE of \"{}\": {}", named, inclusion.trouble),
               "a plain file in the folder of the main file or below, as a path relative to this "
               "file");
  }
  for (const Open& outer : open_) {
    if (fs::path(outer.path).lexically_normal() == fs::path(inclusion.path)) {
      refuse_inp(card.place, fmt::format("*INCLUDE of \"{}\", which includes this file", named),
                 "files that do not include themselves");
    }
  }
  if (std::find(included_.begin(), included_.end(), inclusion.path) == included_.end()) {
    included_.push_back(inclusion.path);
  }
  open_.push_back({std::move(inclusion.path), std::move(inclusion.text)});
}

std::optional<InpLine> InpScanner::next() {
  while (!open_.empty()) {
    Open& file = open_.back();
    std::string text;
    if (!read_line(file, text)) {
      open_.pop_back();
      continue;
    }
    InpLine line;
    line.place = {file.path, file.line, 1};
    if (text[0] != '*') {
      line.cells = cells_of(text);
      line.text = text;
      return line;
    }
    line.card = read_card(file, text);
    if (line.card->word != "INCLUDE") return line;
    include(*line.card);
  }
  return std::nullopt;
}

}  // namespace langer

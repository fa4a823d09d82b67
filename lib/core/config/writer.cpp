#include "core/config/writer.hpp"
#include "core/base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/base/quoted.hpp"

namespace langer {

namespace fs = std::filesystem;

std::string as_held(const std::string& path) { return path; }
std::string file_name(const std::string& path) { return fs::path(path).filename().string(); }
std::string relative_path(const std::string& path, const std::string& folder) {
  // A folder that does not exist yet, or may not be read, has no canonical name: then the absolute
  // names are compared.
  const fs::path from = fs::absolute(text_or(folder, "."));
  const fs::path to = fs::absolute(path);
  std::error_code ec;
  const fs::path relative = fs::relative(to, from, ec);
  if (ec) return to.lexically_relative(from).string();
  return relative.string();
}
PathText relative_to(const std::string& folder) {
  return [folder](const std::string& path) {
    return relative_path(path, folder);
  };
}

namespace {

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool plain_letters(const std::string& s) {
  return std::all_of(s.begin(), s.end(), [](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '.' || c == '/' || c == '+' || c == '-';
  });
}

// Texts that every YAML reader reads as a text if they have no quotes.
bool is_safe_plain(const std::string& s) {
  static const std::vector<std::string> taken{"true", "false", "yes", "no",  "on",
                                              "off",  "y",     "n",   "null"};
  if (s.empty()) return false;
  std::string lower = s;
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  if (std::find(taken.begin(), taken.end(), lower) != taken.end()) return false;
  return (letter(s[0]) || s[0] == '/' || s.rfind("../", 0) == 0) && plain_letters(s);
}

std::string in_line(const Tree& t) {
  if (t.kind == Tree::Kind::null) return "null";
  if (t.quoted) return quoted(t.scalar);
  return t.scalar;
}

bool fits_a_line(const Tree& t) {
  if (t.kind == Tree::Kind::map) return t.map.empty();
  return std::all_of(t.list.begin(), t.list.end(), [](const Tree& item) {
    return item.kind == Tree::Kind::scalar || item.kind == Tree::Kind::null;
  });
}

std::string one_line(const Tree& t) {
  if (t.kind == Tree::Kind::map) return "{}";
  if (t.kind != Tree::Kind::list) return in_line(t);
  std::string s;
  for (const Tree& item : t.list) append(s, ", ", in_line(item));
  return "[" + s + "]";
}

// Writes the parts of a map or a list; the first line is not indented where it follows "- ".
void write(const Tree& t, int indent, bool first_in_line, std::string& out) {
  const auto begin = [&] {
    if (!first_in_line) out += std::string(static_cast<std::size_t>(indent), ' ');
    first_in_line = false;
  };
  for (const auto& [key, value] : t.map) {
    begin();
    const bool is_plain = !key.empty() && letter(key[0]) && plain_letters(key);
    out += (is_plain ? key : quoted(key)) + ":";
    if (fits_a_line(value)) {
      out += " " + one_line(value) + "\n";
    } else {
      out += "\n";
      write(value, indent + 2, false, out);
    }
  }
  for (const Tree& item : t.list) {
    begin();
    out += "- ";
    if (fits_a_line(item))
      out += one_line(item) + "\n";
    else
      write(item, indent + 2, true, out);
  }
}

}  // namespace

std::string to_text(const Tree& tree) {
  if (fits_a_line(tree)) {
    std::string line = one_line(tree);
    if (tree.kind == Tree::Kind::map) line += "\n";
    return line;
  }
  std::string out;
  write(tree, 0, false, out);
  return out;
}

// -0 is written as 0, so that equal values give equal texts and hashes.
std::string number_text(double x) { return fmt::format("{}", x == 0 ? 0.0 : x); }

Tree plain_tree(const std::string& s) {
  Tree t;
  t.kind = Tree::Kind::scalar;
  t.scalar = s;
  return t;
}

Tree text_tree(const std::string& s) {
  Tree t = plain_tree(s);
  t.quoted = !is_safe_plain(s);
  return t;
}

// The columns are as wide as their longest entry; entries above the widest width push their line's
// last column to the right.
std::string reference_text(const std::vector<DescribedKey>& keys) {
  std::size_t key_width = 0, kind_width = 0;
  constexpr std::size_t widest = 44;
  const auto head = [](const DescribedKey& k) {
    return std::string(2 * static_cast<std::size_t>(k.level), ' ') + k.key;
  };
  const auto kind = [](const DescribedKey& k) {
    std::string words = k.kind;
    if (!k.otherwise.empty()) words += "; " + k.otherwise;
    return words;
  };
  for (const DescribedKey& k : keys) {
    key_width = std::max(key_width, head(k).size());
    kind_width = std::max(kind_width, std::min(kind(k).size(), widest));
  }
  std::string out;
  for (const DescribedKey& k : keys) {
    std::string line =
        fmt::format("{:<{}}  {:<{}}  {}", head(k), key_width, kind(k), kind_width, k.doc);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

}  // namespace langer

#include "identification/setup/specimen_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <ranges>
#include <regex>
#include <set>

#include "core/base/csv_table.hpp"
#include "core/base/input_file.hpp"
#include "core/base/text.hpp"
#include "core/config/writer.hpp"
#include "identification/setup/specimen.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_entry(const Place& place, std::string key, std::string found,
                               std::string expected, std::string hint = "") {
  throw Failure(Exit::input, Error{place, std::move(key), std::move(found), std::move(expected),
                                   std::move(hint)});
}

// columns of the table that are keys of an item of `data`
constexpr std::array sizes{"width",   "thickness",      "gauge_length",
                           "width_z", "gauge_length_z", "fibre_angle"};

std::string text_of(const Tree& tree, const std::string& key, const std::string& otherwise) {
  const Tree* value = tree.find(key);
  if (!value || value->kind != Tree::Kind::scalar) return otherwise;
  return value->scalar;
}

// The text with {name} replaced by what `value` says of it; names without a value stay.
template <class Value>
std::string substituted(const std::string& text, Value value) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = text.find('}', i);
    if (text[i] == '{' && end != std::string::npos) {
      const std::string name = text.substr(i + 1, end - i - 1);
      const std::optional<std::string> found = value(name);
      result += found.value_or("{" + name + "}");
      i = end + 1;
    } else {
      result += text[i++];
    }
  }
  return result;
}

std::string substituted(const std::string& text, const SpecimenTable& table, std::size_t row) {
  return substituted(text, [&](const std::string& name) -> std::optional<std::string> {
    if (name == "id") return table.ids[row];
    const auto found = table.texts.find(name);
    if (found == table.texts.end()) return std::nullopt;
    return found->second[row];
  });
}

std::vector<std::string> names_in_braces(const std::string& text) {
  std::vector<std::string> names;
  substituted(text, [&](const std::string& name) -> std::optional<std::string> {
    names.push_back(name);
    return std::nullopt;
  });
  return names;
}

// One part of a path as an expression whose groups are the names in braces.
std::regex expression(const std::string& part) {
  std::string text;
  for (std::size_t i = 0; i < part.size();) {
    const std::size_t end = part.find('}', i);
    if (part[i] == '{' && end != std::string::npos) {
      text += "(.+)";
      i = end + 1;
    } else {
      if (std::string("\\^$.|?*+()[]{}").find(part[i]) != std::string::npos) text += '\\';
      text += part[i++];
    }
  }
  return std::regex(text);
}

struct FoundFile {
  std::string path;  // relative to the folder of the search
  std::map<std::string, std::string> names;
};

// Files below `folder` whose path fits the pattern, in the order of their names.
void find_files(const fs::path& folder, const fs::path& shown,
                const std::vector<std::string>& parts, std::size_t at,
                const std::map<std::string, std::string>& names, std::vector<FoundFile>& found) {
  const std::string& part = parts[at];
  const bool last = at + 1 == parts.size();
  const auto take = [&](const fs::path& name, const std::map<std::string, std::string>& known) {
    std::error_code ignored;
    if (last && fs::is_regular_file(folder / name, ignored)) {
      found.push_back({(shown / name).generic_string(), known});
    } else if (!last && fs::is_directory(folder / name, ignored)) {
      find_files(folder / name, shown / name, parts, at + 1, known, found);
    }
  };
  const std::vector<std::string> wanted = names_in_braces(part);
  if (wanted.empty()) return take(part, names);
  const std::regex pattern = expression(part);
  std::set<std::string> there;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    there.insert(entry.path().filename().string());
  for (const std::string& name : there) {
    std::smatch match;
    if (!std::regex_match(name, match, pattern)) continue;
    std::map<std::string, std::string> known = names;
    bool same = true;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const auto [place, is_new] = known.insert({wanted[i], match[i + 1].str()});
      same = same && (is_new || place->second == match[i + 1].str());
    }
    if (same) take(name, known);
  }
}

std::vector<FoundFile> find_files(const std::string& base, const std::string& pattern) {
  const fs::path path = pattern;
  std::vector<std::string> parts;
  fs::path root = base.empty() ? fs::path(".") : fs::path(base);
  fs::path shown;
  if (path.is_absolute()) {
    root = path.root_path();
    shown = root;
  }
  for (const fs::path& part : path.relative_path()) parts.push_back(part.string());
  std::vector<FoundFile> found;
  if (!parts.empty()) find_files(root, shown, parts, 0, {}, found);
  return found;
}

// A scalar that was not written in the config.
Tree scalar(const std::string& text, const Place& place, const std::string& base) {
  Tree tree = text_tree(text);
  tree.place = place;
  tree.base = base;
  return tree;
}

void put(Tree& item, const std::string& key, Tree value) {
  if (!item.find(key)) item.map.push_back({key, std::move(value)});
}

// What the expansion of one config needs.
struct Expansion {
  const Tree& specimens;
  const Tree& pattern;  // specimens.data
  std::string base;
  Place place;
  SpecimenTable table;
  std::string table_path;
  std::vector<Tree> templates;
  std::vector<Tree> items = {};

  // keys that all items of a specimen have
  void add_item(std::size_t row, const std::string& file, const std::string& test) {
    Tree item;
    item.kind = Tree::Kind::map;
    item.place = place;
    item.base = base;
    put(item, "file", scalar(file, place, base));
    put(item, "specimen", scalar(table.ids[row], table.rows[row], base));
    if (!test.empty()) put(item, "name", scalar(test, place, base));
    if (const Tree* where = specimens.find("where")) {
      Tree texts = *where;
      for (Tree::Entry& one : texts.map) {
        const Place there = one.value.place;
        one.value = scalar(substituted(one.value.scalar, table, row), there, base);
        one.value.quoted = true;
      }
      put(item, "where", texts);
    }
    if (const Tree* split = specimens.find("split")) put(item, "split", *split);
    for (const char* size : sizes) {
      const auto found = table.texts.find(size);
      if (found == table.texts.end()) continue;
      Tree value = plain_tree(found->second[row]);
      value.place = table.rows[row];
      put(item, size, value);
    }
    for (const Tree& one : templates) {
      const std::string name = text_of(one, "name", "");
      if (!name.empty() && name != test) continue;
      for (const Tree::Entry& entry : one.map) put(item, entry.key, entry.value);
    }
    add_keys_of_measured_file(item);
    items.push_back(std::move(item));
  }

  [[noreturn]] void refuse_without_test(std::size_t row, const std::string& what) const {
    refuse_entry(table.rows[row], "specimens",
                 fmt::format("specimen {} without a test", table.ids[row]), what,
                 "leave its row out, or measure it");
  }

  // one file a test, or a specimen
  void add_files() {
    const std::string& text = pattern.scalar;
    std::set<std::string> known;
    for (std::size_t row = 0; row < table.ids.size(); ++row) {
      const std::string own = substituted(text, table, row);
      const std::vector<FoundFile> files = find_files(base, own);
      if (files.empty()) refuse_without_test(row, "a file " + own);
      for (const FoundFile& file : files) {
        known.insert(file.path);
        add_item(row, file.path, value_or(file.names, "test", ""));
      }
    }
    for (const FoundFile& file : find_files(base, text)) {
      if (known.count(file.path)) continue;
      const std::string id = value_or(file.names, "id", file.path);
      refuse_entry(place, "specimens.data",
                   fmt::format("{}: {} is not in {}", file.path, id, table_path),
                   "a row for each specimen that was measured",
                   text_or(did_you_mean(nearest(id, table.ids)), "add its row, or move the file"));
    }
  }

  // one file of all specimens, with a column that names them
  void add_rows_of_one_file() {
    const std::string path = (fs::path(base) / pattern.scalar).lexically_normal().string();
    const Tree* where = specimens.find("where");
    if (!where || where->map.empty()) return;  // SpecimensConfig::complaints() says what is missing
    const CsvTable data = read_table(path);
    std::set<std::vector<std::string>> measured;
    std::vector<std::string> columns;
    for (const CsvCell& cell : data.header.cells) columns.push_back(cell.text);
    std::vector<std::size_t> at;
    for (const Tree::Entry& one : where->map) {
      const auto head = std::ranges::find(data.header.cells, one.key, &CsvCell::text);
      if (head == data.header.cells.end())
        refuse_entry(one.value.place, "specimens.where." + one.key,
                     fmt::format("{} has no column of this name", path),
                     fmt::format("one of {}", fmt::join(columns, ", ")));
      at.push_back(static_cast<std::size_t>(head - data.header.cells.begin()));
    }
    const auto texts_of = [&](const CsvRow& row) {
      std::vector<std::string> texts;
      for (const std::size_t column : at) texts.push_back(row.cells[column].text);
      return texts;
    };
    for (const CsvRow& row : data.rows) measured.insert(texts_of(row));
    std::set<std::vector<std::string>> wanted;
    for (std::size_t row = 0; row < table.ids.size(); ++row) {
      std::vector<std::string> texts;
      for (const Tree::Entry& one : where->map)
        texts.push_back(substituted(one.value.scalar, table, row));
      if (!measured.count(texts))
        refuse_without_test(
            row, fmt::format("rows with {} in {}", fmt::join(texts, ", "), pattern.scalar));
      wanted.insert(texts);
      add_item(row, pattern.scalar, "");
    }
    for (const CsvRow& row : data.rows) {
      const std::vector<std::string> texts = texts_of(row);
      if (wanted.count(texts)) continue;
      refuse_entry({path, row.line, row.cells[at.front()].column}, "specimens.data",
                   fmt::format("{} is not in {}", fmt::join(texts, ", "), table_path),
                   "a row for each specimen that was measured",
                   text_or(did_you_mean(nearest(texts.front(), table.ids)), "add its row"));
    }
  }
};

bool is_number(const std::string& text) { return csv_number(text).has_value(); }

}  // namespace

SpecimenTable read_specimen_table(const std::string& path, const std::string& id_column) {
  const CsvTable csv = read_table(path);
  SpecimenTable table;
  std::size_t id = csv.header.cells.size();
  for (std::size_t i = 0; i < csv.header.cells.size(); ++i) {
    const CsvCell& cell = csv.header.cells[i];
    table.columns.push_back(cell.text);
    table.heads[cell.text] = {path, csv.header.line, cell.column};
    if (cell.text == id_column) id = i;
  }
  if (id == csv.header.cells.size()) {
    if (id_column != "id")
      refuse_entry({path, csv.header.line, 1}, "specimens.id",
                   fmt::format("no column is called {}", id_column),
                   "one of " + fmt::format("{}", fmt::join(table.columns, ", ")),
                   did_you_mean(nearest(id_column, table.columns)));
    id = 0;
  }
  std::set<std::string> seen;
  for (const CsvRow& row : csv.rows) {
    const CsvCell& name = row.cells[id];
    const Place place{path, row.line, name.column};
    if (name.text.empty()) refuse_entry(place, "", "a specimen without a name", "its id");
    if (!seen.insert(name.text).second)
      refuse_entry(place, "", fmt::format("specimen {} a second time", name.text),
                   "each specimen once");
    table.ids.push_back(name.text);
    table.rows.push_back(place);
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      table.texts[table.columns[i]].push_back(row.cells[i].text);
  }
  if (table.ids.size() < 2) {
    const Place place = table.rows.empty() ? Place{path, csv.header.line, 1} : table.rows.front();
    refuse_entry(place, "specimens.table",
                 fmt::format("{} specimen{}", table.ids.size(), plural_s(table.ids.size())),
                 "two at least, for a scatter between them",
                 "a fit of one specimen has its tests under `data` and no `specimens`");
  }
  return table;
}

CovariateColumns covariate_columns(const SpecimenTable& table, const std::string& column,
                                   const Place& asked_at) {
  const auto found = table.texts.find(column);
  if (found == table.texts.end())
    refuse_entry(asked_at, "specimens.covariates", fmt::format("no column is called {}", column),
                 fmt::format("one of {}", fmt::join(table.columns, ", ")),
                 did_you_mean(nearest(column, table.columns)));
  const std::vector<std::string>& texts = found->second;
  const Place& head = table.heads.at(column);
  for (std::size_t row = 0; row < texts.size(); ++row)
    if (is_blank_cell(texts[row]))
      refuse_entry(table.rows[row], column,
                   fmt::format("specimen {} without a value", table.ids[row]), "a number or a word",
                   "leave the covariate out, or the specimen");
  CovariateColumns result;
  const std::set<std::string> different(texts.begin(), texts.end());
  if (different.size() == 1)
    refuse_entry(head, column, fmt::format("{} for every specimen", texts.front()),
                 "a covariate that differs between specimens", "leave it out of covariates");
  if (std::all_of(texts.begin(), texts.end(), is_number)) {
    std::vector<double> values;
    for (const std::string& text : texts) {
      values.push_back(*csv_number(text));
      result.mean += values.back() / static_cast<double>(texts.size());
    }
    double spread = 0;
    for (double& x : values) {
      x -= result.mean;
      spread = std::max(spread, std::abs(x));
    }
    if (!(spread > 1e-12 * std::abs(result.mean)))
      refuse_entry(head, column, fmt::format("{} for every specimen", texts.front()),
                   "a covariate that differs between specimens", "leave it out of covariates");
    result.names.push_back(column);
    result.values.push_back(values);
    return result;
  }
  if (2 * different.size() > texts.size())
    refuse_entry(head, column,
                 fmt::format("{} words for {} specimens", different.size(), texts.size()),
                 "groups of several specimens each, or numbers", "");
  result.reference = *different.begin();
  for (const std::string& word : different) {
    if (word == result.reference) continue;
    std::vector<double> values;
    for (const std::string& text : texts) values.push_back(text == word ? 1 : 0);
    result.names.push_back(column + "=" + word);
    result.values.push_back(values);
  }
  return result;
}

void expand_specimens(Tree& config) {
  const Tree* specimens = config.find("specimens");
  if (!specimens || specimens->kind != Tree::Kind::map) return;
  const Tree* path = specimens->find("table");
  const Tree* pattern = specimens->find("data");
  if (!path || !pattern || path->kind != Tree::Kind::scalar || pattern->kind != Tree::Kind::scalar)
    return;
  std::vector<Tree> templates;
  if (const Tree* data = config.find("data")) {
    for (const Tree& item : data->list) {
      if (item.find("specimen")) return;
      templates.push_back(item);
    }
  }
  const fs::path table = (fs::path(path->base) / path->scalar).lexically_normal();
  if (const std::string reason = unreadable_reason(table.string()); !reason.empty())
    refuse_entry(path->place, "specimens.table", table.string() + ": " + reason,
                 "a CSV file with a row for each specimen");
  Expansion all{*specimens,
                *pattern,
                pattern->base,
                pattern->place,
                read_specimen_table(table.string(), text_of(*specimens, "id", "id")),
                path->scalar,
                templates};
  if (names_in_braces(pattern->scalar).empty()) {
    all.add_rows_of_one_file();
  } else {
    all.add_files();
  }
  if (const Tree* covariates = specimens->find("covariates")) {
    for (const Tree& one : covariates->list) {
      const std::string column =
          one.kind == Tree::Kind::map ? text_of(one, "column", "") : one.scalar;
      covariate_columns(all.table, column, one.place);
    }
  }
  Tree list;
  list.kind = Tree::Kind::list;
  list.place = pattern->place;
  list.base = pattern->base;
  list.list = std::move(all.items);
  for (Tree::Entry& entry : config.map) {
    if (entry.key != "data") continue;
    entry.value = list;
    return;
  }
  config.map.push_back({"data", list});
}

}  // namespace langer

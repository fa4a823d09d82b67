#include "identification/setup/specimen.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/base/error.hpp"
#include "core/base/input_file.hpp"
#include "core/config/reader.hpp"
#include "identification/setup/fit_config.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const Place& place, std::string found, std::string expected,
                         std::string hint = "") {
  throw Failure(Exit::config,
                Error{place, "", std::move(found), std::move(expected), std::move(hint)});
}

// A line `# ---` opens and closes the description in the header of a CSV file.
bool is_fence(const std::string& line) {
  const std::size_t first = line.find_first_not_of("# \t");
  return line.starts_with('#') && first != std::string::npos &&
         line.compare(first, 3, "---") == 0 &&
         line.find_first_not_of("- \t\r", first) == std::string::npos;
}

// the config that is being read, beside its CSV
bool is_this(const fs::path& path, const Place& place) {
  std::error_code ec;
  return fs::equivalent(path, place.file, ec);
}

// Any config may stand beside a CSV of its name: this one is the CSV's if most of its keys are
// those of an item of `data`.
bool is_sidecar(const Tree& tree) {
  static const std::vector<std::string> known = keys_of<FitData>();
  if (tree.kind != Tree::Kind::map) return false;
  const auto is_known = [&](const Tree::Entry& e) {
    return std::find(known.begin(), known.end(), e.key) != known.end() &&
           (e.key != "columns" || e.value.kind != Tree::Kind::list);
  };
  return 2 * std::count_if(tree.map.begin(), tree.map.end(), is_known) >
         static_cast<std::ptrdiff_t>(tree.map.size());
}

}  // namespace

// The YAML description in the header of a CSV file; nothing if there is none.
Tree csv_header(const std::string& text, const std::string& shown_name) {
  // every other line is left empty and the # becomes a blank: lines and columns stay those of the
  // file
  std::istringstream in(text);
  std::string yaml;
  int number = 0, opened_at = 0;
  bool open = false;
  bool closed = false;
  for (std::string line; std::getline(in, line) && !closed;) {
    ++number;
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    const bool comment = line.starts_with('#');
    if (!open && !comment && line.find_first_not_of(" \t\r") != std::string::npos)
      return {};  // the table begins
    if (is_fence(line)) {
      closed = open;
      open = true;
      if (!closed) opened_at = number;
      yaml += "\n";
    } else if (open && !comment) {
      break;
    } else {
      if (open) yaml += " " + line.substr(1);
      yaml += "\n";
    }
  }
  if (!open) return {};
  if (!closed)
    refuse({shown_name, opened_at, 1}, "found a header that does not end",
           "a second line \"# ---\" before the table");
  const Tree tree = parse_yaml(yaml, shown_name);
  if (tree.kind != Tree::Kind::map)
    refuse({shown_name, opened_at, 1},
           "found " + description(tree) + " between the lines \"# ---\"", "a map of keys");
  return tree;
}

// Adds the keys that a measured file, or the YAML file of its name, gives. Keys of the config win.
void add_keys_of_measured_file(Tree& item) {
  const Tree* file = item.find("file");
  if (!file || file->kind != Tree::Kind::scalar || file->scalar.empty()) return;
  const fs::path path = (fs::path(file->base) / file->scalar).lexically_normal();
  if (!unreadable_reason(path.string()).empty()) return;
  const std::string text = read_file(path.string());
  if (text.empty()) return;
  Tree said = csv_header(text, path.string());
  const fs::path beside = fs::path(path).replace_extension(".yaml");
  Tree other;
  if (beside != path && fs::is_regular_file(beside) && !is_this(beside, file->place)) {
    other = load_yaml(beside.string());
  }
  if (other.kind != Tree::Kind::null && is_sidecar(other)) {
    if (said.kind == Tree::Kind::map)
      refuse(said.place, "found a header and the file " + beside.string(), "one of the two",
             "both describe the same test");
    said = other;
  }
  for (const Tree::Entry& entry : said.map) {
    if (entry.key == "file")
      refuse(entry.value.place, "found the key \"file\"",
             "kind, columns, stress and so on: this describes a file that is there");
    if (!item.find(entry.key)) item.map.push_back(entry);
  }
}

}  // namespace langer

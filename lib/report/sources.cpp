// Labels of the files of a report, and the parts of a page that all kinds of files have: a table of
// summaries, and the origin of each file.
#include "report/sources.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "core/hdf5/h5.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/provenance.hpp"

namespace langer::report {

namespace fs = std::filesystem;

namespace {

// Whether a text is a number as a whole; x is then its value.
bool is_number(const std::string& s, double& x) {
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  return !s.empty() && error == std::errc{} && end == s.data() + s.size();
}

// The label of a sweep's folder: alpha_030 is "alpha = 30", law_yeoh is "law: yeoh".
std::string folder_words(const std::string& folder, Source& source) {
  const auto cut = folder.rfind('_');
  if (cut == std::string::npos || cut == 0) return folder;
  std::string value = folder.substr(cut + 1);
  double x = 0;
  if (is_number(value, x)) {
    source.angle = x;
    source.numbered = true;
    return fmt::format("{} = {:g}", folder.substr(0, cut), x);
  }
  const auto first = folder.find('_');
  return fmt::format("{}: {}", folder.substr(0, first), folder.substr(first + 1));
}

// All folders of a path, from the root.
std::vector<std::string> folders_of(const std::string& path) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::absolute(path).lexically_normal().parent_path())
    parts.push_back(part.string());
  return parts;
}

// Whether all paths have the same folder at a place, counted from the front or from the back.
// `front` folders from the front are already known to be shared.
bool all_share(const std::vector<std::vector<std::string>>& paths, std::size_t place,
               bool from_front, std::size_t front) {
  const auto folder_at = [&](const std::vector<std::string>& folders) -> const std::string* {
    if (place + front >= folders.size()) return nullptr;
    if (from_front) return &folders[place];
    return &folders[folders.size() - 1 - place];
  };
  for (const auto& folders : paths) {
    const std::string* folder = folder_at(folders);
    if (!folder || *folder != *folder_at(paths[0])) return false;
  }
  return true;
}

// A quantity of a summary; NaN if the file does not have it.
double value_or_nan(const std::vector<Summary>& summary, const std::string& name) {
  const auto found = std::ranges::find(summary, name, &Summary::name);
  if (found == summary.end()) return std::numeric_limits<double>::quiet_NaN();
  return found->value;
}

// The columns that a post config asked for, in its order; of other files none.
std::vector<std::string> asked_for(const std::string& path) {
  std::vector<std::string> names;
  if (read_origin(path).schema != curves_schema.name) return names;
  for (const Column& c : read_curves(path).curves.columns) names.push_back(c.name);
  return names;
}

// Where a quantity stands in a table: what was asked for first, then the rest as it comes. The
// parts of an error follow the number that they belong to only if that was asked for.
std::size_t rank_of(const std::string& name, const std::vector<std::string>& asked) {
  const auto found = std::ranges::find(asked, name);
  return static_cast<std::size_t>(found - asked.begin());
}

}  // namespace

std::vector<Source> labelled(const std::vector<std::string>& paths) {
  std::vector<std::vector<std::string>> folders;
  for (const std::string& path : paths) folders.push_back(folders_of(path));
  // Number of folders at the beginning and at the end that all paths share.
  std::size_t front = 0;
  std::size_t back = 0;
  if (paths.size() > 1) {
    while (all_share(folders, front, true, 0)) ++front;
    while (all_share(folders, back, false, front)) ++back;
  }
  // The folders between the shared ones are the label.
  std::vector<Source> sources;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    Source source{paths[i], "", 0, false};
    const auto& f = folders[i];
    if (paths.size() == 1) {
      if (f.empty()) {
        source.label = fs::path(paths[i]).stem().string();
      } else {
        source.label = f.back();
      }
    } else
      for (std::size_t k = front; k + back < f.size(); ++k) {
        if (k > front) source.label += ", ";
        source.label += folder_words(f[k], source);
      }
    if (source.label.empty())
      source.label = fs::path(paths[i]).stem().string();  // several files in one folder
    sources.push_back(std::move(source));
  }
  return sources;
}

// A file without one of the quantities has NaN in its row.
void add_summaries(ReportPage& page, const std::string& title, const std::vector<Source>& sources) {
  // The columns are all quantities that any file has, in the order of their first appearance.
  ReportTable table{title, {{"", ""}}, {}};
  std::vector<std::vector<Summary>> all;
  for (const Source& source : sources) {
    all.push_back(read_summary(source.path));
    for (const Summary& s : all.back())
      if (std::ranges::find(table.columns, s.name, &TableColumn::name) == table.columns.end())
        table.columns.push_back({s.name, s.unit});
  }
  if (table.columns.size() == 1) return;
  const std::vector<std::string> asked = asked_for(sources.front().path);
  std::ranges::stable_sort(table.columns.begin() + 1, table.columns.end(), {},
                           [&](const TableColumn& c) { return rank_of(c.name, asked); });
  for (std::size_t i = 0; i < sources.size(); ++i) {
    std::vector<Cell> row{sources[i].label};
    for (std::size_t c = 1; c < table.columns.size(); ++c)
      row.push_back(value_or_nan(all[i], table.columns[c].name));
    table.rows.push_back(std::move(row));
  }
  page.tables.push_back(std::move(table));
}

// Files of old versions lack some of these entries; they are then empty.
void add_origin(ReportPage& page, const Source& source) {
  const Origin origin = read_origin(source.path);
  const h5::File file = h5::File::open(source.path);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  FileOrigin o{
      source.label,      origin.identity.stage,  "",      "",     "", "", origin.identity.command,
      origin.content_id, origin.identity.config, unknown, unknown};
  if (file.root().has("provenance")) {
    const h5::Group p = file.root().group("provenance");
    const auto text = [&](const char* name) {
      if (!p.has(name)) return std::string();
      return p.read_text(name);
    };
    o.made = text("created_utc");
    o.host = text("host");
    o.version = text("code_version");
    o.libraries = text("libraries");
  }
  if (origin.cost) {
    o.wall = origin.cost->wall;
    o.cpu = origin.cost->cpu;
  }
  page.origins.push_back(std::move(o));
}

}  // namespace langer::report

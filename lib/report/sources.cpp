#include "report/sources.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "core/hdf5/h5.hpp"
#include "results/store/provenance.hpp"

namespace langer::report {

namespace fs = std::filesystem;

namespace {

bool is_number(const std::string& s, double& x) {
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
  return !s.empty() && error == std::errc{} && end == s.data() + s.size();
}

// alpha_030: alpha = 30
std::string in_words(const std::string& folder, Source& source) {
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

std::vector<std::string> folders_of(const std::string& path) {
  std::vector<std::string> parts;
  for (const fs::path& part : fs::absolute(path).lexically_normal().parent_path())
    parts.push_back(part.string());
  return parts;
}

}  // namespace

std::vector<Source> labelled(const std::vector<std::string>& paths) {
  std::vector<std::vector<std::string>> folders;
  for (const std::string& path : paths) folders.push_back(folders_of(path));
  std::size_t front = 0, back = 0;  // folders that all share
  const auto all = [&](auto&& part) {
    return std::all_of(folders.begin(), folders.end(),
                       [&](const auto& f) { return part(f) && *part(f) == *part(folders[0]); });
  };
  if (paths.size() > 1) {
    while (all([&](const auto& f) { return front < f.size() ? &f[front] : nullptr; })) ++front;
    while (all(
        [&](const auto& f) { return back + front < f.size() ? &f[f.size() - 1 - back] : nullptr; }))
      ++back;
  }
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
      for (std::size_t k = front; k + back < f.size(); ++k)
        source.label += (k > front ? ", " : "") + in_words(f[k], source);
    if (source.label.empty())
      source.label = fs::path(paths[i]).stem().string();  // several files in one folder
    sources.push_back(std::move(source));
  }
  return sources;
}

void add_summaries(ReportPage& page, const std::string& title, const std::vector<Source>& sources) {
  ReportTable table{title, {{"", ""}}, {}};
  std::vector<std::vector<Summary>> all;
  for (const Source& source : sources) {
    all.push_back(read_summary(source.path));
    for (const Summary& s : all.back())
      if (std::none_of(table.columns.begin(), table.columns.end(),
                       [&](const TableColumn& c) { return c.name == s.name; }))
        table.columns.push_back({s.name, s.unit});
  }
  if (table.columns.size() == 1) return;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    std::vector<Cell> row{sources[i].label};
    for (std::size_t c = 1; c < table.columns.size(); ++c) {
      const auto found = std::find_if(all[i].begin(), all[i].end(), [&](const Summary& s) {
        return s.name == table.columns[c].name;
      });
      row.push_back(found == all[i].end() ? std::numeric_limits<double>::quiet_NaN()
                                          : found->value);
    }
    table.rows.push_back(std::move(row));
  }
  page.tables.push_back(std::move(table));
}

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
      return p.has(name) ? p.read_text(name) : std::string();
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

#include "cli/schemas.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/member.hpp"
#include "core/hdf5/seal.hpp"
#include "pipeline/plan/effective.hpp"
#include "pipeline/plan/pipeline_schema.hpp"

namespace langer {

// All kinds of configs, and pipelines.
std::vector<std::string> schema_kinds() {
  std::vector<std::string> kinds = config_kind_names();
  kinds.push_back("pipeline");
  return kinds;
}

bool has_schema(const std::string& kind) {
  const std::vector<std::string> known = schema_kinds();
  return std::ranges::find(known, kind) != known.end();
}

// An unknown kind is an error that lists the known ones; callers rely on that.
std::string schema_text(const std::string& kind) {
  if (kind == "pipeline") return pipeline::pipeline_schema();
  if (const ConfigKind* known = find_config_kind(kind))
    return known->schema(fmt::format("Langer: {}", kind));
  const std::string near = nearest(kind, schema_kinds());
  throw Failure(Exit::config, Error{{},
                                    "",
                                    fmt::format("found the kind \"{}\"", kind),
                                    "one of " + list_words(schema_kinds()),
                                    did_you_mean(near)});
}

std::string schema_file(const std::string& kind) { return kind + ".schema.json"; }

// The folder may be one that exists: files of the same names are replaced.
std::size_t write_schemas(const std::string& folder) {
  std::error_code ec;
  std::filesystem::create_directories(folder, ec);
  if (!std::filesystem::is_directory(folder)) {
    std::string found = "this folder cannot be made";
    if (ec) found += ": " + ec.message();
    throw Failure(Exit::input, Error{{folder}, "", found, "", ""});
  }
  const std::vector<std::string> kinds = schema_kinds();
  for (const std::string& kind : kinds)
    write_text_file_soon((std::filesystem::path(folder) / schema_file(kind)).string(),
                         schema_text(kind));
  return kinds.size();
}

std::string schema_line(const std::string& kind, const std::string& folder) {
  return fmt::format("# yaml-language-server: $schema={}/{}\n", folder, schema_file(kind));
}

}  // namespace langer

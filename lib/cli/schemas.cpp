#include "cli/schemas.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/member.hpp"
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

std::string schema_line(const std::string& kind, const std::string& folder) {
  return fmt::format("# yaml-language-server: $schema={}/{}\n", folder, schema_file(kind));
}

}  // namespace langer

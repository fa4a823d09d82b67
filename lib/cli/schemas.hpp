// The JSON Schema of every kind of YAML file: configs of the stages, materials, pipelines.
//
// An editor with a YAML language server completes keys and shows errors while a config is written,
// if the file's first line names its schema. The schemas are made from the listings of keys by
// which the programs read the configs, so both have the same rules.
#pragma once

#include <string>
#include <vector>

namespace langer {

// Names of the kinds: "mesh", "solve", ..., "material", "pipeline".
std::vector<std::string> schema_kinds();
bool has_schema(const std::string& kind);
std::string schema_text(const std::string& kind);  // throws Failure(config) with the known kinds
std::string schema_file(const std::string& kind);  // "solve.schema.json"
// Writes the schemas of all kinds into a folder, which is made; the number of files.
std::size_t write_schemas(const std::string& folder);
// The comment by which an editor finds the schema. `folder`: of the schema, relative to the file.
std::string schema_line(const std::string& kind, const std::string& folder);

}  // namespace langer

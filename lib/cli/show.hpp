// The content of a file that Langer made, in words (`langer show`): the command and inputs that it
// was made from, its parts by kind of file, and its summary.
#pragma once

#include <string>

namespace langer {

std::string show(const std::string& path);         // throws Failure(input)
std::string show_config(const std::string& path);  // the effective YAML in /provenance
// One JSON object: schema, content_id and the summary by column name.
std::string show_summary(const std::string& path);

}  // namespace langer

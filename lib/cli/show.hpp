// What is in a file of ours, in words: who made it from what, its parts by kind of file, and its
// summary.
#pragma once

#include <string>

namespace langer {

std::string show(const std::string& path);         // throws Failure(input)
std::string show_config(const std::string& path);  // the effective YAML in /provenance
std::string show_summary(
    const std::string& path);  // one JSON object: schema, content_id and the summary by column name

}  // namespace langer

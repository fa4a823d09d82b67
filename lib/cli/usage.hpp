// What every program takes and gives, as one table: its --help, its man page and the shell's
// completion come from it, and the argument parser refuses to know an option that the table lacks
// (stages/common/arguments.cpp).
#pragma once

#include <string>
#include <vector>

#include "core/config/writer.hpp"
#include "pipeline/plan/ports.hpp"

namespace langer {

struct UsageOption {
  std::string flags;  // "-o,--output", "--mesh", "CONFIG" (a place in the line)
  std::string value;  // "FILE", "" for a switch
  std::string says;
  std::string
      files;  // endings of the files it takes, separated by spaces: "h5 yaml"; for completion
  std::vector<std::string> words;  // or the words it takes
  bool required = false;
};

struct Usage {
  std::string program;   // "langer-solve", "langer show"
  std::string sentence;  // first line
  std::vector<UsageOption> options;
  std::vector<DescribedKey> keys;  // top keys of its config
  std::string reference;           // all of them, for the man page
  std::string examples;            // one command a line
  std::string more;                // closing remarks of the man page

  const UsageOption* find(const std::string& flag) const;
};

Usage usage_of(const StageSpec& stage, std::vector<DescribedKey> keys, std::string reference);
Usage plan_usage();
std::string help_text(const Usage& usage);
extern const char* const exit_codes;  // one line

// parts of these pages
std::vector<UsageOption> common_options();           // --quiet ... --version
std::string option_text(const UsageOption& option);  // "-o, --output FILE"
bool is_place(const UsageOption& option);            // a place in the line, not an option
std::string synopsis(const Usage& usage);

// manual.cpp: of all programs; knows every stage's config
Usage usage_of(const StageSpec& stage);
Usage langer_usage();                         // of `langer` as a whole
const std::vector<Usage>& langer_commands();  // show, new, check, ...
std::vector<Usage> all_usages();              // every program, `langer` with its commands
std::string man_text(const Usage& usage);     // troff, section 1
std::string completion_text();                // bash, for all programs

}  // namespace langer

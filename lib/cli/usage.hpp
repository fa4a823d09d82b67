// The options of every program in one table. --help and the completion of the shell are made from
// it, and the man pages from --help. The argument parser refuses an option that the table lacks
// (stages/common/arguments.cpp), so these pages are always complete.
#pragma once

#include <string>
#include <vector>

#include "core/config/writer.hpp"
#include "pipeline/plan/ports.hpp"

namespace langer {

// One option, or one positional argument.
struct UsageOption {
  std::string flags;  // "-o,--output", "--mesh", or "CONFIG" for a positional argument
  std::string value;  // "FILE", "" for a switch
  std::string says;
  std::string files;  // for completion: extensions of the files it takes, such as "h5 yaml"
  std::vector<std::string> words;  // for completion: the words it takes
  bool required = false;
};

// The page of one program or command.
struct Usage {
  std::string program;   // "langer-solve", "langer show"
  std::string sentence;  // first line
  std::vector<UsageOption> options;
  std::vector<DescribedKey> keys;  // top keys of its config
  std::string examples;            // one command a line
  std::string more;                // closing remarks

  const UsageOption* find(const std::string& flag) const;
};

Usage usage_of(const StageSpec& stage, std::vector<DescribedKey> keys);
Usage plan_usage();
std::string help_text(const Usage& usage);
extern const char* const exit_codes;  // one line

// Parts of these pages.
std::vector<UsageOption> common_options();           // --quiet ... --version
std::string option_text(const UsageOption& option);  // "-o, --output FILE"
bool is_place(const UsageOption& option);            // a positional argument
std::string synopsis(const Usage& usage);
std::string usage_line(const Usage& usage);  // synopsis, or "langer COMMAND [options]"

// In manual.cpp, which includes the configs of all stages:
Usage usage_of(const StageSpec& stage);
Usage langer_usage();                         // of `langer` as a whole
const std::vector<Usage>& langer_commands();  // show, new, check, ...
std::vector<Usage> all_usages();              // every program, `langer` with its commands
std::string completion_text();                // bash, for all programs

}  // namespace langer

// What every program of ours does around its work: data on stdout, a log, signals, and a message
// and an exit code for what is thrown.
//
// stdout is for data (--json, --describe); stderr for everything said to the person who waits.
#pragma once

#include <functional>
#include <string>

namespace langer {

// Data on stdout, to its end; a reader who has seen enough (`| head`) is no error, a full disk is:
// throws Failure(input).
void put_out(const std::string& text);

std::string version_line(const std::string& program);
std::string command_line(int argc, char** argv);

// What --log keeps: all that is said, and how it ended.
class RunLog {
 public:
  ~RunLog();
  // `goes_on`: the run may continue one that was stopped. Throws Failure(input).
  void open(const std::string& path, const std::string& command, bool goes_on);
};

// The only program whose work several ranks share; of any other those beside the first end at once.
inline constexpr const char* shared_by_ranks = "langer-solve";

// Runs the body, turns what it throws into a message and an exit code, and leaves the program.
[[noreturn]] int guarded(const std::string& program, const std::function<int()>& body);

}  // namespace langer

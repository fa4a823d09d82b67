// The frame of every program: data on stdout, a log, signals, and a message with an exit code for
// each exception.
//
// stdout has data only (--json, --describe), so that it can be read by another program; all
// messages are on stderr.
#pragma once

#include <functional>
#include <string>

namespace langer {

// Writes data to stdout. A closed pipe (`| head`) is not an error; a full disk is: throws
// Failure(input).
void put_out(const std::string& text);

std::string version_line(const std::string& program);
std::string command_line(int argc, char** argv);

// The file of --log: all messages, and a last line with exit code, time and memory.
class RunLog {
 public:
  ~RunLog();
  // `continued`: the run may continue one that was stopped, so the log is continued, too. Throws
  // Failure(input).
  void open(const std::string& path, const std::string& command, bool continued);
};

// The only program whose work several ranks share. Of other programs all ranks but the first end at
// once.
inline constexpr const char* shared_by_ranks = "langer-solve";

// Runs the body, turns an exception into a message and an exit code, and ends the program.
[[noreturn]] int guarded(const std::string& program, const std::function<int()>& body);

}  // namespace langer

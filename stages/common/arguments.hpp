// The options of a program, read by CLI11, which no other file includes. Their help texts are in
// the table of cli/usage.hpp; all programs have --help.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/usage.hpp"

namespace langer {

class Arguments {
 public:
  explicit Arguments(std::string program);
  ~Arguments();

  // Each function names an option and the variable that gets its value. A name without dashes is a
  // positional argument.
  void flag(const std::string& name, bool& given = nowhere);
  void text(const std::string& name, std::string& given, bool required = false);
  // One value each time the option is given; a positional argument gets all values.
  void texts(const std::string& name, std::vector<std::string>& given, bool required = false);
  // As text(), with a list of one value.
  void text(const std::string& name, std::vector<std::string>& given, bool required);
  void version();

  // Reads the command line. False if nothing is left to do (--help, --version, an error), then
  // `code` is the exit code. --help and --version are answered even if required arguments are
  // missing. Throws std::logic_error if the table of usage lacks an option, which is a bug.
  bool read(const Usage& usage, int argc, char** argv, int& code);

 private:
  static bool nowhere;
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace langer

// The options of a program, read by CLI11, which is named nowhere else. They stand in the table of
// usage with their words; --help is one of all.
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

  // where the value goes; a name without dashes is a place
  void flag(const std::string& name, bool& given = nowhere);
  void text(const std::string& name, std::string& given, bool required = false);
  // one value each time it is named; of a place all that stand there
  void texts(const std::string& name, std::vector<std::string>& given, bool required = false);
  // as text(), into a list of one
  void text(const std::string& name, std::vector<std::string>& given, bool required);
  void version();

  // False if the program has said all it was asked for, then `code` is its exit code. --help and
  // --version are answered whatever else is missing. An option that the table lacks is an error of
  // ours: throws std::logic_error.
  bool read(const Usage& usage, int argc, char** argv, int& code);

 private:
  static bool nowhere;
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace langer

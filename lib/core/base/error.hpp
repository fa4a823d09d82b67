// What went wrong, where, and what to do: the one shape of every message.
// Parts in order: place, key path, what was found, what was expected, a hint.
// Thrown only at the borders (config, store, geometry, stages); numerics return statuses.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace langer {

struct Place {
  std::string file;
  int line = 0;  // from 1; 0: the file as a whole
  int column = 0;
};

struct Error {
  Place where;
  std::string key;       // path of keys, e.g. contacts[0].friction; may be empty
  std::string found;     // what was found, or the whole sentence if nothing was expected
  std::string expected;  // may be empty
  std::string hint;      // may be empty
};

// Exit codes of every program; documented in README and never renumbered.
// input: a file that is read or written, its folder and disk, or the memory; stopped by a signal:
// 128 + signal.
enum class Exit : int {
  ok = 0,
  bug = 1,
  config = 2,
  input = 3,
  not_converged = 4,
  not_accurate = 5
};

// "file:line:col: key: found X; expected Y\n  hint: Z"
std::string text(const Error& error);

class Failure : public std::exception {
 public:
  Failure(Exit code, std::vector<Error> errors);
  Failure(Exit code, Error error);
  const char* what() const noexcept override { return message_.c_str(); }
  Exit code() const { return code_; }
  const std::vector<Error>& errors() const { return errors_; }

 private:
  Exit code_;
  std::vector<Error> errors_;
  std::string message_;
};

// The name in `known` nearest to `name`, or "" if none is near.
std::string nearest(const std::string& name, const std::vector<std::string>& known);

}  // namespace langer

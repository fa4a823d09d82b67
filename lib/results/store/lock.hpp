// One run at a time writes an output: <output>.lock, held while the run lives, names it to the next
// one. The kernel lets go of the lock when the process ends, however it ends; a lock file left by
// kill -9 is in nobody's way.
#pragma once

#include <string>

namespace langer {

class OutputLock {
 public:
  // throws Failure(input): another run writes this output (pid, host, since when, command), or the
  // folder cannot be written
  OutputLock(const std::string& output, const std::string& command);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::string path_;
  int fd_ = -1;
};

}  // namespace langer

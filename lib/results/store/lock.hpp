// Only one run at a time writes an output. It holds a lock on <output>.lock as long as it lives;
// the file names the run to others. The kernel releases the lock when the process ends, however it
// ends, so a lock file left by kill -9 does not block anything.
#pragma once

#include <string>

namespace langer {

// Holds the lock from construction to destruction.
class OutputLock {
 public:
  // Throws Failure(input) if another run writes this output (with its pid, host, time and
  // command), or if the folder cannot be written.
  OutputLock(const std::string& output, const std::string& command);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  std::string path_;
  int fd_ = -1;
};

}  // namespace langer

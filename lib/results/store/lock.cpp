#include "results/store/lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/output_file.hpp"

namespace langer {

namespace {

// The line that names this run to others.
std::string this_run(const std::string& command) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format("pid {} on {} since {:%Y-%m-%dT%H:%M:%SZ}: {}\n", getpid(), host,
                     fmt::gmtime(std::time(nullptr)), command);
}

// The first line of a lock file.
std::string content(int fd) {
  char text[1024];
  const ssize_t n = std::max<ssize_t>(pread(fd, text, sizeof text, 0), 0);
  const std::string all(text, static_cast<std::size_t>(n));
  return all.substr(0, all.find('\n'));
}

// Whether the path still names this file: the last holder may have removed it after it was opened.
bool is_named(int fd, const std::string& path) {
  struct stat opened {};
  struct stat named {};
  return fstat(fd, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

// The file is opened, locked and then checked for its name: if the last holder has removed it in
// between, the lock is on a file without a name and the loop tries again.
OutputLock::OutputLock(const std::string& output, const std::string& command)
    : path_(output + ".lock") {
  while (true) {
    fd_ = open_kept_file(path_);
    if (fd_ < 0)
      throw Failure(Exit::input, Error{{output},
                                       "",
                                       fmt::format("cannot be written ({})", std::strerror(errno)),
                                       "",
                                       "does the folder exist, and may it be written?"});
    const std::string holder = content(fd_);
    // A file of this name that is not a lock belongs to the user and must not be overwritten.
    if (!holder.empty() && !holder.starts_with("pid ")) {
      close(fd_);
      throw Failure(Exit::input, Error{{path_},
                                       "",
                                       "is there already and is no lock of langer",
                                       "",
                                       "remove or rename it, or choose another output (-o)"});
    }
    if (flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK) return;  // a file system without locks
      std::string message = "is being written by another run";
      const std::string other = content(fd_);
      if (!other.empty()) message += ", " + other;
      close(fd_);
      throw Failure(Exit::input, Error{{output}, "", message, "", "wait for it, or end it"});
    }
    if (is_named(fd_, path_)) break;
    close(fd_);
  }
  const std::string text = this_run(command);
  // On a full disk the lock file stays empty, but the lock holds.
  if (ftruncate(fd_, 0) == 0 && lseek(fd_, 0, SEEK_SET) == 0) write_bytes_to(fd_, text);
}

OutputLock::~OutputLock() {
  unlink(path_.c_str());
  close(fd_);
}

}  // namespace langer

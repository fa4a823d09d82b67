#include "results/store/lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/output_file.hpp"

namespace langer {

namespace {

std::string this_run(const std::string& command) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format("pid {} on {} since {:%Y-%m-%dT%H:%M:%SZ}: {}\n", getpid(), host,
                     fmt::gmtime(std::time(nullptr)), command);
}

std::string content(int fd) {
  char text[1024];
  const ssize_t n = pread(fd, text, sizeof text, 0);
  std::string all(text, static_cast<std::size_t>(n > 0 ? n : 0));
  return all.substr(0, all.find('\n'));
}

// the name still leads to this file: its last holder may have removed it after we opened it
bool is_named(int fd, const std::string& path) {
  struct stat opened {
  }, named{};
  return fstat(fd, &opened) == 0 && stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

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
    std::string holder = content(fd_);
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
      holder = content(fd_);
      close(fd_);
      throw Failure(Exit::input,
                    Error{{output},
                          "",
                          "is being written by another run" + (holder.empty() ? "" : ", " + holder),
                          "",
                          "wait for it, or end it"});
    }
    if (is_named(fd_, path_)) break;
    close(fd_);
  }
  const std::string text = this_run(command);
  // A full disk leaves the lock without words; it holds all the same.
  if (ftruncate(fd_, 0) == 0 && lseek(fd_, 0, SEEK_SET) == 0) write_bytes_to(fd_, text);
}

OutputLock::~OutputLock() {
  unlink(path_.c_str());
  close(fd_);
}

}  // namespace langer

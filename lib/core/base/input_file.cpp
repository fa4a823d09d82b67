#include "core/base/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/memory.hpp"

namespace langer {

namespace {

std::string reason_of_kind(mode_t mode) {
  if (S_ISREG(mode)) return "";
  if (S_ISDIR(mode)) return "this is a folder, not a file";
  if (S_ISFIFO(mode)) return "this is a pipe, not a file";
  if (S_ISSOCK(mode)) return "this is a socket, not a file";
  return "this is a device, not a file";
}

std::string reason_of_errno() {
  if (errno == ENOENT || errno == ENOTDIR) return "there is no such file";
  return fmt::format("cannot be read ({})", std::strerror(errno));
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number(number) {}
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  const int number;
};

}  // namespace

std::string unreadable_reason(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return reason_of_errno();
  const std::string reason = reason_of_kind(status.st_mode);
  if (!reason.empty()) return reason;
  if (access(path.c_str(), R_OK) != 0) return reason_of_errno();
  return "";
}

std::string read_file(const std::string& path, const std::string& expected) {
  const auto refuse = [&](const std::string& reason) {
    throw Failure(Exit::input, Error{{path}, "", reason, expected, ""});
  };
  const std::string unreadable = unreadable_reason(path);
  if (!unreadable.empty()) refuse(unreadable);

  // The path may lead to something else by now: O_NONBLOCK keeps a pipe from waiting, and the
  // kind is looked at once more on what was opened.
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (file.number < 0) refuse(reason_of_errno());
  struct stat status {};
  if (fstat(file.number, &status) != 0) refuse(reason_of_errno());
  const std::string kind = reason_of_kind(status.st_mode);
  if (!kind.empty()) refuse(kind);

  const double most_bytes = 0.5 * free_memory();
  const auto check_size = [&](double bytes) {
    if (bytes > most_bytes)
      refuse(fmt::format("{:.3g} GB, more than half of the free memory", bytes / 1e9));
  };
  check_size(static_cast<double>(status.st_size));
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(status.st_size));
  std::array<char, 1 << 16> block;
  while (true) {
    const ssize_t n = read(file.number, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(reason_of_errno());
    if (n == 0) return bytes;
    bytes.append(block.data(), static_cast<std::size_t>(n));
    check_size(static_cast<double>(bytes.size()));
  }
}

}  // namespace langer

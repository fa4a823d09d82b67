#include "core/base/output_file.hpp"
#include "core/base/text.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>

#include <fmt/format.h>

#include "core/base/error.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const std::string& path, std::string found, std::string hint) {
  throw Failure(Exit::input, Error{{path}, "", std::move(found), "", std::move(hint)});
}

[[noreturn]] void refuse_unwritable(const std::string& path) {
  refuse(path, fmt::format("cannot be written ({})", std::strerror(errno)),
         "does the folder exist, and may it be written?");
}

[[noreturn]] void refuse_link(const std::string& path) {
  std::error_code none;
  refuse(path, "is a link to " + fs::read_symlink(path, none).string(),
         "remove the link: a run writes plain files only");
}

constexpr std::string_view hidden_prefix = ".langer-";
constexpr std::size_t hidden_digits = 16;

// A hidden name next to the file. The operating system's random numbers make it unpredictable, so
// that nobody can lay a link there first.
std::string unpredictable_name() {
  std::random_device random;
  return fmt::format("{}{:08x}{:08x}", hidden_prefix, random(), random());
}

int create_exclusively(const std::string& path) {
  return ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

// Throws unless `path` is a plain file itself, not a link to one.
void require_plain_file(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) refuse_unwritable(path);
  if (S_ISLNK(status.st_mode)) refuse_link(path);
  if (S_ISDIR(status.st_mode)) refuse(path, "is a folder", "remove or rename it");
  if (!S_ISREG(status.st_mode)) {
    refuse(path, "is no plain file (a device, FIFO or socket)", "remove or rename it");
  }
}

// The lock of a private folder tells other runs that its owner lives. The system releases it when
// the owner ends, however it ends.
int lock_folder(const fs::path& folder, int how) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0) return -1;
  if (::flock(fd, how) == 0) return fd;
  ::close(fd);
  return -1;
}

// Removes private folders that killed runs have left.
void remove_abandoned_folders(const std::string& parent) {
  std::error_code failed;
  std::vector<fs::path> abandoned;
  for (const auto& entry : fs::directory_iterator(text_or(parent, "."), failed)) {
    const std::string name = entry.path().filename();
    const bool ours = name.starts_with(hidden_prefix) &&
                      name.size() == hidden_prefix.size() + hidden_digits &&
                      name.find_first_not_of("0123456789abcdef", hidden_prefix.size()) == name.npos;
    if (ours && entry.is_directory(failed) && !entry.is_symlink(failed))
      abandoned.push_back(entry.path());
  }
  for (const fs::path& folder : abandoned) {
    const int fd = lock_folder(folder, LOCK_EX | LOCK_NB);
    if (fd < 0) continue;  // its owner lives
    fs::remove_all(folder, failed);
    ::close(fd);
  }
}

}  // namespace

int create_file(const std::string& path) {
  const int created = create_exclusively(path);
  if (created >= 0) return created;
  if (errno != EEXIST) refuse_unwritable(path);
  require_plain_file(path);

  // The old file keeps its name until the new one takes it: a run that is killed here still finds
  // the <output>.part that its journal belongs to.
  const std::string fresh = (fs::path(path).parent_path() / unpredictable_name()).string();
  const int fd = create_exclusively(fresh);
  if (fd < 0) refuse_unwritable(path);
  if (::rename(fresh.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    ::close(fd);
    ::unlink(fresh.c_str());
    errno = reason;
    refuse_unwritable(path);
  }
  return fd;
}

int open_kept_file(const std::string& path) {
  // O_NONBLOCK: the open of a FIFO must not wait for somebody at its other end.
  const int flags = O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  const int fd = ::open(path.c_str(), flags, 0644);
  if (fd < 0) {
    if (errno == ELOOP) refuse_link(path);
    return -1;
  }
  struct stat status {};
  const bool known = ::fstat(fd, &status) == 0;
  if (known && S_ISREG(status.st_mode) && status.st_nlink <= 1) return fd;
  ::close(fd);
  if (known && S_ISREG(status.st_mode)) {
    refuse(path, "is a hard link to a file in another place",
           "remove it: a run would write into that file");
  }
  refuse(path, "is no plain file (a device, FIFO or socket)", "remove or rename it");
}

std::FILE* open_log_file(const std::string& path, bool append) {
  struct stat status {};
  const bool there = ::lstat(path.c_str(), &status) == 0;
  int fd = -1;
  if (there && S_ISCHR(status.st_mode)) {
    fd = ::open(path.c_str(), O_WRONLY | O_NOFOLLOW | O_NOCTTY | O_CLOEXEC);
  } else if (there && append) {
    fd = open_kept_file(path);
    if (fd >= 0) ::lseek(fd, 0, SEEK_END);
  } else {
    fd = create_file(path);
  }
  if (fd < 0) return nullptr;
  std::FILE* const log = ::fdopen(fd, "w");
  if (!log) ::close(fd);
  return log;
}

bool write_bytes_to(int fd, std::string_view bytes) {
  constexpr std::size_t most_at_once = 1u << 30;
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), std::min(bytes.size(), most_at_once));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

bool append_durably(const std::string& path, std::string_view bytes) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0) return false;
  const bool written = write_bytes_to(fd, bytes) && ::fsync(fd) == 0;
  const int reason = errno;
  ::close(fd);
  errno = reason;
  return written;
}

// The lock is kept until the process ends. Another run may remove the folder between its making
// and its lock; then the next name is tried.
std::string make_private_folder(const std::string& parent) {
  remove_abandoned_folders(parent);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const std::string name = unpredictable_name();
    const fs::path folder = fs::path(parent) / name;
    if (::mkdir(folder.c_str(), 0700) != 0) return "";
    const int fd = lock_folder(folder, LOCK_EX);
    if (fd < 0 || fs::exists(folder)) return name;
    ::close(fd);
  }
  errno = EEXIST;
  return "";
}

void make_folder_below(const std::string& root, const std::string& folder) {
  std::error_code failed;
  fs::create_directories(text_or(root, "."), failed);
  fs::path reached = root;
  for (const fs::path& part : fs::path(folder).lexically_relative(text_or(root, "."))) {
    reached /= part;
    if (fs::is_symlink(fs::symlink_status(reached, failed))) refuse_link(reached.string());
    fs::create_directory(reached, failed);
  }
  if (fs::is_directory(folder)) return;
  std::string found = "this folder cannot be made";
  if (failed) found += ": " + failed.message();
  refuse(folder, std::move(found), "");
}

}  // namespace langer

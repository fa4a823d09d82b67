#include "serve/folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/output_file.hpp"
#include "core/base/printable.hpp"
#include "core/base/split.hpp"
#include "core/hdf5/seal.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& found) {
  throw Failure(Exit::input, Error{{path}, "", found, "", ""});
}

// A file descriptor that closes itself.
struct Open {
  int fd = -1;
  ~Open() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

std::string refused_path(const std::string& relative) {
  if (relative.size() > 1000) return "is too long";
  if (!relative.empty() && relative.front() == '/') return "is an absolute path";
  for (const char c : relative)
    if (is_control(c) || c == '\\') return "has a letter that is not allowed";
  if (relative.empty()) return "";
  for (const std::string& part : split(relative, '/')) {
    if (part.empty()) return "has an empty part";
    if (part == "..") return "leads out of the folder";
    if (part.front() == '.') return "has a hidden part";
  }
  return "";
}

std::string below(const std::string& project, const std::string& name) {
  if (project.empty()) return name;
  return project + "/" + name;
}

// The folder is opened once. All paths are walked from this descriptor, so that it stays the same
// folder if its name is given to another one.
ServedFolder::ServedFolder(const std::string& path) {
  std::error_code failed;
  fs::create_directories(path, failed);
  path_ = fs::canonical(path, failed).string();
  if (failed) refuse(path, "this folder cannot be made: " + failed.message());
  fd_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd_ < 0) refuse(path, fmt::format("cannot be opened ({})", std::strerror(errno)));
}

ServedFolder::~ServedFolder() {
  if (fd_ >= 0) ::close(fd_);
}

// Walks from part to part. The last one is opened with `flags`.
int ServedFolder::open_below(const std::string& relative, int flags) const {
  if (const std::string why = refused_path(relative); !why.empty()) refuse(relative, why);
  if (relative.empty()) return ::openat(fd_, ".", flags | O_CLOEXEC);
  const std::vector<std::string> parts = split(relative, '/');
  Open here;
  int from = fd_;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    int how = O_RDONLY | O_DIRECTORY;
    if (i + 1 == parts.size()) how = flags;
    const int next = ::openat(from, parts[i].c_str(), how | O_NOFOLLOW | O_CLOEXEC);
    if (next < 0) {
      struct stat status {};
      const bool link = ::fstatat(from, parts[i].c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0 &&
                        S_ISLNK(status.st_mode);
      if (link) refuse(relative, "is a link, or leads through one");
      return -1;
    }
    if (here.fd >= 0) ::close(here.fd);
    here.fd = next;
    from = next;
  }
  return std::exchange(here.fd, -1);
}

// O_NONBLOCK: a FIFO would wait for a writer before it can be refused.
std::string ServedFolder::read(const std::string& relative, std::size_t largest) const {
  const Open file{open_below(relative, O_RDONLY | O_NONBLOCK)};
  if (file.fd < 0) refuse(relative, "there is no such file");
  struct stat status {};
  if (::fstat(file.fd, &status) != 0 || !S_ISREG(status.st_mode))
    refuse(relative, "is no plain file");
  if (static_cast<std::size_t>(status.st_size) > largest)
    refuse(relative, fmt::format("is larger than {} bytes", largest));
  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
  std::size_t n = 0;
  while (n < bytes.size()) {
    const ssize_t got = ::read(file.fd, bytes.data() + n, bytes.size() - n);
    if (got <= 0) break;
    n += static_cast<std::size_t>(got);
  }
  bytes.resize(n);
  return bytes;
}

// A path that is refused throws here, too: the answer "no" would hide an attempt.
bool ServedFolder::has_file(const std::string& relative) const {
  const Open file{open_below(relative, O_RDONLY | O_NONBLOCK)};
  struct stat status {};
  return file.fd >= 0 && ::fstat(file.fd, &status) == 0 && S_ISREG(status.st_mode);
}

bool ServedFolder::has_folder(const std::string& relative) const {
  const Open folder{open_below(relative, O_RDONLY | O_DIRECTORY)};
  return folder.fd >= 0;
}

// Links are left out, and so is what has a name that would be refused.
std::vector<std::string> ServedFolder::list(const std::string& relative, bool folders) const {
  std::vector<std::string> names;
  const int fd = open_below(relative, O_RDONLY | O_DIRECTORY);
  if (fd < 0) return names;
  DIR* folder = ::fdopendir(fd);
  if (!folder) {
    ::close(fd);
    return names;
  }
  while (const dirent* entry = ::readdir(folder)) {
    struct stat status {};
    if (!refused_path(entry->d_name).empty() ||
        ::fstatat(fd, entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0)
      continue;
    const bool wanted = folders ? S_ISDIR(status.st_mode) : S_ISREG(status.st_mode);
    if (wanted) names.emplace_back(entry->d_name);
  }
  ::closedir(folder);
  std::ranges::sort(names);
  return names;
}

std::vector<std::string> ServedFolder::files(const std::string& relative) const {
  return list(relative, false);
}
std::vector<std::string> ServedFolder::folders(const std::string& relative) const {
  return list(relative, true);
}

// Written through <name>.part and a rename, so that a reader never sees half a file.
void ServedFolder::replace(const std::string& relative, const std::string& text) const {
  if (!has_file(relative)) refuse(relative, "there is no such file");
  write_text_file(absolute(relative), text);
}

// Nothing that exists is replaced, also no empty file.
void ServedFolder::create(const std::string& relative, const std::string& bytes) const {
  const Open there{open_below(relative, O_RDONLY | O_NONBLOCK)};
  if (there.fd >= 0) refuse(relative, "is there already");
  write_text_file(absolute(relative), bytes);
}

// The folders on the way are walked, so that none of them is a link.
std::string ServedFolder::absolute(const std::string& relative) const {
  if (const std::string why = refused_path(relative); !why.empty()) refuse(relative, why);
  const std::string folder = fs::path(relative).parent_path().string();
  if (!has_folder(folder)) refuse(relative, "there is no such folder");
  if (relative.empty()) return path_;
  return path_ + "/" + relative;
}

}  // namespace langer

#include "results/store/journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/output_file.hpp"
#include "core/hdf5/checksum.hpp"
#include "core/hdf5/seal.hpp"

namespace langer {

namespace {

constexpr std::string_view magic = "langer journal 1\n";
constexpr std::uint64_t header = magic.size() + sizeof(std::uint64_t);

[[noreturn]] void cannot_write(const std::string& path, const char* hint) {
  throw Failure(
      Exit::input,
      Error{{path}, "", fmt::format("cannot be written ({})", std::strerror(errno)), "", hint});
}

// Reads bytes from a position; false if the file ends before.
bool read_at(int fd, std::uint64_t at, void* to, std::uint64_t bytes) {
  char* place = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t n =
        ::pread(fd, place, std::min<std::uint64_t>(bytes, 1u << 30), static_cast<off_t>(at));
    if (n <= 0) return false;
    place += n;
    at += static_cast<std::uint64_t>(n);
    bytes -= static_cast<std::uint64_t>(n);
  }
  return true;
}

// Writes bytes at a position; false with errno if that fails.
bool write_at(int fd, std::uint64_t at, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(fd, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 30),
                               static_cast<off_t>(at));
    if (n <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
    at += static_cast<std::uint64_t>(n);
  }
  return true;
}

std::string_view bytes_of(const std::uint64_t& word) {
  return {reinterpret_cast<const char*>(&word), sizeof word};
}

std::uint64_t size_of(int fd) {
  struct stat file {};
  if (::fstat(fd, &file) == 0) return static_cast<std::uint64_t>(file.st_size);
  return 0;
}

}  // namespace

Journal::Journal(const std::string& path) : path_(path) {
  fd_ = open_kept_file(path);
  if (fd_ < 0) cannot_write(path, "does the folder exist, and may it be written?");
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(fd_);
    throw Failure(
        Exit::input,
        Error{{path}, "", "is being written by another run", "", "wait for it, or end it"});
  }
  if (size_of(fd_) == 0) {
    clear();
    return;
  }
  find_first();
}

Journal::Journal(const std::string& path, ReadOnly) : path_(path) {
  fd_ = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd_ >= 0) find_first();
}

// A file with another begin keeps end_ = 0: it has no records.
void Journal::find_first() {
  std::string begin(magic.size(), '\0');
  std::uint64_t seed = 0;
  if (read_at(fd_, 0, begin.data(), begin.size()) && begin == magic &&
      read_at(fd_, magic.size(), &seed, sizeof seed)) {
    end_ = header;
    chain_ = seed;
    seed_ = seed;
  }
}

Journal::~Journal() {
  if (fd_ < 0) return;
  ::fdatasync(fd_);
  ::close(fd_);
}

// Reads length, bytes and checksum. A length beyond the end of the file is damage, and nothing is
// allocated for it.
std::optional<std::string> Journal::next() {
  std::uint64_t length = 0, sum = 0;
  const std::uint64_t size = size_of(fd_);
  if (end_ == 0 || !read_at(fd_, end_, &length, sizeof length) || length > size - end_) return {};
  std::string record(length, '\0');
  const std::uint64_t at = end_ + sizeof length;
  if (!read_at(fd_, at, record.data(), length) || !read_at(fd_, at + length, &sum, sizeof sum))
    return {};
  if (sum != checksum(record, chain_)) return {};
  end_before_ = std::exchange(end_, at + length + sizeof sum);
  chain_before_ = std::exchange(chain_, sum);
  return record;
}

bool Journal::replaced() const {
  struct stat here {};
  struct stat named {};
  if (fd_ < 0 || ::fstat(fd_, &here) != 0 || ::lstat(path_.c_str(), &named) != 0) return true;
  if (here.st_ino != named.st_ino || here.st_dev != named.st_dev) return true;
  std::uint64_t seed = 0;
  return end_ == 0 || !read_at(fd_, magic.size(), &seed, sizeof seed) || seed != seed_;
}

void Journal::put_back() {
  end_ = end_before_;
  chain_ = chain_before_;
}

bool Journal::at_end() const { return end_ > 0 && end_ == size_of(fd_); }

// Begins the file again with a new random seed, so that records of before do not fit any more.
void Journal::clear() {
  std::random_device random;
  chain_ = (static_cast<std::uint64_t>(random()) << 32) ^ random();
  if (::ftruncate(fd_, 0) != 0 || !write_at(fd_, 0, magic) ||
      !write_at(fd_, magic.size(), bytes_of(chain_)))
    cannot_write(path_, "is the disk full?");
  end_ = header;
  sync();
  sync_folder_of(path_);
}

// The record is written first and becomes valid with its checksum.
void Journal::append(std::string_view record) {
  if (end_ == 0) clear();
  const std::uint64_t length = record.size();
  const std::uint64_t sum = checksum(record, chain_);
  const std::uint64_t at = end_ + sizeof length;
  const std::uint64_t behind = at + length + sizeof sum;
  // Damaged records are cut off first, so that nothing of them follows the new end.
  if (size_of(fd_) > end_ && ::ftruncate(fd_, static_cast<off_t>(end_)) != 0)
    cannot_write(path_, "");
  if (!write_at(fd_, end_, bytes_of(length)) || !write_at(fd_, at, record) ||
      !write_at(fd_, at + length, bytes_of(sum))) {
    // The file is cut back to its end before. If that fails too, the file stays readable: half a
    // record does not fit its checksum.
    const int reason = errno;
    [[maybe_unused]] const int cut = ::ftruncate(fd_, static_cast<off_t>(end_));
    errno = reason;
    cannot_write(path_, "is the disk full?");
  }
  end_ = behind;
  chain_ = sum;
  if (std::chrono::steady_clock::now() - synced_ > std::chrono::seconds(1)) sync();
}

// Some file systems cannot sync (EINVAL, EROFS). There the journal works without it.
void Journal::sync() {
  if (::fdatasync(fd_) != 0 && errno != EINVAL && errno != EROFS)
    cannot_write(path_, "is the disk full?");
  synced_ = std::chrono::steady_clock::now();
}

void Journal::remove() {
  ::unlink(path_.c_str());
  ::close(fd_);
  fd_ = -1;
}

}  // namespace langer

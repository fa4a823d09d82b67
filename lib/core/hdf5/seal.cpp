#include "core/hdf5/seal.hpp"
#include "core/base/text.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/output_file.hpp"
#include "core/hdf5/checksum.hpp"
#include "core/hdf5/replace.hpp"

namespace langer {

namespace {

constexpr std::string_view seal_begin = "\nlanger seal:", older_begin = "\nlanger seal ";
constexpr std::size_t seal_length = seal_begin.size() + 16 + 1;  // begin, 16 hex digits, newline

[[noreturn]] void cannot_write(const std::string& path) {
  throw Failure(
      Exit::input,
      Error{{path}, "", fmt::format("cannot be written ({})", std::strerror(errno)), "", ""});
}

// The checksum of a file, block by block: `add(block, h)` continues from the checksum h of the
// blocks before. A file that cannot be read has the checksum 0.
template <class Add>
std::uint64_t checksum_of_blocks(std::ifstream& in, std::uintmax_t bytes, const Add& add) {
  std::uint64_t h = 0xcbf29ce484222325u;
  std::vector<char> block(static_cast<std::size_t>(std::min<std::uintmax_t>(bytes, 1 << 20)));
  while (bytes > 0) {
    const std::size_t n = static_cast<std::size_t>(std::min<std::uintmax_t>(bytes, block.size()));
    if (!in.read(block.data(), static_cast<std::streamsize>(n))) return 0;
    h = add(std::string_view(block.data(), n), h);
    bytes -= n;
  }
  return h;
}

// The checksum of versions up to 0.2.0: FNV-1a over words of eight bytes. It overlooks two flipped
// sign bits, which cancel.
std::uint64_t older_checksum(std::string_view bytes, std::uint64_t h) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min<std::size_t>(8, bytes.size()))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min<std::size_t>(8, bytes.size()));
    h = (h ^ word) * 0x100000001b3u;
  }
  return h;
}

void sync_path(const std::string& path, int flags) {
  const int fd = ::open(path.c_str(), flags);
  if (fd < 0) return;  // a folder that cannot be opened is no reason to fail
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

void append_seal(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string seal =
      fmt::format("{}{:016x}\n", seal_begin,
                  checksum_of_blocks(in, std::filesystem::file_size(path), checksum));
  if (!append_durably(path, seal)) cannot_write(path);
}

// A file too short for a seal, or without its line at the end, has none.
Seal seal_of(const std::string& path) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  if (none || size < seal_length) return Seal::none;
  std::ifstream in(path, std::ios::binary);
  std::string seal(seal_length, '\0');
  in.seekg(static_cast<std::streamoff>(size - seal_length));
  if (!in.read(seal.data(), seal_length)) return Seal::none;
  const bool older = seal.starts_with(older_begin);
  if (!older && !seal.starts_with(seal_begin)) return Seal::none;
  in.seekg(0);
  const auto sum_of = older ? older_checksum : checksum;
  const std::uint64_t sum = checksum_of_blocks(in, size - seal_length, sum_of);
  if (seal.substr(seal_begin.size(), 16) != fmt::format("{:016x}", sum)) {
    return Seal::broken;
  }
  return Seal::whole;
}

// The content is on the disk before the name, so that a crash leaves the old file or the new one.
void rename_durably(const std::string& from, const std::string& to) {
  sync_path(from, O_RDONLY);
  if (std::rename(from.c_str(), to.c_str()) != 0) cannot_write(to);
  sync_folder_of(to);
}

void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  sync_path(text_or(folder, "."), O_RDONLY | O_DIRECTORY);
}

namespace {

// Writes the bytes into <path>.part, which the caller renames; returns that name.
std::string write_part(const std::string& path, const std::string& bytes) {
  std::string part = path + ".part";
  const int fd = create_file(part);
  const bool written = write_bytes_to(fd, bytes);
  int reason = errno;
  const bool closed = ::close(fd) == 0;
  if (written && closed) return part;
  if (written) reason = errno;
  ::unlink(part.c_str());
  errno = reason;
  cannot_write(path);
}

void rename_or_refuse(const std::string& part, const std::string& path) {
  if (std::rename(part.c_str(), path.c_str()) != 0) cannot_write(path);
}

}  // namespace

void write_text_file(const std::string& path, const std::string& text) {
  require_replaceable_by(path, text);
  rename_durably(write_part(path, text), path);
}

void write_text_file_soon(const std::string& path, const std::string& text) {
  require_replaceable_by(path, text);
  rename_or_refuse(write_part(path, text), path);
}

void replace_file(const std::string& path, const std::string& bytes) {
  require_replaceable(path);
  rename_or_refuse(write_part(path, bytes), path);
}

}  // namespace langer

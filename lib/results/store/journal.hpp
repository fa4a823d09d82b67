// Records in a file to which one only ever adds: what a run has done so far, told whole from
// damaged after a crash or a power cut.
//   "langer journal 1\n"  seed  |  length  bytes  checksum  |  length  bytes  checksum  |  ...
// Each checksum goes on from that of the record before, the first from a seed of the file's own, so
// that neither a page of zeros nor old blocks of the disk pass for a record. The first record that
// does not fit its checksum, and all behind it, never happened.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace langer {

class Journal {
 public:
  // Opens the file or makes an empty one; throws Failure(input): it cannot be written, or another
  // process holds it.
  explicit Journal(const std::string& path);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  std::optional<std::string> next();  // record after record; nothing at the end of what is whole
  void put_back();      // the record just read is not wanted, nor what stands behind it
  bool at_end() const;  // nothing stands behind the last record read: none was damaged
  void clear();         // forgets all records
  // Behind the last record read or appended; what stood there is cut off. Throws Failure(input)
  // where the disk is full: the file then is as it was. Reaches the disk itself at once, or within
  // a second of steps that follow each other more quickly than that.
  void append(std::string_view record);
  void remove();  // the work is done
  const std::string& path() const { return path_; }

 private:
  void sync();
  std::string path_;
  int fd_ = -1;
  std::uint64_t end_ = 0;    // of the records read or appended
  std::uint64_t chain_ = 0;  // checksum of the last of them
  std::uint64_t end_before_ = 0, chain_before_ = 0;
  std::chrono::steady_clock::time_point synced_;
};

}  // namespace langer

// A file of records to which a run only appends. After a crash or a power failure the complete
// records can be distinguished from damaged ones.
//   "langer journal 1\n"  seed  |  length  bytes  checksum  |  length  bytes  checksum  |  ...
// Each checksum continues that of the record before, and the first begins with a random seed of the
// file. So neither a page of zeros nor old blocks of the disk pass for a record. The first record
// that does not fit its checksum, and everything after it, is ignored.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace langer {

// An open journal, locked for other processes.
class Journal {
 public:
  // Opens the file or creates an empty one. Throws Failure(input) if it cannot be written or if
  // another process has locked it.
  explicit Journal(const std::string& path);
  // Only reads, while another process may write: next() gives a record as soon as it is complete.
  // Neither locks nor creates the file, and follows no link; without one there are no records.
  struct ReadOnly {};
  Journal(const std::string& path, ReadOnly);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  std::optional<std::string> next();  // the next record; nothing after the last complete one
  void put_back();                    // the record just read, and all after it, will be discarded
  bool replaced() const;  // the name belongs to another file now, or this one was begun anew
  bool at_end() const;    // nothing follows the last record read: none was damaged
  void clear();           // removes all records
  // Appends after the last record read or appended; anything after that is cut off. Throws
  // Failure(input) if the disk is full, and leaves the file unchanged. The record is on the disk at
  // once, or within a second if records follow each other more quickly.
  void append(std::string_view record);
  void remove();  // deletes the file: the task is done
  const std::string& path() const { return path_; }

 private:
  void find_first();  // the position before the first record
  // Waits until the file is on the disk.
  void sync();
  std::string path_;
  int fd_ = -1;
  std::uint64_t end_ = 0;    // position after the last record read or appended
  std::uint64_t chain_ = 0;  // its checksum
  std::uint64_t seed_ = 0;   // of the file when it was opened
  // The same one record earlier, for put_back().
  std::uint64_t end_before_ = 0, chain_before_ = 0;
  std::chrono::steady_clock::time_point synced_;
};

}  // namespace langer

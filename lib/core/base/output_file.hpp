// The only room that opens files for writing: every table, HDF5 file, journal, lock and log of
// every program gets its file descriptor here, and `ctest -R "one room opens files"` refuses any
// other way.
//
// Results are written into a file called <name>.part, which gets its name when it is whole. A
// folder that came by mail may hold a symbolic link called <name>.part, or a second name (a hard
// link) of a file that lies elsewhere. An ordinary open() follows the one and overwrites the other.
// Therefore
//   - a new file is created with O_EXCL, which never opens what is there already;
//   - what is there is replaced by a rename, which exchanges the name and leaves the old content alone;
//   - a file that keeps its content (journal, lock) must be a plain file with a single name.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace langer {

// Creates an empty file for reading and writing and returns its descriptor. A plain file of that
// name is replaced. Throws Failure(input) where the name belongs to a link, folder, device, FIFO or
// socket, or where the folder cannot be written to.
int create_file(const std::string& path);

// Opens a journal or a lock, made where there is none, and keeps what it holds. Returns -1 and sets
// errno where the system refuses; throws Failure(input) for a link, a file with a second name and
// anything that is no plain file.
int open_kept_file(const std::string& path);

// Opens a log. `append` continues one that is there; otherwise it is replaced. A terminal or
// another character device is written to as it is. Returns nullptr and sets errno where the system
// refuses.
std::FILE* open_log_file(const std::string& path, bool append);

// Writes all bytes, in as many calls as the system needs. False, with errno, where it cannot.
bool write_bytes_to(int fd, std::string_view bytes);

// Adds bytes at the end of a file of ours and waits for the disk. False, with errno, if it cannot.
bool append_durably(const std::string& path, std::string_view bytes);

// Makes an empty folder in `parent` whose name nobody can foresee; returns its name alone ("" where
// it cannot be made).
std::string make_private_folder(const std::string& parent);

// Makes a folder inside a folder of results, with those above it, unless it is there. Throws
// Failure(input) where a part of the path below `root` is a link, through which files would land
// elsewhere, or where it cannot be made.
void make_folder_below(const std::string& root, const std::string& folder);

}  // namespace langer

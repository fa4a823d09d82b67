#include "results/store/side_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "core/base/output_file.hpp"
#include "core/hdf5/replace.hpp"
#include "results/store/provenance.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

fs::path folder_of(const fs::path& output) {
  if (output.has_parent_path()) return output.parent_path();
  return fs::path(".");
}

// yeoh.h5 -> yeoh_files
fs::path own_folder_of(const fs::path& output) {
  return output.parent_path() / (output.stem().string() + "_files");
}

bool is_made_by(const fs::path& file, const std::string& stage) {
  try {
    return read_origin(file.string()).identity.stage == stage;
  } catch (const Failure&) {
    return false;  // no file of ours, or a damaged one
  }
}

// Whether a run of the stage holds the lock. A run that has begun has no output yet, but its lock
// file names its program.
bool is_running(const fs::path& lock, const std::string& stage) {
  const int fd = ::open(lock.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return false;
  const bool held = ::flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  char text[1024];
  const ssize_t n = ::pread(fd, text, sizeof text, 0);
  ::close(fd);
  const std::string line(text, static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  return held && line.find(": langer-" + stage + " ") != std::string::npos;
}

// Another output of the same stage in the same folder whose side files have the plain names;
// empty if there is none. `finished`: outputs that exist count too, not only those being made.
std::string plain_owner(const fs::path& output, const std::string& stage, bool finished) {
  std::error_code none;
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder_of(output), none)) {
    entries.push_back(entry.path());
  }
  // The order of a folder's entries is arbitrary; the result must not be.
  std::sort(entries.begin(), entries.end());
  for (const fs::path& entry : entries) {
    const bool is_lock = entry.extension() == ".lock";
    fs::path other = entry;
    if (is_lock) other = fs::path(entry).replace_extension();
    if (other.extension() != ".h5" || other.filename() == output.filename()) continue;
    if (fs::is_directory(own_folder_of(other), none)) continue;
    bool owns = false;
    if (is_lock) {
      owns = is_running(entry, stage);
    } else {
      owns = finished && is_made_by(entry, stage);
    }
    if (owns) return other.filename().string();
  }
  return "";
}

}  // namespace

// An output that already has a folder of its own keeps it. A new output gets one if another
// output has the plain names.
SideFolder side_folder(const std::string& output, const std::string& stage,
                       const std::vector<std::string>& names) {
  const fs::path plain = fs::path(output).parent_path();
  const fs::path own = own_folder_of(output);
  SideFolder chosen{plain.string(), ""};
  if (names.empty()) return chosen;

  std::error_code none;
  const auto is_there = [&](const std::string& name) {
    return fs::exists(fs::symlink_status(plain / name, none));
  };
  if (fs::is_directory(own, none)) {
    chosen = {own.string(), "another output"};
  } else if (!fs::exists(output, none)) {
    const bool taken = std::any_of(names.begin(), names.end(), is_there);
    chosen.owner = plain_owner(output, stage, taken);
    if (!chosen.owner.empty()) chosen.path = own.string();
  }
  if (!chosen.owner.empty()) make_folder_below(plain.string(), own.string());
  for (const std::string& name : names)
    require_replaceable((fs::path(chosen.path) / name).string());
  return chosen;
}

}  // namespace langer

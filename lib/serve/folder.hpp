// The folder that the server may read and write, and nothing outside of it.
//
// A path comes from a browser, and the folder may have come by mail. Therefore
//   - paths are relative and have no part ".." or "."; a part that begins with "." is refused;
//   - every part is opened by itself, relative to the folder before it, with O_NOFOLLOW: a symbolic
//     link anywhere on the way is refused, also one that appears while the path is walked;
//   - only regular files are read;
//   - files are written by core/base/output_file.hpp, which never follows a link.
#pragma once

#include <string>
#include <vector>

namespace langer {

class ServedFolder {
 public:
  // Makes the folder if it does not exist. Throws Failure(input).
  explicit ServedFolder(const std::string& path);
  ~ServedFolder();
  ServedFolder(const ServedFolder&) = delete;
  ServedFolder& operator=(const ServedFolder&) = delete;

  const std::string& path() const { return path_; }  // absolute
  // The functions below throw Failure(input) for a path that is refused or does not exist.
  std::string read(const std::string& relative, std::size_t largest) const;
  bool has_file(const std::string& relative) const;
  bool has_folder(const std::string& relative) const;                   // "" is the folder itself
  std::vector<std::string> files(const std::string& relative) const;    // plain files, sorted
  std::vector<std::string> folders(const std::string& relative) const;  // without hidden ones
  void replace(const std::string& relative, const std::string& text) const;  // a file that exists
  void create(const std::string& relative, const std::string& bytes) const;  // a new file
  std::string absolute(const std::string& relative) const;  // checked; it may not exist

 private:
  int open_below(const std::string& relative, int flags) const;  // -1: not there
  std::vector<std::string> list(const std::string& relative, bool folders) const;
  std::string path_;
  int fd_ = -1;
};

// "skin/solve.yaml" of a project "skin"; the name itself if the project is the served folder.
std::string below(const std::string& project, const std::string& name);

// Why such a path is refused; empty if it may be walked.
std::string refused_path(const std::string& relative);

}  // namespace langer

#include "core/hdf5/replace.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/base/error.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

// Files that this run reads and therefore never replaces.
std::vector<std::string>& spared() {
  static std::vector<std::string> paths;
  return paths;
}

bool first_time = false;  // the main output did not exist when the run began

[[noreturn]] void refuse(const std::string& path, std::string found, std::string hint) {
  throw Failure(Exit::input, Error{{path}, "", std::move(found), "", std::move(hint)});
}

// Writing through a symbolic link would change a file of another name.
void refuse_link(const std::string& path) {
  std::error_code none;
  if (fs::is_symlink(fs::symlink_status(path, none)))
    refuse(path, "is a link to " + fs::read_symlink(path, none).string(),
           "name the file itself, or remove the link");
}

void refuse_input(const std::string& path) {
  std::error_code none;
  for (const std::string& input : spared())
    if (fs::equivalent(input, path, none))
      refuse(path, "is read by this run and would be replaced",
             "another name or folder for the output (-o)");
}

// Whether `words` occur in the first or in the last megabyte of a file, where the attributes of
// HDF5 files and the seal are.
bool holds(const std::string& path, const std::string& words) {
  constexpr std::streamoff most = 1 << 20;
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = in.tellg();
  const auto look = [&](std::streamoff from) {
    std::string text(static_cast<std::size_t>(std::min(most, size - from)), '\0');
    in.seekg(from);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text.find(words) != std::string::npos;
  };
  return size > 0 && (look(0) || (size > most && look(size - most)));
}

std::string begin_of(const std::string& path, std::size_t bytes) {
  std::string text(bytes, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text;
}

}  // namespace

void never_replace(const std::string& path) { spared().push_back(path); }

void require_replaceable(const std::string& path) {
  refuse_link(path);
  std::error_code none;
  const fs::file_status status = fs::status(path, none);
  if (fs::is_directory(status)) refuse(path, "is a folder", "the name of a file");
  if (fs::exists(status) && !fs::is_regular_file(status))
    refuse(path, "is no plain file (a device, FIFO or socket)", "the name of a file");
  refuse_input(path);
}

void begin_beside(const std::string& output) { first_time = !fs::exists(output); }

void require_replaceable_by(const std::string& path, const std::string& text) {
  require_replaceable(path);
  if (!first_time) return;
  const std::string line = text.substr(0, text.find('\n') + 1);
  const std::string is = begin_of(path, std::max<std::size_t>(line.size(), 1));
  if (!is.empty() && is != line)
    refuse(path, "is there already and was not made by this step",
           "remove or rename it, or -o into another folder");
}

void require_replaceable_from(const std::string& path, const std::string& script) {
  require_replaceable(path);
  if (first_time && !begin_of(path, 1).empty() && !fs::exists(script))
    refuse(path, "is there already and was not made by this step",
           "remove or rename it, or -o into another folder");
}

void require_own_output(const std::string& path) {
  require_replaceable(path);
  if (begin_of(path, 1).empty()) return;
  const std::string begin = begin_of(path, 15);
  const bool hdf5 = begin.starts_with("\x89HDF\r\n\x1a\n");
  const bool own_hdf5 = hdf5 && (holds(path, "config_hash") || holds(path, "\nlanger seal"));
  const bool own_report = begin.starts_with("<!DOCTYPE html>") && holds(path, "langer");
  if (!own_hdf5 && !own_report)
    refuse(path, "is there already and was not made by langer", "another name (-o), or remove it");
}

void require_own_text(const std::string& path, const std::string& mark) {
  require_replaceable(path);
  if (!begin_of(path, 1).empty() && !holds(path, mark))
    refuse(path, "is there already and was not made by langer", "another name, or remove it");
}

void require_own_log(const std::string& path) {
  refuse_link(path);
  refuse_input(path);
  std::error_code none;
  const fs::file_status status = fs::status(path, none);
  if (!fs::exists(status) || fs::is_character_file(status)) return;
  if (!fs::is_regular_file(status))
    refuse(path, "is no file for a log", "the name of a file (--log)");
  const std::string begin = begin_of(path, 9);
  if (!begin.empty() && !begin.starts_with("# langer"))
    refuse(path, "is there already and is no log of langer", "another name (--log), or remove it");
}

}  // namespace langer

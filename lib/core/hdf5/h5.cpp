#include "core/hdf5/h5.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/base/input_file.hpp"
#include "core/base/output_file.hpp"
#include "core/hdf5/h5_handle.hpp"
#include "core/hdf5/replace.hpp"
#include "core/hdf5/seal.hpp"

namespace langer::h5 {

// Rows of open datasets may still be in memory: what keeps them from the disk shows here.
bool OpenFile::close() {
  const hid_t open = std::exchange(id, -1);
  if (open < 0) return false;
  const bool flushed = !writing || H5Fflush(open, H5F_SCOPE_GLOBAL) >= 0;
  growing.clear();
  return H5Fclose(open) >= 0 && flushed;
}

OpenFile::~OpenFile() {
  const bool closed = close();
  if (!writing) return;
  if (unfinished == Unfinished::discard)
    std::remove(current.c_str());
  else if (closed) {
    try {
      // The seal distinguishes the file of a stopped run from a damaged one. Without room for it,
      // the file counts as incomplete and is not read.
      append_seal(current);
    } catch (const Failure&) {
    }
  }
}

// Strings of fixed length are readable by every tool. HDF5 has no string of length zero, so an
// empty text is stored as one zero byte.
Handle string_type(const std::string& text) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(1, text.size()));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const bool ascii = std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 128; });
  H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
  return type;
}

// Without times of objects, equal content gives equal bytes.
Handle creation(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(list, false);
  return list;
}

void written(bool good, const Group& group, const std::string& name) {
  if (!good) group.refuse(name, "cannot be written", "", "is the disk full?");
}

void Group::refuse(const std::string& name, const std::string& found, const std::string& expected,
                   const std::string& hint) const {
  throw Failure(Exit::input,
                Error{{file_->path}, name.empty() ? path_ : full(name), found, expected, hint});
}

std::string Group::full(const std::string& name) const {
  return (path_ == "/" ? "" : path_) + "/" + name;
}

namespace {

// HDF5 prints its own stack of errors unless this is switched off; messages are ours.
void be_quiet() {
  static const bool done = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  (void)done;
}

herr_t add_link(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

// Whether a link on the way to a path leads into another file. Soft links are followed, at most
// `depth` of them, so that a circle of links ends.
bool leads_elsewhere(hid_t file, const std::string& path, int depth = 16) {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const std::string begin = path.substr(0, end);
    H5L_info_t info;
    if (begin.size() < 2 || H5Lget_info(file, begin.c_str(), &info, H5P_DEFAULT) < 0) return false;
    if (info.type != H5L_TYPE_HARD && info.type != H5L_TYPE_SOFT) return true;
    if (info.type == H5L_TYPE_SOFT) {
      std::string target(info.u.val_size, '\0');
      if (depth == 0 ||
          H5Lget_val(file, begin.c_str(), target.data(), target.size(), H5P_DEFAULT) < 0)
        return true;
      target = target.c_str();
      if (!target.starts_with('/')) target = begin.substr(0, begin.rfind('/') + 1) + target;
      if (end != path.npos) target += path.substr(end);
      return leads_elsewhere(file, target, depth - 1);
    }
    if (end == path.npos) return false;
  }
}

void refuse_external(hid_t file, const Group& group, const std::string& name,
                     const std::string& full) {
  if (leads_elsewhere(file, full))
    group.refuse(name, "is a link into another file", "the data themselves",
                 "copy them into this file (h5copy)");
}

Handle open_object(hid_t file, const std::string& path) {
  return {H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose};
}

// Whether a run is still adding to the file: it then holds a lock on its journal.
bool being_written(const std::string& part) {
  const int fd = ::open((part.substr(0, part.size() - 5) + ".steps").c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool held = ::flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(fd);
  return held;
}

Handle scalar() { return {H5Screate(H5S_SCALAR), H5Sclose}; }

// Overwrites an attribute of the same type and size, replaces any other.
void write_attribute(hid_t object, const Group& group, const std::string& name, hid_t type,
                     hid_t space, hid_t memory, const void* values) {
  if (H5Aexists(object, name.c_str()) > 0) {
    const Handle old(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
    const Handle old_type(H5Aget_type(old), H5Tclose), old_space(H5Aget_space(old), H5Sclose);
    if (H5Tequal(old_type, type) > 0 &&
        H5Sget_simple_extent_npoints(old_space) == H5Sget_simple_extent_npoints(space))
      return written(H5Awrite(old, memory, values) >= 0, group, name);
    written(H5Adelete(object, name.c_str()) >= 0, group, name);
  }
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  written(attribute.good() && H5Awrite(attribute, memory, values) >= 0, group, name);
}

void write_text_attribute(hid_t object, const Group& group, const std::string& name,
                          const std::string& text) {
  const Handle type = string_type(text);
  const Handle space = scalar();
  std::string padded = text;
  if (text.empty()) padded = std::string(1, '\0');
  write_attribute(object, group, name, type, space, type, padded.data());
}

std::string read_text_attribute(hid_t object, const Group& group, const std::string& name,
                                std::uintmax_t size) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.good()) group.refuse("", fmt::format("attribute {} is missing", name));
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  return string_value(group, name, type, space, size,
                      [&](hid_t memory, void* to) { return H5Aread(attribute, memory, to); });
}

}  // namespace

bool Group::has(const std::string& name) const {
  if (!file_->writing) refuse_external(file_->id, *this, name, full(name));
  if (file_->growing.contains(full(name))) return true;
  return H5Lexists(file_->id, full(name).c_str(), H5P_DEFAULT) > 0;
}

void refuse_stored_elsewhere(hid_t dataset, const Group& group, const std::string& name) {
  const Handle list(H5Dget_create_plist(dataset), H5Pclose);
  if (list.good() && (H5Pget_external_count(list) > 0 || H5Pget_layout(list) == H5D_VIRTUAL))
    group.refuse(name, "keeps its values in another file", "the values themselves",
                 "copy them into this file (h5repack)");
}

namespace {
// The names of all objects of one kind. The kind is asked from the id of the object, because
// H5O_info_t differs between versions of HDF5.
std::vector<std::string> links(hid_t file, const Group& group, H5I_type_t kind) {
  const Handle here(H5Gopen2(file, group.path().c_str(), H5P_DEFAULT), H5Gclose);
  std::vector<std::string> all, chosen;
  if (!here.good() || H5Literate(here, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_link, &all) < 0)
    group.refuse("", "group cannot be read");
  for (const std::string& name : all) {
    refuse_external(file, group, name, (group.path() == "/" ? "" : group.path()) + "/" + name);
    const Handle object(H5Oopen(here, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (object.good() && H5Iget_type(object) == kind) chosen.push_back(name);
  }
  return chosen;
}
}  // namespace

std::vector<std::string> Group::groups() const { return links(file_->id, *this, H5I_GROUP); }
std::vector<std::string> Group::datasets() const { return links(file_->id, *this, H5I_DATASET); }

Group Group::group(const std::string& name) const {
  const Handle handle(has(name) ? H5Gopen2(file_->id, full(name).c_str(), H5P_DEFAULT) : -1,
                      H5Gclose);
  if (!handle.good()) refuse(name, "group is missing");
  return {file_, full(name)};
}

Group Group::make_group(const std::string& name) const {
  if (has(name)) return group(name);
  const Handle list = creation(H5P_GROUP_CREATE);
  const Handle made(H5Gcreate2(file_->id, full(name).c_str(), H5P_DEFAULT, list, H5P_DEFAULT),
                    H5Gclose);
  written(made.good(), *this, name);
  return {file_, full(name)};
}

void Group::attribute(const std::string& name, const std::string& text) const {
  write_text_attribute(open_object(file_->id, path_), *this, name, text);
}

void Group::attribute(const std::string& name, std::int64_t value) const {
  write_attribute(open_object(file_->id, path_), *this, name, H5T_STD_I64LE, scalar(),
                  H5T_NATIVE_INT64, &value);
}

void Group::attribute(const std::string& name, const std::vector<std::int64_t>& values) const {
  const hsize_t n = values.size();
  const Handle list(H5Screate_simple(1, &n, nullptr), H5Sclose);
  write_attribute(open_object(file_->id, path_), *this, name, H5T_STD_I64LE, list, H5T_NATIVE_INT64,
                  values.data());
}

bool Group::has_attribute(const std::string& name) const {
  const Handle object = open_object(file_->id, path_);
  return object.good() && H5Aexists(object, name.c_str()) > 0;
}

std::string Group::text_attribute(const std::string& name) const {
  return read_text_attribute(open_object(file_->id, path_), *this, name, file_->size);
}

std::int64_t Group::integer_attribute(const std::string& name) const {
  const Handle object = open_object(file_->id, path_);
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.good()) refuse("", fmt::format("attribute {} is missing", name));
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  std::int64_t value = 0;
  if (H5Tget_class(type) != H5T_INTEGER || H5Sget_simple_extent_npoints(space) != 1 ||
      H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0)
    refuse("", fmt::format("attribute {} is not an integer", name));
  return value;
}

void Group::annotate(const std::string& dataset, const std::string& name,
                     const std::string& text) const {
  write_text_attribute(open_object(file_->id, full(dataset)), *this, name, text);
}

std::string Group::annotation(const std::string& dataset, const std::string& name) const {
  const Handle object = open_object(file_->id, full(dataset));
  if (!object.good() || H5Aexists(object, name.c_str()) <= 0) return "";
  return read_text_attribute(object, *this, name, file_->size);
}

std::string library() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("HDF5 {}.{}.{}", major, minor, release);
}

namespace {

// The name under which HDF5 opens a file that is open here already. H5Fcreate follows links; this
// name leads to the open file itself, even if its path has been replaced since.
std::string name_of_descriptor(int fd, const std::string& path) {
  const std::string name = fmt::format("/proc/self/fd/{}", fd);
  std::error_code none;
  if (std::filesystem::exists(name, none)) return name;
  return path;
}

// Whether HDF5 has opened the same file as `fd`.
bool is_open_by(hid_t file, int fd) {
  void* handle = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 || !handle) return false;
  struct stat by_hdf5 {};
  struct stat by_us {};
  if (::fstat(*static_cast<int*>(handle), &by_hdf5) != 0) return false;
  if (::fstat(fd, &by_us) != 0) return false;
  return by_hdf5.st_dev == by_us.st_dev && by_hdf5.st_ino == by_us.st_ino;
}

}  // namespace

// The .part file is created by us without following links, then opened by HDF5 under the name of
// the descriptor, and compared: a link that appears in between cannot redirect the output.
File File::create(const std::string& path, Unfinished unfinished) {
  be_quiet();
  require_own_output(path);
  auto file = std::make_shared<OpenFile>();
  file->path = path;
  file->current = path + ".part";
  file->unfinished = unfinished;
  const int fd = create_file(file->current);
  const Handle list = creation(H5P_FILE_CREATE);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  const std::string name = name_of_descriptor(fd, file->current);
  file->id = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, list, access);
  const bool same = file->id >= 0 && is_open_by(file->id, fd);
  ::close(fd);
  if (!same) {
    throw Failure(Exit::input, Error{{file->current},
                                     "",
                                     "cannot be created",
                                     "",
                                     "does the folder exist, and may it be written?"});
  }
  file->writing = true;
  file->size = std::numeric_limits<std::uintmax_t>::max();
  return File(file);
}

// The order of the checks matters: HDF5 1.10 may crash on damaged files, so it sees only those
// whose seal is whole or that never had one.
File File::open(const std::string& path) {
  be_quiet();
  const auto refuse = [&](const std::string& found, const std::string& hint) -> void {
    throw Failure(Exit::input, Error{{path}, "", found, "", hint});
  };
  std::error_code none;
  if (!std::filesystem::exists(path, none)) refuse("no such file", "");
  if (std::filesystem::is_directory(path, none)) refuse("is a folder, not a file", "");
  if (!std::filesystem::is_regular_file(path, none)) refuse(unreadable_reason(path), "");
  // A file that the system cannot open is not damaged: the message gives the system's reason.
  const int readable = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (readable < 0 && (errno == EMFILE || errno == ENFILE))
    refuse("not opened: this process has too many open files",
           "close some, or raise the limit: ulimit -n 4096");
  if (readable < 0) refuse(fmt::format("not opened: {}", std::strerror(errno)), "");
  ::close(readable);
  const Seal seal = seal_of(path);
  if (seal == Seal::broken)
    refuse("damaged: its content does not fit its checksum", "make it again");
  if (seal == Seal::none && path.ends_with(".part") && !being_written(path))
    refuse("was left by a run that was killed: it may be incomplete",
           "run the same command again: it continues from the complete steps");
  auto file = std::make_shared<OpenFile>();
  file->path = file->current = path;
  file->size = std::filesystem::file_size(path, none);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  file->id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  if (file->id < 0)
    refuse("not a readable HDF5 file: truncated, still being written, or of another kind",
           "make it again");
  return File(file);
}

void File::flush() const { written(H5Fflush(file_->id, H5F_SCOPE_GLOBAL) >= 0, root(), ""); }

// Close, seal, rename: a file has its name only once it is complete.
void File::commit() {
  written(file_->close(), root(), "");
  append_seal(file_->current);
  rename_durably(file_->current, file_->path);
  file_->writing = false;
}

}  // namespace langer::h5

// What the sources of h5.hpp share: owned HDF5 ids and fixed-length strings.
#pragma once

#include <hdf5.h>

#include <cstdio>
#include <map>
#include <string>

#include "core/hdf5/h5.hpp"

namespace langer::h5 {

class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

struct OpenFile {
  std::string path;     // shown in messages, and the name after commit()
  std::string current;  // name on the disk now
  hid_t id = -1;
  std::uintmax_t size = 0;
  bool writing = false;
  Unfinished unfinished = Unfinished::keep;
  // Datasets that grow by few values at a time, by their paths. They stay open, since to open one
  // takes longer than to write its row.
  std::map<std::string, Handle> growing;
  ~OpenFile();
  bool close();
};

Handle string_type(const std::string& text);
Handle creation(hid_t kind);  // property list without object times
void refuse_stored_elsewhere(hid_t dataset, const Group& group, const std::string& name);
void written(bool good, const Group& group, const std::string& name);

// a string, fixed or variable length, through HDF5's reading call
template <class Read>
std::string string_value(const Group& group, const std::string& name, hid_t type, hid_t space,
                         std::uintmax_t size, Read read) {
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1)
    group.refuse(name, "is not a string");
  if (H5Tis_variable_str(type) > 0) {
    char* text = nullptr;
    const Handle memory(H5Tcopy(type), H5Tclose);
    if (read(memory, &text) < 0 || !text) group.refuse(name, "cannot be read");
    const std::string value = text;
    H5free_memory(text);
    return value;
  }
  const std::size_t length = H5Tget_size(type);
  if (length == 0 || length > size) group.refuse(name, "is longer than the file");
  std::string value(length, '\0');
  if (read(type, value.data()) < 0) group.refuse(name, "cannot be read");
  return value.substr(0, value.find('\0'));
}

}  // namespace langer::h5

// HDF5 files as plain values: the only door to the C library, whose own types and messages stay
// behind h5.cpp.
//   shapes   row-major extents; {} is a scalar; `any` matches every extent
//   types    double (f64), std::int64_t (i64), std::uint8_t (u8), strings of fixed length
// A file is written as <path>.part and gets its name in commit(), with a checksum behind HDF5's
// last byte (the seal). Refused with path and dataset: missing, truncated or changed files, other
// types or shapes, sizes beyond the file. Object times are off, so equal content gives equal bytes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace langer::h5 {

using Shape = std::vector<std::size_t>;
inline constexpr std::size_t any = static_cast<std::size_t>(-1);

template <class T>
struct Array {
  Shape shape;
  std::vector<T> values;
  std::size_t rows() const { return shape.empty() ? 1 : shape[0]; }
};

struct OpenFile;

// A group of an open file; cheap to copy.
class Group {
 public:
  Group(std::shared_ptr<OpenFile> file, std::string path)
      : file_(std::move(file)), path_(std::move(path)) {}

  bool has(const std::string& name) const;
  std::vector<std::string> groups() const;    // names, ascending
  std::vector<std::string> datasets() const;  // names, ascending
  Group group(const std::string& name) const;
  Group make_group(const std::string& name) const;  // or the one that is there

  void attribute(const std::string& name, const std::string& text) const;
  void attribute(const std::string& name, std::int64_t value) const;
  void attribute(const std::string& name, const std::vector<std::int64_t>& values) const;
  bool has_attribute(const std::string& name) const;
  std::string text_attribute(const std::string& name) const;
  std::int64_t integer_attribute(const std::string& name) const;

  // attributes of a dataset of this group
  void annotate(const std::string& dataset, const std::string& name, const std::string& text) const;
  std::string annotation(const std::string& dataset,
                         const std::string& name) const;  // "" where there is none
  std::string unit(const std::string& dataset) const { return annotation(dataset, "unit"); }

  // creates, or overwrites an array of the same shape
  template <class T>
  void write(const std::string& name, const Shape& shape, std::span<const T> values,
             const std::string& unit = "") const;
  void write_scalar(const std::string& name, double value, const std::string& unit = "") const;
  void write_text(const std::string& name, const std::string& text) const;
  // no rows yet; rows never appended read as NaN (or the least integer)
  template <class T>
  void make_extendible(const std::string& name, const Shape& row, std::size_t rows_per_chunk,
                       const std::string& unit = "") const;
  template <class T>
  void append(const std::string& name, std::span<const T> rows) const;

  Shape shape(const std::string& name) const;
  template <class T>
  Array<T> read(const std::string& name, const Shape& expected) const;
  template <class T>
  Array<T> read_rows(const std::string& name, std::size_t first, std::size_t count,
                     const Shape& row) const;
  std::vector<double> read_finite(const std::string& name,
                                  const Shape& expected) const;  // refuses NaN and infinity
  double read_scalar(const std::string& name) const;
  std::string read_text(const std::string& name) const;

  // the failure that names this file and the place in it
  [[noreturn]] void refuse(const std::string& name, const std::string& found,
                           const std::string& expected = "", const std::string& hint = "") const;
  const std::string& path() const { return path_; }

 private:
  std::string full(const std::string& name) const;
  std::shared_ptr<OpenFile> file_;
  std::string path_;
};

enum class Unfinished { discard, keep };  // what becomes of <path>.part without commit()

std::string library();  // "HDF5 1.10.8"

class File {
 public:
  static File create(const std::string& path, Unfinished unfinished = Unfinished::discard);
  static File open(const std::string& path);  // for reading
  Group root() const { return {file_, "/"}; }
  void flush() const;
  void commit();

 private:
  explicit File(std::shared_ptr<OpenFile> file) : file_(std::move(file)) {}
  std::shared_ptr<OpenFile> file_;
};

}  // namespace langer::h5

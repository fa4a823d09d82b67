#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/hdf5/h5_handle.hpp"

namespace langer::h5 {

namespace {

// How a C++ type is stored: little-endian in the file, native in memory. `blank` fills rows that
// were never written.
template <class T>
struct Kind;
template <>
struct Kind<double> {
  static hid_t file() { return H5T_IEEE_F64LE; }
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
  static constexpr H5T_class_t kind = H5T_FLOAT;
  static constexpr const char* name = "reals (f64)";
  static constexpr double blank = std::numeric_limits<double>::quiet_NaN();
};
template <>
struct Kind<std::int64_t> {
  static hid_t file() { return H5T_STD_I64LE; }
  static hid_t memory() { return H5T_NATIVE_INT64; }
  static constexpr H5T_class_t kind = H5T_INTEGER;
  static constexpr const char* name = "integers (i64)";
  static constexpr std::int64_t blank = std::numeric_limits<std::int64_t>::min();
};
template <>
struct Kind<std::uint8_t> {
  static hid_t file() { return H5T_STD_U8LE; }
  static hid_t memory() { return H5T_NATIVE_UINT8; }
  static constexpr H5T_class_t kind = H5T_INTEGER;
  static constexpr const char* name = "integers (u8)";
  [[maybe_unused]] static constexpr std::uint8_t blank = 255;  // no table of these grows
};

// The number of values; `any`, the largest number, if it overflows.
std::size_t product(const Shape& shape) {
  std::size_t n = 1;
  for (std::size_t extent : shape)
    if (__builtin_mul_overflow(n, extent, &n)) return any;
  return n;
}

// Whether two shapes agree, `any` matching every extent.
bool matches(const Shape& shape, const Shape& expected) {
  return std::equal(shape.begin(), shape.end(), expected.begin(), expected.end(),
                    [](std::size_t a, std::size_t b) { return b == any || a == b; });
}

std::string words(const Shape& shape) {
  std::vector<std::string> extents;
  for (std::size_t extent : shape)
    extents.push_back(extent == any ? "any" : std::to_string(extent));
  if (shape.empty()) return "a scalar";
  return fmt::format("shape ({})", fmt::join(extents, ", "));
}

std::vector<hsize_t> extents(const Shape& shape) { return {shape.begin(), shape.end()}; }

Handle dataspace(const Shape& shape, const Shape& most = {}) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  const auto now = extents(shape);
  const auto limit = extents(most);
  return {H5Screate_simple(static_cast<int>(shape.size()), now.data(),
                           limit.empty() ? nullptr : limit.data()),
          H5Sclose};
}

std::optional<Shape> shape_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 0) return std::nullopt;
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return Shape(extent.begin(), extent.end());
}

}  // namespace

// A shape that does not fit is a bug of the caller, not of a file.
template <class T>
void Group::write(const std::string& name, const Shape& shape, std::span<const T> values,
                  const std::string& unit) const {
  if (product(shape) != values.size())
    throw Failure(
        Exit::bug,
        Error{
            {file_->path}, full(name), fmt::format("{} values", values.size()), words(shape), ""});
  if (!has(name)) {
    const Handle list = creation(H5P_DATASET_CREATE);
    const Handle space = dataspace(shape);
    const Handle made(H5Dcreate2(file_->id, full(name).c_str(), Kind<T>::file(), space, H5P_DEFAULT,
                                 list, H5P_DEFAULT),
                      H5Dclose);
    written(made.good(), *this, name);
  } else if (this->shape(name) != shape) {
    throw Failure(Exit::bug,
                  Error{{file_->path}, full(name), words(this->shape(name)), words(shape), ""});
  }
  const Handle dataset(H5Dopen2(file_->id, full(name).c_str(), H5P_DEFAULT), H5Dclose);
  written(values.empty() || H5Dwrite(dataset, Kind<T>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                     values.data()) >= 0,
          *this, name);
  if (!unit.empty()) annotate(name, "unit", unit);
}

void Group::write_scalar(const std::string& name, double value, const std::string& unit) const {
  write<double>(name, {}, std::span<const double>(&value, 1), unit);
}

void Group::write_text(const std::string& name, const std::string& text) const {
  const Handle type = string_type(text);
  const Handle list = creation(H5P_DATASET_CREATE);
  const Handle space = dataspace({});
  const Handle made(
      H5Dcreate2(file_->id, full(name).c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT),
      H5Dclose);
  std::string padded = text;
  if (text.empty()) padded = std::string(1, '\0');
  written(made.good() && H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) >= 0,
          *this, name);
}

// Tables that grow by rows are stored in chunks, of which each is allocated when it is first
// written.
template <class T>
void Group::make_extendible(const std::string& name, const Shape& row, std::size_t rows_per_chunk,
                            const std::string& unit) const {
  Shape now{0}, most{static_cast<std::size_t>(H5S_UNLIMITED)},
      chunk{std::max<std::size_t>(1, rows_per_chunk)};
  for (std::size_t extent : row) {
    now.push_back(extent);
    most.push_back(extent);
    chunk.push_back(std::max<std::size_t>(1, extent));
  }
  const Handle list = creation(H5P_DATASET_CREATE);
  const Handle space = dataspace(now, most);
  const T blank = Kind<T>::blank;
  H5Pset_chunk(list, static_cast<int>(chunk.size()), extents(chunk).data());
  H5Pset_fill_value(list, Kind<T>::memory(), &blank);
  const Handle made(H5Dcreate2(file_->id, full(name).c_str(), Kind<T>::file(), space, H5P_DEFAULT,
                               list, H5P_DEFAULT),
                    H5Dclose);
  written(made.good(), *this, name);
  if (!unit.empty()) annotate(name, "unit", unit);
}

// Extends the dataset first: a run that is stopped in between leaves blank rows, not missing ones.
template <class T>
void Group::append(const std::string& name, std::span<const T> rows) const {
  constexpr std::size_t few = 64;  // values; of longer rows a chunk would stay in memory
  const std::string path = full(name);
  auto open = file_->growing.find(path);
  if (open == file_->growing.end()) {
    Handle opened(H5Dopen2(file_->id, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!opened.good()) refuse(name, "dataset is missing");
    open = file_->growing.emplace(path, std::move(opened)).first;
  }
  const hid_t dataset = open->second;
  const auto before = shape_of(dataset);
  if (!before) refuse(name, "dataset is missing");
  Shape whole = *before;
  Shape block = whole;
  const std::size_t row = product({whole.begin() + 1, whole.end()});
  std::size_t count = 0;
  if (row) count = rows.size() / row;
  if (count * row != rows.size())
    throw Failure(
        Exit::bug,
        Error{{file_->path}, full(name), fmt::format("{} values", rows.size()), "whole rows", ""});
  if (count == 0) return;
  std::vector<hsize_t> first(whole.size(), 0);
  first[0] = whole[0];
  whole[0] += count;
  block[0] = count;
  written(H5Dset_extent(dataset, extents(whole).data()) >= 0, *this, name);
  const Handle space(H5Dget_space(dataset), H5Sclose), memory = dataspace(block);
  written(H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, extents(block).data(),
                              nullptr) >= 0 &&
              H5Dwrite(dataset, Kind<T>::memory(), memory, space, H5P_DEFAULT, rows.data()) >= 0,
          *this, name);
  if (rows.size() > few) file_->growing.erase(open);
}

Shape Group::shape(const std::string& name) const {
  const Handle dataset(has(name) ? H5Dopen2(file_->id, full(name).c_str(), H5P_DEFAULT) : -1,
                       H5Dclose);
  if (!dataset.good()) refuse(name, "dataset is missing");
  const auto shape = shape_of(dataset);
  if (!shape) refuse(name, "cannot be read");
  return *shape;
}

// `count` rows from `first` on, or the whole dataset if count is `any`. Shape, type and size are
// checked before memory is allocated: a damaged file may claim any extent.
template <class T>
Array<T> Group::read_rows(const std::string& name, std::size_t first, std::size_t count,
                          const Shape& row) const {
  const Shape whole = shape(name);
  Shape expected = row;
  expected.insert(expected.begin(), any);
  const bool all = count == any;
  if (all ? !matches(whole, row) : !matches(whole, expected))
    refuse(name, words(whole), words(all ? row : expected));
  if (!all && (first > whole[0] || count > whole[0] - first))
    refuse(name, fmt::format("{} rows", whole[0]), fmt::format("at least {}", first + count));
  Array<T> array{whole, {}};
  if (!all) array.shape[0] = count;
  const Handle dataset(H5Dopen2(file_->id, full(name).c_str(), H5P_DEFAULT), H5Dclose);
  refuse_stored_elsewhere(dataset, *this, name);
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  if (H5Tget_class(type) != Kind<T>::kind || H5Tget_size(type) == 0)
    refuse(name, "values of another type", Kind<T>::name);
  const std::size_t n = product(array.shape);
  if (n > file_->size / H5Tget_size(type))
    refuse(name, fmt::format("{} is more than the file holds", words(whole)));
  array.values.resize(n);
  if (n == 0) return array;
  const Handle memory = dataspace(array.shape);
  if (!all) {
    std::vector<hsize_t> start(whole.size(), 0);
    start[0] = first;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, extents(array.shape).data(),
                        nullptr);
  }
  if (H5Dread(dataset, Kind<T>::memory(), memory, space, H5P_DEFAULT, array.values.data()) < 0)
    refuse(name, "cannot be read");
  return array;
}

template <class T>
Array<T> Group::read(const std::string& name, const Shape& expected) const {
  return read_rows<T>(name, 0, any, expected);
}

std::vector<double> Group::read_finite(const std::string& name, const Shape& expected) const {
  Array<double> array = read<double>(name, expected);
  for (double value : array.values)
    if (!std::isfinite(value)) refuse(name, fmt::format("{}", value), "finite numbers");
  return std::move(array.values);
}

double Group::read_scalar(const std::string& name) const {
  return read<double>(name, {}).values[0];
}

std::string Group::read_text(const std::string& name) const {
  const Handle dataset(has(name) ? H5Dopen2(file_->id, full(name).c_str(), H5P_DEFAULT) : -1,
                       H5Dclose);
  if (!dataset.good()) refuse(name, "dataset is missing");
  refuse_stored_elsewhere(dataset, *this, name);
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  return string_value(*this, name, type, space, file_->size, [&](hid_t memory, void* to) {
    return H5Dread(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
  });
}

template void Group::write<double>(const std::string&, const Shape&, std::span<const double>,
                                   const std::string&) const;
template void Group::write<std::int64_t>(const std::string&, const Shape&,
                                         std::span<const std::int64_t>, const std::string&) const;
template void Group::write<std::uint8_t>(const std::string&, const Shape&,
                                         std::span<const std::uint8_t>, const std::string&) const;
template void Group::make_extendible<double>(const std::string&, const Shape&, std::size_t,
                                             const std::string&) const;
template void Group::make_extendible<std::int64_t>(const std::string&, const Shape&, std::size_t,
                                                   const std::string&) const;
template void Group::append<double>(const std::string&, std::span<const double>) const;
template void Group::append<std::int64_t>(const std::string&, std::span<const std::int64_t>) const;
template Array<double> Group::read<double>(const std::string&, const Shape&) const;
template Array<std::int64_t> Group::read<std::int64_t>(const std::string&, const Shape&) const;
template Array<std::uint8_t> Group::read<std::uint8_t>(const std::string&, const Shape&) const;
template Array<double> Group::read_rows<double>(const std::string&, std::size_t, std::size_t,
                                                const Shape&) const;
template Array<std::int64_t> Group::read_rows<std::int64_t>(const std::string&, std::size_t,
                                                            std::size_t, const Shape&) const;

}  // namespace langer::h5

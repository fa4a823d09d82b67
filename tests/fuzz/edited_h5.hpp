// The bytes of libFuzzer as edits of a good HDF5 file: what another program may have done to it.
// The file stays one that HDF5 itself reads, as HDF5 1.10 crashes on damaged bytes (our files carry
// a checksum against those; tests/store/damage.cpp).
#pragma once

#include <hdf5.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include "fuzz.hpp"

namespace langer::fuzz {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
  bool empty() const { return at_ == end_; }
  std::size_t below(std::size_t n) {
    std::size_t x = 0;
    for (int i = 0; i < 2 && at_ != end_; ++i) x = 256 * x + *at_++;
    return n ? x % n : 0;
  }
  double number() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const double odd[] = {0,
                          -0.0,
                          1,
                          -1,
                          2,
                          3,
                          0.5,
                          1e-300,
                          1e300,
                          -1e300,
                          inf,
                          -inf,
                          std::nan(""),
                          2147483648.0,
                          9.3e18,
                          255};
    const std::size_t k = below(24);
    return k < 16 ? odd[k] : static_cast<double>(static_cast<int>(below(65536)) - 32768);
  }

 private:
  const std::uint8_t *at_, *end_;
};

inline std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline std::vector<std::string> objects(hid_t file) {
  std::vector<std::string> all{"."};
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return 0;
  };
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, add, &all);
  return all;
}

inline void put(hid_t file, const std::string& path, Bytes& bytes) {
  const hid_t dataset = H5Dopen2(file, path.c_str(), H5P_DEFAULT);
  if (dataset < 0) return;
  const hid_t space = H5Dget_space(dataset), type = H5Dget_type(dataset);
  const auto n = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  if (n > 0 && H5Tget_class(type) == H5T_STRING) {
    std::vector<char> text(n * H5Tget_size(type));
    if (H5Tis_variable_str(type) <= 0 &&
        H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0) {
      text[bytes.below(text.size())] = static_cast<char>(bytes.below(256));
      H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data());
    }
  } else if (n > 0) {
    std::vector<double> values(n);
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0) {
      values[bytes.below(n)] = bytes.number();
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
  }
  H5Tclose(type), H5Sclose(space), H5Dclose(dataset);
}

// another dataset of that name: of another type, rank and size
inline void replace(hid_t file, const std::string& path, Bytes& bytes) {
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  hsize_t extent[4], most[4];
  const int rank = static_cast<int>(bytes.below(4));
  for (int i = 0; i < rank; ++i) extent[i] = bytes.below(14), most[i] = H5S_UNLIMITED;
  const hid_t types[] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_U8LE,
                         H5T_IEEE_F32BE, H5T_C_S1,      H5T_STD_I32BE};
  const hid_t space = rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, extent, extent);
  const hid_t dataset = H5Dcreate2(file, path.c_str(), types[bytes.below(6)], space, H5P_DEFAULT,
                                   H5P_DEFAULT, H5P_DEFAULT);
  (void)most;
  if (dataset >= 0) H5Dclose(dataset);
  H5Sclose(space);
}

inline void spoil_attribute(hid_t file, const std::string& path, Bytes& bytes) {
  const hid_t object = path.empty() || path == "." ? H5Oopen(file, "/", H5P_DEFAULT)
                                                   : H5Oopen(file, path.c_str(), H5P_DEFAULT);
  if (object < 0) return;
  std::size_t attributes = 0;
  const auto count = [](hid_t, const char*, const H5A_info_t*, void* n) -> herr_t {
    return ++*static_cast<std::size_t*>(n), 0;
  };
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, count, &attributes);
  if (attributes > 0) {
    const hid_t attribute = H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC,
                                           bytes.below(attributes), H5P_DEFAULT, H5P_DEFAULT);
    char name[128] = "";
    H5Aget_name(attribute, sizeof name, name);
    const hid_t type = H5Aget_type(attribute);
    std::vector<char> value(std::max<std::size_t>(1, H5Aget_storage_size(attribute)));
    if (bytes.below(3) == 0) {
      H5Aclose(attribute);
      H5Adelete(object, name);
    } else {
      H5Aread(attribute, type, value.data());
      value[bytes.below(value.size())] = static_cast<char>(bytes.below(256));
      H5Awrite(attribute, type, value.data());
      H5Aclose(attribute);
    }
    H5Tclose(type);
  }
  H5Oclose(object);
}

// the good file with the edits, at `path`
inline void write_edited(const std::string& good, const std::string& path, Bytes bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << good;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  if (file < 0) std::abort();
  for (int edit = 0; edit < 6 && !bytes.empty(); ++edit) {
    const std::vector<std::string> all = objects(file);
    const std::string object = all[bytes.below(all.size())];
    switch (bytes.below(8)) {
      case 0:
        H5Ldelete(file, object.c_str(), H5P_DEFAULT);
        break;
      case 1:
        replace(file, object, bytes);
        break;
      case 2:
        spoil_attribute(file, object, bytes);
        break;
      case 3:
        spoil_attribute(file, ".", bytes);
        break;
      case 4:
        H5Lmove(file, object.c_str(), file, all[bytes.below(all.size())].c_str(), H5P_DEFAULT,
                H5P_DEFAULT);
        break;
      default:
        put(file, object, bytes);
    }
  }
  H5Fclose(file);
}

// a finished file without its seal, as another program would leave it
inline std::string unsealed(const std::string& path) {
  const std::string all = bytes_of(path);
  return all.substr(0, all.size() - 30);
}

inline std::string scratch(const std::string& name) {
  const char* shm = std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : "/tmp";
  return std::string(shm) + "/langer_fuzz_" + std::to_string(getpid()) + "_" + name;
}

}  // namespace langer::fuzz

// Two HDF5 files as values: what differs outside /provenance, object by object.
// Numbers may differ by `tolerance` times the largest of their dataset; texts, shapes, types and
// attributes must be equal.
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace langer::support {

struct Difference {
  std::string where, what;
};

struct ComparedFiles {
  std::vector<Difference> differences;
  std::size_t datasets = 0;
  double largest = 0;  // relative difference of all numbers
};

class H5Comparison {
 public:
  H5Comparison(const std::string& a, const std::string& b, double tolerance, bool attributes)
      : tolerance_(tolerance), attributes_(attributes) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    a_ = H5Fopen(a.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
    b_ = H5Fopen(b.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (a_ < 0 || b_ < 0)
      differ("", "cannot be opened");
    else
      group("/");
    if (a_ >= 0) H5Fclose(a_);
    if (b_ >= 0) H5Fclose(b_);
  }
  ComparedFiles result;

 private:
  hid_t a_ = -1, b_ = -1;
  double tolerance_;
  bool attributes_;

  void differ(const std::string& where, const std::string& what) {
    result.differences.push_back({where, what});
  }

  static std::vector<std::string> names(hid_t file, const std::string& path) {
    std::vector<std::string> all;
    const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
      static_cast<std::vector<std::string>*>(to)->emplace_back(name);
      return 0;
    };
    H5Literate_by_name(file, path.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &all,
                       H5P_DEFAULT);
    return all;
  }

  void group(const std::string& path) {
    attributes(path);
    const auto in_a = names(a_, path), in_b = names(b_, path);
    if (in_a != in_b) return differ(path, "other members");
    for (const std::string& name : in_a) {
      const std::string below = (path == "/" ? "" : path) + "/" + name;
      if (below == "/provenance") continue;
      const hid_t object = H5Oopen(a_, below.c_str(), H5P_DEFAULT);
      const bool is_group = H5Iget_type(object) == H5I_GROUP;
      H5Oclose(object);
      is_group ? group(below) : dataset(below);
    }
  }

  void attributes(const std::string& path) {
    if (!attributes_) return;
    const hid_t oa = H5Oopen(a_, path.c_str(), H5P_DEFAULT),
                ob = H5Oopen(b_, path.c_str(), H5P_DEFAULT);
    const auto list = [](hid_t object) {
      std::vector<std::string> all;
      const auto add = [](hid_t, const char* name, const H5A_info_t*, void* to) -> herr_t {
        static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        return 0;
      };
      H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &all);
      return all;
    };
    const auto in_a = list(oa);
    if (in_a != list(ob)) differ(path, "other attributes");
    for (const std::string& name : in_a) {
      const auto value = [&](hid_t object) {
        const hid_t attribute = H5Aopen(object, name.c_str(), H5P_DEFAULT),
                    type = H5Aget_type(attribute);
        std::vector<char> bytes(H5Aget_storage_size(attribute));
        if (!bytes.empty()) H5Aread(attribute, type, bytes.data());
        H5Tclose(type), H5Aclose(attribute);
        return bytes;
      };
      if (value(oa) != value(ob)) differ(path, "attribute " + name);
    }
    H5Oclose(oa), H5Oclose(ob);
  }

  void dataset(const std::string& path) {
    ++result.datasets;
    attributes(path);
    const hid_t da = H5Dopen2(a_, path.c_str(), H5P_DEFAULT),
                db = H5Dopen2(b_, path.c_str(), H5P_DEFAULT);
    const hid_t ta = H5Dget_type(da), tb = H5Dget_type(db), sa = H5Dget_space(da),
                sb = H5Dget_space(db);
    if (H5Tequal(ta, tb) <= 0 || H5Sextent_equal(sa, sb) <= 0)
      differ(path, "other type or shape");
    else {
      const std::size_t n = static_cast<std::size_t>(H5Sget_simple_extent_npoints(sa)),
                        bytes = n * H5Tget_size(ta);
      if (H5Tget_class(ta) == H5T_FLOAT) {
        std::vector<double> x(n), y(n);
        if (n > 0) H5Dread(da, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x.data());
        if (n > 0) H5Dread(db, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, y.data());
        numbers(path, x, y);
      } else {
        std::vector<char> x(bytes), y(bytes);
        if (n > 0) H5Dread(da, ta, H5S_ALL, H5S_ALL, H5P_DEFAULT, x.data());
        if (n > 0) H5Dread(db, ta, H5S_ALL, H5S_ALL, H5P_DEFAULT, y.data());
        if (x != y) differ(path, "other integers or text");
      }
    }
    H5Sclose(sa), H5Sclose(sb), H5Tclose(ta), H5Tclose(tb), H5Dclose(da), H5Dclose(db);
  }

  void numbers(const std::string& path, const std::vector<double>& x,
               const std::vector<double>& y) {
    double scale = 0, largest = 0;
    bool same_blanks = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (std::memcmp(&x[i], &y[i], sizeof(double)) == 0) {
        if (std::isfinite(x[i])) scale = std::max(scale, std::abs(x[i]));
        continue;
      }
      if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
        same_blanks = same_blanks && std::isnan(x[i]) && std::isnan(y[i]);
        continue;
      }
      scale = std::max(scale, std::abs(x[i])), largest = std::max(largest, std::abs(x[i] - y[i]));
    }
    if (!same_blanks) differ(path, "finite here, not finite there");
    if (largest == 0) return;
    result.largest = std::max(result.largest, largest / scale);
    if (!(largest <= tolerance_ * scale))
      differ(path, fmt::format("numbers differ by {:.2g} of {:.3g}", largest, scale));
  }
};

inline ComparedFiles compare_h5(const std::string& a, const std::string& b, double tolerance,
                                bool attributes = true) {
  return H5Comparison(a, b, tolerance, attributes).result;
}

}  // namespace langer::support

// langer-hostile-h5 FROM TO KIND PATH [TARGET]: a copy of a file of Langer in which one dataset is
// something that leads elsewhere, or says more than there is. For the test of hostile folders.
#include <hdf5.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace {

hid_t dataset_of(hid_t file, const std::string& path, hid_t type, hid_t space, hid_t list) {
  return H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT);
}

// Puts what `kind` says in the place of a dataset; false for a kind that is not known.
bool replace(hid_t file, const std::string& kind, const std::string& path,
             const std::string& target) {
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  const hid_t list = H5Pcreate(H5P_DATASET_CREATE);
  if (kind == "external_link") {
    return H5Lcreate_external(target.c_str(), "/VTKHDF/Points", file, path.c_str(), H5P_DEFAULT,
                              H5P_DEFAULT) >= 0;
  }
  if (kind == "soft_link") {
    return H5Lcreate_soft(target.c_str(), file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0;
  }
  if (kind == "soft_cycle") {
    return H5Lcreate_soft(path.c_str(), file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0;
  }
  if (kind == "group_cycle") {
    return H5Lcreate_hard(file, "/", file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0;
  }
  if (kind == "external_storage") {
    const hsize_t rows[] = {27, 3};
    H5Pset_external(list, target.c_str(), 0, H5F_UNLIMITED);
    return dataset_of(file, path, H5T_IEEE_F64LE, H5Screate_simple(2, rows, nullptr), list) >= 0;
  }
  if (kind == "virtual") {
    const hsize_t rows[] = {27, 3};
    const hid_t space = H5Screate_simple(2, rows, nullptr);
    H5Pset_virtual(list, space, target.c_str(), "/VTKHDF/Points", space);
    return dataset_of(file, path, H5T_IEEE_F64LE, space, list) >= 0;
  }
  if (kind == "huge") {
    const hsize_t rows[] = {hsize_t{1} << 40, 3};
    const hsize_t chunk[] = {1024, 3};
    H5Pset_chunk(list, 2, chunk);
    return dataset_of(file, path, H5T_IEEE_F64LE, H5Screate_simple(2, rows, nullptr), list) >= 0;
  }
  if (kind == "text") {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    return dataset_of(file, path, type, H5Screate(H5S_SCALAR), list) >= 0;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  std::filesystem::copy_file(argv[1], argv[2], std::filesystem::copy_options::overwrite_existing);
  const hid_t file = H5Fopen(argv[2], H5F_ACC_RDWR, H5P_DEFAULT);
  if (file < 0) return 2;
  const bool done = replace(file, argv[3], argv[4], argc > 5 ? argv[5] : "");
  const bool closed = H5Fclose(file) >= 0;
  std::printf("%s: %s is %s\n", argv[2], argv[4], argv[3]);
  return done && closed ? 0 : 1;
}

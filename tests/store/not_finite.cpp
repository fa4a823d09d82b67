// NaN and infinity in every real number of every file that a stage reads: refused by file and
// dataset, wherever they stand.
#include <doctest/doctest.h>
#include <hdf5.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "core/hdf5/h5.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"
#include "results/store/mesh_file.hpp"
#include "solution_example.hpp"

using namespace langer;
using example::bytes;

namespace {

std::vector<std::string> reals(const std::string& path) {
  std::vector<std::string> all;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  struct To {
    std::vector<std::string>& names;
  } to{all};
  const auto add = [](hid_t group, const char* name, const H5L_info_t*, void* data) -> herr_t {
    const hid_t dataset = H5Dopen2(group, name, H5P_DEFAULT);
    if (dataset < 0) return 0;  // a group
    const hid_t type = H5Dget_type(dataset);
    if (H5Tget_class(type) == H5T_FLOAT) static_cast<To*>(data)->names.emplace_back(name);
    H5Tclose(type), H5Dclose(dataset);
    return 0;
  };
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, add, &to);
  H5Fclose(file);
  return all;
}

void put(const std::string& path, const std::string& name, double value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
              dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT), space = H5Dget_space(dataset);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  if (!values.empty()) values.back() = value;
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space), H5Dclose(dataset), H5Fclose(file);
}

// the datasets in which the reader takes the value without a word
std::set<std::string> taken(const std::string& path, double value,
                            const std::function<void()>& read) {
  const std::string good =
      bytes(path).substr(0, bytes(path).size() - 30);  // without its seal, as other tools leave it
  std::set<std::string> all;
  const std::vector<std::string> names = reals(path);
  CHECK(!names.empty());
  for (const std::string& name : names) {
    example::write_bytes(path, good);
    put(path, name, value);
    try {
      read();
      all.insert(name);
    } catch (const Failure& failure) {
      CHECK(failure.code() == Exit::input);
      INFO(failure.what());
      CHECK(std::string(failure.what()).find(path) == 0);
    }
  }
  return all;
}

std::string words(const std::set<std::string>& names) {
  std::string s;
  for (const std::string& name : names) s += name + " ";
  return s;
}

}  // namespace

TEST_CASE("a number that is not finite is refused in every dataset of every input file") {
  const std::string folder = example::folder("not_finite");
  for (double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    CAPTURE(value);
    const std::string mesh = folder + "/mesh.h5", material = folder + "/material.h5",
                      solution = folder + "/solution.h5";
    write_mesh(mesh, example::bar(), example::identity());
    CHECK(words(taken(mesh, value, [&] { read_mesh(mesh); })) == "");
    write_material(material, example::header(true).material, {}, example::identity());
    CHECK(words(taken(material, value, [&] { read_material(material); })) == "");
    {
      SolutionWriter writer(solution, example::header(true));
      for (int i = 0; i < 3; ++i) writer.append(example::step(i, true));
      writer.finish();
    }
    CHECK(
        words(taken(solution, value,
                    [&] {
                      const SolutionReader reader(solution);
                      for (int i = 0; i < reader.n_steps(); ++i) reader.step(i);
                    })) ==
        "VTKHDF/Steps/Values history/reactions/M history/reactions/x_min ");  // copies of history/t
                                                                              // and reaction that
                                                                              // no stage reads
  }
}

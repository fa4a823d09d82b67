// material.h5, solution.h5 and curves.h5 as edited by others -> values, or a refusal. The first
// byte chooses the file.
#include "edited_h5.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"
#include "store/solution_example.hpp"

namespace {

using namespace langer;

std::string good_file(int kind, const std::string& path) {
  if (kind == 0) write_material(path, example::header(true).material, {}, example::identity());
  if (kind == 1) {
    SolutionWriter writer(path, example::header(true));
    for (int i = 0; i < 3; ++i) writer.append(example::step(i, true));
    writer.finish();
  }
  if (kind == 2) {
    Curves curves;
    curves.curves.push_back({"force", "u", "mm", "F", "N", {0, 1, 2}, {0, 2, 5}});
    curves.columns = {{"u", "mm", {0, 1, 2}}, {"F", "N", {0, 2, 5}}};
    curves.maps.push_back({"map",
                           "u_y",
                           "mm",
                           1,
                           {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                           {1, 2, 3, 4},
                           {{0, 1, 2, 3}},
                           {{1, 0}},
                           {{"A", {0.5, 0.5}}}});
    curves.summary = {{"force", 5, "N"}};
    write_curves(path, curves, example::identity());
  }
  return fuzz::unsealed(path);
}

void read(int kind, const std::string& path) {
  if (kind == 0) read_material(path);
  if (kind == 1) {
    const SolutionReader reader(path);
    for (int i = 0; i < reader.n_steps(); ++i) reader.step(i);
  }
  if (kind == 2) read_curves(path);
  read_origin(path), read_summary(path);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const std::string path = fuzz::scratch("file.h5");
  static const std::string good[] = {good_file(0, path), good_file(1, path), good_file(2, path)};
  const int kind = data[0] % 3;
  fuzz::write_edited(good[kind], path, {data + 1, size - 1});
  fuzz::reads_or_refuses(path, [&] { read(kind, path); });
  std::filesystem::remove(path);
  return 0;
}

// Damaged, foreign and missing files: refused with exit code 3 and the path, never a crash.
#include <doctest/doctest.h>

#include <cstring>
#include <functional>

#include <fmt/format.h>

#include "core/hdf5/h5.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/material_file.hpp"
#include "results/store/mesh_file.hpp"
#include "results/store/provenance.hpp"
#include "solution_example.hpp"
#include "support/refusal.hpp"

using namespace langer;
using example::bytes;
using example::holds;
using example::refusal;
using example::write_bytes;

namespace {

void read_all(const std::string& path) {
  const SolutionReader reader(path);
  for (int i = 0; i < reader.n_steps(); ++i) reader.step(i);
}

std::string solution(const std::string& folder) {
  const std::string path = folder + "/solution.h5";
  SolutionWriter writer(path, example::header(true));
  for (int i = 0; i < 3; ++i) writer.append(example::step(i, true));
  writer.finish();
  return path;
}

}  // namespace

TEST_CASE("missing, foreign and empty files are refused by path") {
  const std::string folder = example::folder("foreign");
  CHECK(holds(refusal([&] { read_mesh(folder + "/none.h5"); }), folder + "/none.h5: no such file"));
  CHECK(holds(refusal([&] { read_mesh(folder); }), "folder"));
  write_bytes(folder + "/text.h5", "a,b\n1,2\n");
  CHECK(
      holds(refusal([&] { read_mesh(folder + "/text.h5"); }), "text.h5: not a readable HDF5 file"));
  write_bytes(folder + "/empty.h5", "");
  CHECK(holds(refusal([&] { read_mesh(folder + "/empty.h5"); }),
              "empty.h5: not a readable HDF5 file"));
  {
    h5::File file = h5::File::create(folder + "/other.h5");
    file.root().write_scalar("x", 1);
    file.commit();
  }
  CHECK(holds(refusal([&] { read_mesh(folder + "/other.h5"); }), "no schema attribute"));
  CHECK(refusal([&] {
          write_mesh(folder + "/no/such/mesh.h5", example::bar(), example::identity());
        }) != "");
}

TEST_CASE("another schema or another version is refused by name") {
  const std::string folder = example::folder("schema");
  write_mesh(folder + "/mesh.h5", example::bar(), example::identity());
  CHECK(holds(refusal([&] { read_material(folder + "/mesh.h5"); }),
              "mesh.h5: /: schema mesh/1; expected material/1"));
  CHECK(holds(refusal([&] { read_curves(folder + "/mesh.h5"); }), "expected curves/1"));
  CHECK(holds(refusal([&] { SolutionReader(folder + "/mesh.h5"); }), "expected solution/1"));
  {
    h5::File file = h5::File::create(folder + "/next.h5");
    write_identity(file.root(), Schema{"mesh", 4}, example::identity());
    file.commit();
  }
  CHECK(holds(refusal([&] { read_mesh(folder + "/next.h5"); }), "schema mesh/4; expected mesh/1"));
}

TEST_CASE("a truncated file is refused, wherever it is cut") {
  const std::string folder = example::folder("truncated"), whole = bytes(solution(folder)),
                    path = folder + "/cut.h5";
  std::mt19937 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const std::size_t length =
        std::uniform_int_distribution<std::size_t>(0, whole.size() - 40)(random);
    CAPTURE(length);
    write_bytes(path, whole.substr(0, length));
    CHECK(refusal([&] { read_all(path); }) != "");
  }
}

TEST_CASE("a file with one wrong bit is refused, whichever bit it is") {
  const std::string folder = example::folder("flipped"), path = folder + "/flipped.h5",
                    whole = bytes(solution(folder));
  std::mt19937 random(2);
  const std::size_t seal = 30;  // behind HDF5's last byte; a damaged seal is no seal
  for (int trial = 0; trial < 2000; ++trial) {
    const std::size_t bit =
        std::uniform_int_distribution<std::size_t>(0, 8 * (whole.size() - seal) - 1)(random);
    CAPTURE(bit);
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    write_bytes(path, damaged);
    CHECK(holds(refusal([&] { read_all(path); }), "flipped.h5: damaged"));
  }
  for (std::size_t bit = 8 * (whole.size() - seal); bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    write_bytes(path, damaged);
    refusal([&] { read_all(path); });  // refused or, as its content is whole, read
  }
}

TEST_CASE("two sign bits turned over show, in whatever words they are") {
  const std::string folder = example::folder("signs"), path = folder + "/signs.h5",
                    whole = bytes(solution(folder));
  std::mt19937 random(5);
  std::uniform_int_distribution<std::size_t> word(0, (whole.size() - 30) / 8 - 1);
  for (int trial = 0; trial < 500; ++trial) {
    const std::size_t a = word(random), b = trial % 2 ? word(random) : (a + 1) % word.b();
    if (a == b) continue;
    std::string damaged = whole;
    for (const std::size_t at : {a, b})
      damaged[8 * at + 7] = static_cast<char>(damaged[8 * at + 7] ^ 0x80);
    write_bytes(path, damaged);
    CHECK(holds(refusal([&] { read_all(path); }), "signs.h5: damaged"));
  }
}

namespace {
// the seal of versions up to 0.2.0
std::string with_older_seal(const std::string& content) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < content.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, content.data() + i, std::min<std::size_t>(8, content.size() - i));
    h = (h ^ word) * 0x100000001b3u;
  }
  return content + fmt::format("\nlanger seal {:016x}\n", h);
}
}  // namespace

TEST_CASE("a file sealed by an older version is read, and refused where it is damaged") {
  const std::string folder = example::folder("older"), path = folder + "/older.h5",
                    whole = bytes(solution(folder));
  const std::string older = with_older_seal(whole.substr(0, whole.size() - 30));
  write_bytes(path, older);
  CHECK(refusal([&] { read_all(path); }) == "");
  std::string damaged = older;
  damaged[older.size() / 2] ^= 4;
  write_bytes(path, damaged);
  CHECK(holds(refusal([&] { read_all(path); }), "older.h5: damaged"));
}

TEST_CASE(
    "what a stopped run leaves is read where it is whole; what a killed one leaves, without a seal, is not") {
  const std::string path = example::folder("stopped") + "/solution.h5", part = path + ".part";
  {
    SolutionWriter writer(path, example::header(true));
    for (int i = 0; i < 3; ++i) writer.append(example::step(i, true));
    CHECK(refusal([&] { read_all(part); }) == "");  // while it is written
    write_bytes(path + ".copy.part", bytes(part));
  }
  CHECK(SolutionReader(part).n_steps() == 3);
  CHECK(refusal([&] { read_all(part); }) == "");
  const std::string whole = bytes(part);
  write_bytes(part, whole.substr(0, whole.size() - 30));
  CHECK(holds(refusal([&] { read_all(part); }),
              "solution.h5.part: was left by a run that was killed"));
  CHECK(
      holds(refusal([&] { read_all(path + ".copy.part"); }), "was left by a run that was killed"));
  for (std::size_t at = 0; at < whole.size(); at += 4096) {
    std::string damaged = whole;
    for (std::size_t i = at; i < std::min(at + 4096, whole.size()); ++i)
      damaged[i] = static_cast<char>(~damaged[i]);
    write_bytes(part, damaged);
    CAPTURE(at);
    CHECK(refusal([&] { read_all(part); }) != "");
  }
  SolutionWriter writer(path, example::header(true));
  CHECK(writer.n_steps() == 3);
}

TEST_CASE(
    "a damaged mesh without seal, as other tools leave it, is refused or read, never a crash") {
  // HDF5 1.10 itself crashes on about one damaged chunked file in 20 000; mesh files have no chunks
  const std::string folder = example::folder("unsealed"), path = folder + "/mesh.h5";
  write_mesh(path, example::bar(), example::identity());
  const std::string whole = bytes(path).substr(0, bytes(path).size() - 30);
  write_bytes(path, whole);
  CHECK(refusal([&] { read_mesh(path); }) == "");
  std::mt19937 random(3);
  int refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::size_t bit =
        std::uniform_int_distribution<std::size_t>(0, 8 * whole.size() - 1)(random);
    CAPTURE(bit);
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    write_bytes(path, damaged);
    refused += refusal([&] { read_mesh(path); }) != "";
  }
  CHECK(refused > 0);
}

namespace {
// a mesh file with one thing wrong, written without the help of write_mesh's caller
std::string with(const std::string& folder, const std::function<void(Mesh&)>& spoil) {
  Mesh mesh = example::bar();
  spoil(mesh);
  write_mesh(folder + "/mesh.h5", mesh, example::identity());
  return refusal([&] { read_mesh(folder + "/mesh.h5"); });
}
}  // namespace

TEST_CASE("a mesh file that contradicts itself is refused at the dataset") {
  const std::string folder = example::folder("contradiction");
  CHECK(with(folder, [](Mesh&) {}) == "");
  CHECK(holds(with(folder, [](Mesh& m) { m.connectivity[5] = 12; }),
              "/VTKHDF/Connectivity: index 12; expected 0 to 11"));
  CHECK(holds(with(folder, [](Mesh& m) { m.connectivity[5] = -1; }), "index -1"));
  CHECK(holds(with(folder, [](Mesh& m) { m.X[3][2] = NAN; }), "/VTKHDF/Points: nan"));
  CHECK(holds(with(folder, [](Mesh& m) { m.body[1] = 2; }), "/VTKHDF/CellData/body: index 2"));
  CHECK(holds(with(folder, [](Mesh& m) { m.frames[1] *= 1.01; }),
              "the frame of cell 1 is not orthonormal"));
  CHECK(holds(with(folder, [](Mesh& m) { m.frames[0].col(2) *= -1; }),
              "the frame of cell 0 is not orthonormal"));
  CHECK(holds(with(folder,
                   [](Mesh& m) {
                     m.node_sets["x_min"] = {0, 99};
                   }),
              "/sets/nodes/x_min: index 99"));
  CHECK(holds(with(folder,
                   [](Mesh& m) {
                     m.facet_sets["y_max"] = {{1, 6}};
                   }),
              "/sets/facets/y_max"));
  CHECK(holds(with(folder,
                   [](Mesh& m) {
                     m.facet_sets["y_max"] = {{2, 0}};
                   }),
              "cell 2, local facet 0"));
}

TEST_CASE("a material file with values out of range or unknown words is refused at the dataset") {
  const std::string folder = example::folder("bad_material"), path = folder + "/material.h5";
  const auto with_material = [&](const std::function<void(const h5::Group&)>& body) {
    h5::File file = h5::File::create(path);
    write_identity(file.root(), material_schema, example::identity());
    body(file.root().make_group("material"));
    file.commit();
    return refusal([&] { read_material(path); });
  };
  CHECK(holds(with_material([](const h5::Group&) {}), "/material/matrix: group is missing"));
  CHECK(holds(with_material([](const h5::Group& m) {
                m.make_group("matrix").make_group("0").make_group("no_such_law");
              }),
              "/material/matrix/0: no known alternative"));
  const auto volume = [](double d) {
    return [d](const h5::Group& m) {
      m.make_group("matrix"), m.make_group("fibres");
      m.make_group("volume").make_group("quadratic").write_scalar("d", d, "1/MPa");
    };
  };
  CHECK(with_material(volume(1e-3)) == "");
  CHECK(holds(with_material(volume(-1)), "/material/volume/quadratic/d"));
  CHECK(holds(with_material(volume(NAN)), "/material/volume/quadratic/d"));
}

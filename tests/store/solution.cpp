#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "core/hdf5/h5.hpp"
#include "solution_example.hpp"
#include "support/near.hpp"

using namespace langer;
using example::bytes;
using example::header;
using example::step;

namespace {
std::string write_solution(const std::string& path, int n, bool contact) {
  SolutionWriter writer(path, header(contact));
  for (int i = writer.n_steps(); i < n; ++i) writer.append(step(i, contact));
  writer.finish();
  return path;
}
}  // namespace

TEST_CASE("a solution comes back as written, with and without contact") {
  for (bool contact : {false, true}) {
    const std::string path =
        write_solution(example::folder("solution") + "/solution.h5", 4, contact);
    CHECK_FALSE(std::filesystem::exists(path + ".part"));
    const SolutionReader reader(path);
    REQUIRE(reader.n_steps() == 4);
    for (int i : {3, 0, 2, 1}) CHECK(example::same(reader.step(i), step(i, contact)));
    CHECK(example::same(reader.header().mesh, example::bar()));
    CHECK(reader.header().contact_nodes == header(contact).contact_nodes);
    CHECK(reader.header().indenter_surfaces.size() == (contact ? 1 : 0));
    for (const auto& [name, surface] : reader.header().indenter_surfaces) {
      const Triangles written = header(contact).indenter_surfaces.at(name);
      CHECK(surface.points == written.points);
      CHECK(surface.corners == written.corners);
    }
    CHECK(reader.header().formulation == "mean_dilatation");
    CHECK(std::get<Yeoh>(reader.header().material.matrix[0]).a2 == 0.376);
    CHECK(reader.content_id() == content_id(header(contact).identity, 1));
    CHECK_THROWS_AS(reader.step(4), Failure);
  }
}

TEST_CASE("a solution has the VTKHDF 2.0 arrays: names, shapes, offsets") {
  const std::string path = write_solution(example::folder("temporal") + "/solution.h5", 3, true);
  const h5::Group grid = h5::File::open(path).root().group("VTKHDF"), steps = grid.group("Steps");
  CHECK(grid.text_attribute("Type") == "UnstructuredGrid");
  CHECK(steps.integer_attribute("NSteps") == 3);
  CHECK(grid.shape("Points") == h5::Shape{12, 3});
  CHECK(grid.group("PointData").shape("u") == h5::Shape{36, 3});
  CHECK(grid.group("CellData").shape("von_mises") == h5::Shape{6});
  CHECK(grid.group("CellData").shape("e_x") == h5::Shape{2, 3});
  using Integers = std::vector<std::int64_t>;
  const auto integers = [](const h5::Group& g, const std::string& name, const h5::Shape& shape) {
    return g.read<std::int64_t>(name, shape).values;
  };
  CHECK(steps.read<double>("Values", {3}).values == std::vector<double>{0.1, 0.2, 0.1 * 3});
  CHECK(integers(steps, "PartOffsets", {3}) == Integers{0, 0, 0});
  CHECK(integers(steps, "PointOffsets", {3}) == Integers{0, 0, 0});
  CHECK(integers(steps, "NumberOfParts", {3}) == Integers{1, 1, 1});
  CHECK(integers(steps, "CellOffsets", {3, 1}) == Integers{0, 0, 0});
  CHECK(integers(steps, "ConnectivityIdOffsets", {3, 1}) == Integers{0, 0, 0});
  CHECK(integers(steps.group("PointDataOffsets"), "u", {3}) == Integers{0, 12, 24});
  CHECK(integers(steps.group("PointDataOffsets"), "reaction", {3}) == Integers{0, 12, 24});
  CHECK(integers(steps.group("CellDataOffsets"), "J", {3}) == Integers{0, 2, 4});
  CHECK(integers(steps.group("CellDataOffsets"), "e_z", {3}) == Integers{0, 0, 0});
}

TEST_CASE("histories: reactions are summed over each set, contact states are counted") {
  const std::string path = write_solution(example::folder("history") + "/solution.h5", 3, true);
  const h5::Group root = h5::File::open(path).root(), history = root.group("history");
  const auto sum = history.group("reactions")
                       .read<double>("x_min", {3, 3})
                       .values;  // nodes 0 3 6 9, reaction (1, i, n/3)
  CHECK(sum[6] == 4);
  CHECK(sum[7] == 8);
  CHECK(sum[8] == near(6, 1e-15));
  for (const char* name : {"contact_open", "contact_stick", "contact_slip"})
    CHECK(history.read<std::int64_t>(name, {3}).values == std::vector<std::int64_t>{1, 1, 1});
  CHECK(history.unit("force_ind") == "N");
  CHECK(root.group("contact").group("indenter").shape("r") == h5::Shape{3, 3, 3});
}

TEST_CASE("without contact the file has no contact group, no indenter") {
  const std::string path = write_solution(example::folder("no_contact") + "/solution.h5", 2, false);
  const h5::Group root = h5::File::open(path).root();
  CHECK_FALSE(root.has("contact"));
  for (const char* name : {"u_ind", "force_ind", "contact_open"})
    CHECK_FALSE(root.group("history").has(name));
}

TEST_CASE("an abandoned run continues after its last step, to the same bytes as a run in one go") {
  setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  const std::string folder = example::folder("resume"), path = folder + "/solution.h5";
  const std::string whole = write_solution(folder + "/whole.h5", 5, true);
  {
    SolutionWriter writer(path, header(true));
    CHECK_FALSE(writer.resumed());
    for (int i = 0; i < 3; ++i) writer.append(step(i, true));
  }
  CHECK_FALSE(std::filesystem::exists(path));
  {
    SolutionWriter writer(path, header(true));
    CHECK(writer.n_steps() == 3);
    REQUIRE(writer.resumed());
    CHECK(example::same(*writer.resumed(), step(2, true)));
    REQUIRE(writer.before_resumed());
    CHECK(example::same(*writer.before_resumed(), step(1, true)));
  }
  write_solution(path, 5, true);
  unsetenv("SOURCE_DATE_EPOCH");
  CHECK(bytes(path) == bytes(whole));
  CHECK_FALSE(std::filesystem::exists(path + ".steps"));
}

TEST_CASE("a run with another config, other inputs or another mesh starts anew") {
  const std::string path = example::folder("anew") + "/solution.h5";
  const auto kept_by = [&](const std::function<void(SolutionHeader&)>& change) {
    { SolutionWriter(path, header(true)).append(step(0, true)); }
    SolutionHeader other = header(true);
    change(other);
    const int kept = SolutionWriter(path, other).n_steps();
    std::filesystem::remove(path + ".part");
    return kept;
  };
  CHECK(kept_by([](SolutionHeader&) {}) == 1);
  CHECK(kept_by([](SolutionHeader& h) { h.identity.command = "langer-solve typed otherwise"; }) ==
        1);
  CHECK(kept_by([](SolutionHeader& h) { h.identity.config_hash = fnv1a("another"); }) == 0);
  CHECK(kept_by([](SolutionHeader& h) { h.identity.inputs["mesh"] = fnv1a("another"); }) == 0);
  CHECK(kept_by([](SolutionHeader& h) { h.formulation = "displacement"; }) == 0);
  // the same ids, made by other code
  CHECK(kept_by([](SolutionHeader& h) { h.mesh.X[3][0] += 0.125; }) == 0);
  CHECK(kept_by([](SolutionHeader& h) {
          std::swap(h.mesh.connectivity[1], h.mesh.connectivity[3]);
        }) == 0);
  CHECK(kept_by([](SolutionHeader& h) { h.mesh.body[0] = 1 - h.mesh.body[0]; }) == 0);
  CHECK(kept_by([](SolutionHeader& h) {
          h.mesh.frames[0].col(0) *= -1, h.mesh.frames[0].col(1) *= -1;
        }) == 0);
  CHECK(kept_by([](SolutionHeader& h) { h.mesh.node_sets["x_min"].pop_back(); }) == 0);
  CHECK(kept_by([](SolutionHeader& h) { h.contact_nodes["indenter"] = {3, 4, 6}; }) == 0);
  CHECK(kept_by([](SolutionHeader& h) {
          h.mesh.section = Section{SectionOf::plane_strain, 1};
        }) == 0);
  CHECK(kept_by([](SolutionHeader& h) { h.mesh.facet_sets["x_min"] = {{0, 5}}; }) == 0);
}

TEST_CASE(
    "a run with other settings of the solver continues, and the file says which steps were made by which") {
  const std::string path = example::folder("settings") + "/solution.h5";
  SolutionHeader first = header(false), then = header(false);
  first.identity.steps_hash = then.identity.steps_hash = fnv1a("what steps depend on");
  first.identity.config = "threads: 1", first.identity.config_hash = fnv1a("threads: 1");
  then.identity.config = "threads: 2", then.identity.config_hash = fnv1a("threads: 2");
  {
    SolutionWriter writer(path, first);
    for (int i = 0; i < 3; ++i) writer.append(step(i, false));
  }
  { CHECK(SolutionWriter(path, then).n_steps() == 3); }  // a run that adds nothing
  SolutionWriter writer(path, then);
  REQUIRE(writer.n_steps() == 3);
  writer.append(step(3, false));
  writer.finish();
  const h5::Group provenance = h5::File::open(path).root().group("provenance");
  CHECK(provenance.read_text("config") == "threads: 2");
  REQUIRE(provenance.group("earlier").groups() == std::vector<std::string>{"0"});
  CHECK(provenance.group("earlier").group("0").read_text("config") == "threads: 1");
  CHECK(provenance.group("earlier").group("0").integer_attribute("steps") == 3);
}

TEST_CASE("steps that are not good enough any more are made anew, with all behind them") {
  const std::string path = example::folder("not_good_enough") + "/solution.h5";
  {
    SolutionWriter writer(path, header(true));
    for (int i = 0; i < 5; ++i) writer.append(step(i, true));
  }
  {
    SolutionWriter writer(path, header(true), [](const StepRecord& s, const EarlierRun&) {
      return s.residual < 2.5e-9;
    });
    CHECK(writer.n_steps() == 2);
    writer.append(step(7, true));
  }
  SolutionWriter writer(path, header(true));
  REQUIRE(writer.n_steps() == 3);
  CHECK(example::same(*writer.resumed(), step(7, true)));
  CHECK(example::same(*writer.before_resumed(), step(1, true)));
}

TEST_CASE("whoever removes the .part begins anew; one of a version that kept no checksums too") {
  const std::string path = example::folder("removed") + "/solution.h5";
  { SolutionWriter(path, header(false)).append(step(0, false)); }
  std::filesystem::remove(path + ".part");
  { CHECK(SolutionWriter(path, header(false)).n_steps() == 0); }
  { SolutionWriter(path, header(false)).append(step(0, false)); }
  std::filesystem::remove(path + ".steps");
  CHECK(SolutionWriter(path, header(false)).n_steps() == 0);
}

TEST_CASE("a .part that cannot be read is replaced, one that is being written is not") {
  const std::string path = example::folder("part") + "/solution.h5";
  example::write_bytes(path + ".part", "not HDF5");
  SolutionWriter writer(path, header(false));
  CHECK(writer.n_steps() == 0);
  const pid_t child = fork();
  if (child == 0) {  // another process: locks are between processes
    try {
      SolutionWriter second(path, header(false));
    } catch (const Failure& failure) {
      _exit(failure.code() == Exit::input ? 42 : 1);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WEXITSTATUS(status) == 42);
  writer.append(step(0, false));
  writer.finish();
  CHECK(SolutionReader(path).n_steps() == 1);
}

TEST_CASE("a killed run leaves its committed steps readable, wherever it is hit") {
  const int n = 400;
  std::mt19937 random(7);
  int most = 0;
  for (int trial = 0; trial < 12; ++trial) {
    CAPTURE(trial);
    const std::string path = example::folder("killed") + "/solution.h5";
    const pid_t child = fork();
    if (child == 0) {
      SolutionWriter writer(path, header(true));
      std::ofstream progress(path + ".progress");
      for (int i = 0; i < n; ++i) {
        writer.append(step(i, true));
        progress << i + 1 << std::endl;
      }
      pause();
    }
    // every other kill meets a program that has kept a step, however slow the machine is
    for (int i = 0; trial % 2 == 0 && i < 60000; ++i) {
      int first = 0;
      if (std::ifstream(path + ".progress") >> first) break;
      usleep(1000);
    }
    usleep(std::uniform_int_distribution<useconds_t>(30000, 400000)(random));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    int reported = 0;
    std::ifstream progress(path + ".progress");
    for (int k; progress >> k;) reported = k;
    SolutionWriter writer(path, header(true));
    CHECK(writer.n_steps() >= reported);  // whatever append() returned from is kept
    CHECK(writer.n_steps() <= reported + 1);
    if (writer.n_steps() > 0)
      CHECK(example::same(*writer.resumed(), step(writer.n_steps() - 1, true)));
    most = std::max(most, writer.n_steps());
  }
  CHECK(most > 0);
}

TEST_CASE("a record that does not fit is refused before anything is written") {
  const std::string path = example::folder("misfit") + "/solution.h5";
  SolutionWriter writer(path, header(true));
  writer.append(step(0, true));
  StepRecord bad = step(1, true);
  bad.u[3][1] = NAN;
  CHECK_THROWS_AS(writer.append(bad), Failure);
  bad = step(1, true), bad.u.pop_back();
  CHECK_THROWS_AS(writer.append(bad), Failure);
  bad = step(1, true), bad.contacts.clear();
  CHECK_THROWS_AS(writer.append(bad), Failure);
  bad = step(1, true), bad.cell_fields.erase("J");
  CHECK_THROWS_AS(writer.append(bad), Failure);
  writer.append(step(1, true));
  writer.finish();
  CHECK(example::same(SolutionReader(path).step(1), step(1, true)));
}

TEST_CASE("without fibres a solution holds frames only where a mesh turns them") {
  for (bool turned : {false, true})
    for (bool fibres : {false, true}) {
      CAPTURE(turned);
      CAPTURE(fibres);
      SolutionHeader h = header(false);
      if (!turned) h.mesh.frames.assign(2, Mat3::Identity());
      if (!fibres) h.material.fibres.clear();
      const std::string path = example::folder("frames") + "/solution.h5";
      {
        SolutionWriter writer(path, h);
        for (int i = 0; i < 2; ++i) writer.append(step(i, false));
        writer.finish();
      }
      const h5::Group grid = h5::File::open(path).root().group("VTKHDF");
      for (const char* axis : {"e_x", "e_y", "e_z"}) {
        CHECK(grid.group("CellData").has(axis) == (turned || fibres));
        CHECK(grid.group("Steps").group("CellDataOffsets").has(axis) == (turned || fibres));
      }
      const SolutionReader reader(path);
      CHECK(reader.header().mesh.frames == h.mesh.frames);
      CHECK(example::same(reader.step(1), step(1, false)));
    }
}

// What belongs to the user is never written over.
#include "core/hdf5/replace.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <array>

#include "core/hdf5/h5.hpp"
#include "core/hdf5/seal.hpp"
#include "example.hpp"
#include "results/store/curves_file.hpp"
#include "results/store/journal.hpp"
#include "results/store/lock.hpp"
#include "results/store/mesh_file.hpp"
#include "results/store/side_files.hpp"
#include "support/refusal.hpp"

using namespace langer;
using example::holds;
using example::refusal;
using example::write_bytes;

TEST_CASE("what a run reads is not replaced, whatever name leads to it") {
  const std::string folder = example::folder("spared"), data = folder + "/fit.csv";
  write_bytes(data, "strain,stress_MPa\n0,0\n");
  std::filesystem::create_hard_link(data, folder + "/same.csv");
  never_replace(data);
  for (const std::string name : {"/fit.csv", "/same.csv", "/../spared/fit.csv"}) {
    CHECK(holds(refusal([&] { write_text_file(folder + name, "strain,stress_MPa\n"); }),
                "is read by this run and would be replaced"));
    CHECK(holds(refusal([&] { h5::File::create(folder + name); }), "is read by this run"));
    CHECK(holds(refusal([&] { require_own_log(folder + name); }), "is read by this run"));
  }
  CHECK(example::bytes(data) == "strain,stress_MPa\n0,0\n");
  CHECK_FALSE(std::filesystem::exists(data + ".part"));
  CHECK(refusal([&] { write_text_file(folder + "/other.csv", "a\n"); }) == "");
}

TEST_CASE("devices, FIFOs, folders and links are not replaced") {
  const std::string folder = example::folder("no_file");
  write_bytes(folder + "/target.h5", "");
  REQUIRE(mkfifo((folder + "/fifo").c_str(), 0600) == 0);
  std::filesystem::create_symlink(folder + "/target.h5", folder + "/link");
  std::filesystem::create_symlink(folder + "/nowhere", folder + "/dangling");
  const std::vector<std::array<std::string, 2>> cases{
      {"/dev/null", "is no plain file"},
      {folder + "/fifo", "is no plain file"},
      {folder, "is a folder"},
      {folder + "/link", "is a link to " + folder + "/target.h5"},
      {folder + "/dangling", "is a link to"}};
  for (const auto& refused : cases) {
    const std::string &path = refused[0], &found = refused[1];
    CAPTURE(path);
    CHECK(holds(refusal([&] { require_own_output(path); }), found));
    CHECK(holds(refusal([&] { write_text_file(path, "a\n"); }), found));
    CHECK(holds(refusal([&] { h5::File::create(path); }), found));
  }
  CHECK(refusal([&] { require_own_log("/dev/null"); }) == "");
  CHECK(refusal([&] { require_own_log(folder + "/new.log"); }) == "");
  for (const char* name : {"/fifo", "/link", "/dangling"})
    CHECK(refusal([&] { require_own_log(folder + name); }) != "");
}

TEST_CASE("an output or a log that is there has to be ours") {
  const std::string folder = example::folder("own");
  write_mesh(folder + "/mesh.h5", example::bar(), example::identity());
  write_bytes(folder + "/empty.h5", "");
  write_bytes(folder + "/notes.txt", "what I found\n");
  write_bytes(folder + "/cut.h5", example::bytes(folder + "/mesh.h5").substr(0, 9000));
  write_bytes(folder + "/report.html",
              "<!DOCTYPE html>\n<html lang=\"en\">\n<p>made by langer-report");
  write_bytes(folder + "/page.html", "<!DOCTYPE html>\n<html lang=\"en\">\n<p>my own page");
  write_bytes(folder + "/solve.log", "# langer-solve solve.yaml\n");
  for (const char* name : {"/mesh.h5", "/empty.h5", "/cut.h5", "/report.html", "/none.h5"})
    CHECK(refusal([&] { require_own_output(folder + name); }) == "");
  for (const char* name : {"/notes.txt", "/solve.log", "/page.html"})
    CHECK(holds(refusal([&] { require_own_output(folder + name); }),
                "is there already and was not made by langer"));
  for (const char* name : {"/solve.log", "/none.log"})
    CHECK(refusal([&] { require_own_log(folder + name); }) == "");
  for (const char* name : {"/notes.txt", "/mesh.h5"})
    CHECK(holds(refusal([&] { require_own_log(folder + name); }), "is no log of langer"));
}

TEST_CASE(
    "beside an output that is made for the first time, a text with another first line is somebody else's") {
  const std::string folder = example::folder("beside"),
                    ours = "strain,stress_MPa,model_MPa\n0,0,0\n",
                    theirs = "strain,stress_MPa\n0,0\n";
  begin_beside(folder + "/material.h5");
  write_bytes(folder + "/fit.csv", theirs);
  CHECK(holds(refusal([&] { write_text_file(folder + "/fit.csv", ours); }),
              "was not made by this step"));
  CHECK(example::bytes(folder + "/fit.csv") == theirs);
  write_bytes(folder + "/fit.csv",
              "strain,stress_MPa,model_MPa\n0,0,0.5\n");  // of a run that was killed
  CHECK(refusal([&] { write_text_file(folder + "/fit.csv", ours); }) == "");
  write_bytes(folder + "/material.h5", "");
  begin_beside(folder + "/material.h5");  // other columns in another run of the same step
  write_bytes(folder + "/fit.csv", theirs);
  CHECK(refusal([&] { write_text_file(folder + "/fit.csv", ours); }) == "");
}

TEST_CASE(
    "a picture or a table of HDF5 beside the output is ours where its script, or a mark, says so") {
  const std::string folder = example::folder("pictures");
  begin_beside(folder + "/curves.h5");
  write_bytes(folder + "/render.png", "a photograph");
  CHECK(holds(
      refusal([&] { require_replaceable_from(folder + "/render.png", folder + "/render.gp"); }),
      "was not made by this step"));
  write_bytes(folder + "/render.gp", "# made by langer\n");  // of a run that was killed
  CHECK(refusal([&] { require_replaceable_from(folder + "/render.png", folder + "/render.gp"); }) ==
        "");
  CHECK(refusal([&] { require_replaceable_from(folder + "/other.png", folder + "/other.gp"); }) ==
        "");
  write_bytes(folder + "/snapshot_0001.hdf", "\x89HDF\r\n\x1a\n of another program");
  CHECK(holds(refusal([&] { h5::File::create(folder + "/snapshot_0001.hdf"); }),
              "was not made by langer"));
  write_bytes(folder + "/scene.feb", "<?xml version=\"1.0\"?>\n<febio_spec/>\n");
  CHECK(holds(refusal([&] { require_own_text(folder + "/scene.feb", "written by langer"); }),
              "was not made by langer"));
  write_bytes(folder + "/scene.feb", "<?xml version=\"1.0\"?>\n<!-- written by langer 0.2.0 -->\n");
  CHECK(refusal([&] { require_own_text(folder + "/scene.feb", "written by langer"); }) == "");
}

TEST_CASE("a cell of a CSV table stands between quotes where it has to") {
  for (const char* plain : {"", "a1", "mu_star_c1_MPa", "0.5 to 1", "Größe", "a/b", "it's"})
    CHECK(csv_cell(plain) == plain);
  CHECK(csv_cell("a,b") == "\"a,b\"");
  CHECK(csv_cell("say \"yes\"") == "\"say \"\"yes\"\"\"");
  CHECK(csv_cell("two\nlines") == "\"two\nlines\"");
  CHECK(csv_cell("a;b") == "\"a;b\"");
  CHECK(csv_cell("# no comment") == "\"# no comment\"");
  CHECK(csv_cell(" blank") == "\" blank\"");
  CHECK(csv({{"a, b", "-", {1}}, {"c", "N, mm", {2}}}) == "\"a, b\",\"c_N,_mm\"\n1,2\n");
}

TEST_CASE("a link called <output>.part, .steps or .lock is refused and its target stays") {
  const std::string folder = example::folder("part_links");
  const std::string victim = folder + "/victim.txt";
  const std::string output = folder + "/mesh.h5";
  write_bytes(victim, "my thesis\n");
  const auto with_link = [&](const std::string& name, const std::function<void()>& act) {
    CAPTURE(name);
    std::filesystem::create_symlink("victim.txt", folder + name);
    CHECK(holds(refusal(act), "is a link to victim.txt"));
    CHECK(example::bytes(victim) == "my thesis\n");
    std::filesystem::remove(folder + name);
  };
  with_link("/curves.csv.part", [&] { write_text_file(folder + "/curves.csv", "a\n"); });
  with_link("/Makefile.part", [&] { write_text_file_soon(folder + "/Makefile", "all:\n"); });
  with_link("/figure.pdf.part", [&] { replace_file(folder + "/figure.pdf", "%PDF"); });
  with_link("/mesh.h5.part", [&] { write_mesh(output, example::bar(), example::identity()); });
  with_link("/mesh.h5.steps", [&] { Journal journal(output + ".steps"); });
  with_link("/mesh.h5.lock", [&] { OutputLock lock(output, "langer-mesh"); });

  // a second name of the file instead of a link: the file under the other name stays
  for (const std::string name : {"/curves.csv", "/mesh.h5"}) {
    std::filesystem::create_hard_link(victim, folder + name + ".part");
  }
  write_text_file(folder + "/curves.csv", "a\n");
  write_mesh(output, example::bar(), example::identity());
  CHECK(example::bytes(victim) == "my thesis\n");
  CHECK(example::bytes(folder + "/curves.csv") == "a\n");
  CHECK(read_mesh(output).mesh.n_cells() == example::bar().n_cells());
}

TEST_CASE("a file that only has the name of a lock is not removed") {
  const std::string folder = example::folder("foreign_lock");
  write_bytes(folder + "/mesh.h5.lock", "combination of the safe: 1234\n");
  CHECK(holds(refusal([&] { OutputLock lock(folder + "/mesh.h5", "langer-mesh"); }),
              "is no lock of langer"));
  CHECK(example::bytes(folder + "/mesh.h5.lock") == "combination of the safe: 1234\n");
}

TEST_CASE("side files of a second output in a folder have a folder of their own") {
  const std::string folder = example::folder("side_files");
  const std::vector<std::string> names{"parameters.csv", "fit.csv"};
  const auto made = [&](const std::string& name, const std::string& stage) {
    Identity identity = example::identity();
    identity.stage = stage;
    write_mesh(folder + name, example::bar(), identity);
  };
  CHECK(side_folder(folder + "/neo.h5", "fit", names).path == folder);
  write_bytes(folder + "/parameters.csv", "parameter,true\n");  // a run that was killed here
  CHECK(side_folder(folder + "/neo.h5", "fit", names).path == folder);
  made("/solution.h5", "solve");  // another stage has files of other names
  CHECK(side_folder(folder + "/neo.h5", "fit", names).path == folder);
  made("/neo.h5", "fit");

  SideFolder second = side_folder(folder + "/yeoh.h5", "fit", names);
  CHECK(second.path == folder + "/yeoh_files");
  CHECK(second.owner == "neo.h5");
  CHECK(std::filesystem::is_directory(second.path));
  CHECK(side_folder(folder + "/curves.h5", "fit", {}).path == folder);  // none are asked for
  CHECK(side_folder(folder + "/curves.h5", "fit", {"map.csv"}).path == folder);  // a free name

  // Both again, in any order: each keeps its place.
  made("/yeoh.h5", "fit");
  for (int turn = 0; turn < 2; ++turn) {
    CHECK(side_folder(folder + "/neo.h5", "fit", names).path == folder);
    CHECK(side_folder(folder + "/yeoh.h5", "fit", names).path == folder + "/yeoh_files");
  }
  // The first is made anew after its output was removed: the plain names are still its own.
  std::filesystem::remove(folder + "/neo.h5");
  CHECK(side_folder(folder + "/neo.h5", "fit", names).path == folder);
}

TEST_CASE("two runs of a stage in one folder at the same time have different places") {
  const std::string folder = example::folder("side_files_running");
  const OutputLock other(folder + "/neo.h5", "langer-fit neo.yaml -o neo.h5");
  CHECK(side_folder(folder + "/yeoh.h5", "fit", {"fit.csv"}).path == folder + "/yeoh_files");
  CHECK(side_folder(folder + "/sweep.h5", "gather", {"table.csv"}).path == folder);
}

TEST_CASE("a side file that is a link is refused before the work begins") {
  const std::string folder = example::folder("side_links");
  write_bytes(folder + "/victim.txt", "my thesis\n");
  std::filesystem::create_symlink("victim.txt", folder + "/fit.csv");
  CHECK(holds(refusal([&] { side_folder(folder + "/m.h5", "fit", {"fit.csv"}); }), "is a link to"));
  std::filesystem::remove(folder + "/fit.csv");
  std::filesystem::create_directory(folder + "/elsewhere");
  std::filesystem::create_directory_symlink("elsewhere", folder + "/m_files");
  CHECK(holds(refusal([&] { side_folder(folder + "/m.h5", "fit", {"fit.csv"}); }), "is a link to"));
}

// Nothing that a run writes lands in a file that it does not own, whatever lies in its folder.
#include "core/base/output_file.hpp"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/base/printable.hpp"
#include "support/refusal.hpp"

using namespace langer;
using langer::example::holds;
using langer::example::refusal;

namespace {

namespace fs = std::filesystem;

// An empty folder with somebody's file, victim.txt, in it.
fs::path folder_with_victim(const std::string& name) {
  const fs::path path =
      fs::temp_directory_path() / ("langer_output_" + std::to_string(getpid()) + "_" + name);
  fs::remove_all(path);
  fs::create_directories(path);
  std::ofstream(path / "victim.txt") << "my thesis\n";
  return path;
}

std::string bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_with(int fd, const std::string& text) {
  REQUIRE(fd >= 0);
  CHECK(write_bytes_to(fd, text));
  ::close(fd);
}

}  // namespace

TEST_CASE("a new file replaces a plain one and leaves what other names lead to") {
  const fs::path folder = folder_with_victim("new");
  const std::string part = (folder / "curves.csv.part").string();
  write_with(create_file(part), "first\n");
  CHECK(bytes(part) == "first\n");
  write_with(create_file(part), "second\n");
  CHECK(bytes(part) == "second\n");

  fs::remove(part);
  fs::create_hard_link(folder / "victim.txt", part);
  write_with(create_file(part), "third\n");
  CHECK(bytes(part) == "third\n");
  CHECK(bytes(folder / "victim.txt") == "my thesis\n");
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    CAPTURE(entry.path().string());
    ++files;
  }
  CHECK(files == 2);  // no file with a hidden name is left
}

TEST_CASE("links, folders and pipes are refused and stay as they are") {
  const fs::path folder = folder_with_victim("kinds");
  fs::create_symlink("victim.txt", folder / "link");
  fs::create_symlink("nowhere.txt", folder / "dangling");
  fs::create_directory(folder / "folder");
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  for (const auto& [name, found] :
       {std::pair<std::string, std::string>{"link", "is a link to victim.txt"},
        {"dangling", "is a link to nowhere.txt"},
        {"folder", "is a folder"},
        {"pipe", "is no plain file"}}) {
    const auto shown = name;
    CAPTURE(shown);
    const std::string path = (folder / name).string();
    CHECK(holds(refusal([&] { create_file(path); }), found));
    if (name == "folder") continue;
    CHECK(holds(refusal([&] { open_kept_file(path); }), found));
    CHECK(refusal([&] { open_log_file(path, true); }) != "");
    CHECK(refusal([&] { open_log_file(path, false); }) != "");
  }
  CHECK(bytes(folder / "victim.txt") == "my thesis\n");
  CHECK_FALSE(fs::exists(folder / "nowhere.txt"));
}

TEST_CASE("a journal keeps what it holds, unless it is a second name of another file") {
  const fs::path folder = folder_with_victim("kept");
  const std::string journal = (folder / "solution.h5.steps").string();
  write_with(open_kept_file(journal), "steps\n");
  ::close(open_kept_file(journal));
  CHECK(bytes(journal) == "steps\n");
  fs::remove(journal);
  fs::create_hard_link(folder / "victim.txt", journal);
  CHECK(holds(refusal([&] { open_kept_file(journal); }), "is a hard link"));
  CHECK(bytes(folder / "victim.txt") == "my thesis\n");
}

TEST_CASE("a log is replaced or continued, and a hard link to it keeps the old one") {
  const fs::path folder = folder_with_victim("log");
  const std::string path = (folder / "solve.log").string();
  const auto add = [&](const char* line, bool append) {
    std::FILE* const log = open_log_file(path, append);
    REQUIRE(log);
    std::fputs(line, log);
    std::fclose(log);
  };
  add("one\n", false);
  add("two\n", true);
  CHECK(bytes(path) == "one\ntwo\n");
  fs::create_hard_link(path, folder / "kept.log");
  add("three\n", false);
  CHECK(bytes(path) == "three\n");
  CHECK(bytes(folder / "kept.log") == "one\ntwo\n");
  std::FILE* const null = open_log_file("/dev/null", false);
  REQUIRE(null);
  std::fclose(null);
}

TEST_CASE("folders of results are made, but not through a link") {
  const fs::path folder = folder_with_victim("folders");
  const std::string run = (folder / "runs/p").string();
  make_folder_below(run, run + "/alpha_0/mesh");
  CHECK(fs::is_directory(run + "/alpha_0/mesh"));
  fs::create_directory(folder / "home");
  fs::create_directory_symlink(folder / "home", run + "/solve");
  for (const std::string below : {"/solve", "/solve/deeper"}) {
    CHECK(holds(refusal([&] { make_folder_below(run, run + below); }), "is a link to"));
  }
  CHECK(fs::is_empty(folder / "home"));
  fs::create_directory_symlink(run, folder / "mine");  // the user's own choice of a folder
  CHECK(refusal([&] {
          make_folder_below((folder / "mine").string(), (folder / "mine/post").string());
        }) == "");
  CHECK(holds(refusal([&] { make_folder_below(run, (folder / "victim.txt/x").string()); }),
              "cannot be made"));
}

TEST_CASE("control characters of a name are shown by their codes") {
  CHECK(printable("a\nb\tc\x1b[2Jd\x7f") == "a\\nb\\tc\\x1b[2Jd\\x7f");
  CHECK(printable("a\nb\tc", "\n\t") == "a\nb\tc");
  CHECK(printable("Gewebe, ä, σ") == "Gewebe, ä, σ");
  CHECK(has_control("a\rb"));
  CHECK_FALSE(has_control("ä b"));
  const Error error{{"pl\x1b[31m.yaml", 2, 3}, "no\nde", "found \"\x1b]0;\"", "", ""};
  CHECK(text(error) == "pl\\x1b[31m.yaml:2:3: no\\nde: found \"\\x1b]0;\"");
}

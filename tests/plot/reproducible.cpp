// With SOURCE_DATE_EPOCH two runs give the same bytes of every picture, at different times of day.
#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "results/plot/figure_style.hpp"
#include "results/plot/gnuplot.hpp"

using namespace langer;

namespace {

namespace fs = std::filesystem;

std::string bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

fs::path folder_with_script() {
  const fs::path folder = fs::temp_directory_path() / ("langer_dates_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder / "c.csv") << "t,u_mm\n0,0\n1,2\n2,3\n";
  FigureStyle style;
  style.formats = {PictureFormat::svg, PictureFormat::png, PictureFormat::pdf, PictureFormat::eps};
  const Plot plot{"a title", "t", "u", {{"c.csv", "t", "u_mm", "u"}}};
  std::ofstream(folder / "f.gp") << gnuplot_script(plot, "f", style);
  return folder;
}

}  // namespace

TEST_CASE("pictures drawn at different times have the same bytes under SOURCE_DATE_EPOCH") {
  const fs::path folder = folder_with_script();
  ::setenv("SOURCE_DATE_EPOCH", "1767323045", 1);  // 2026-01-02 03:04:05
  REQUIRE(run_gnuplot(folder.string(), "f.gp") == "");
  std::vector<std::string> first;
  for (const char* type : {"svg", "png", "pdf", "eps"}) {
    first.push_back(bytes(folder / (std::string("f.") + type)));
    CHECK(first.back().size() > 500);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  REQUIRE(run_gnuplot(folder.string(), "f.gp") == "");
  ::unsetenv("SOURCE_DATE_EPOCH");
  std::size_t i = 0;
  for (const char* type : {"svg", "png", "pdf", "eps"}) {
    CAPTURE(type);
    CHECK(bytes(folder / (std::string("f.") + type)) == first[i++]);
  }
  CHECK(first[3].find("\n%%CreationDate: Fri Jan  2 03:04:05 2026\n") != std::string::npos);
  if (first[2].find("/CreationDate") != std::string::npos) {
    CHECK(first[2].find("/CreationDate (D:20260102030405") != std::string::npos);
  }
}

TEST_CASE("gnuplot draws in a folder of its own: a link with a picture's name is refused") {
  const fs::path folder = folder_with_script();
  std::ofstream(folder / "victim.txt") << "my thesis\n";
  fs::create_symlink("victim.txt", folder / "f.pdf");
  CHECK(run_gnuplot(folder.string(), "f.gp").find("is a link to victim.txt") != std::string::npos);
  CHECK(bytes(folder / "victim.txt") == "my thesis\n");
  for (const auto& entry : fs::directory_iterator(folder)) {
    CHECK_FALSE(entry.is_directory());  // nothing is left of that folder
  }
}

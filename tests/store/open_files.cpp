// A limit of the system is not called damage of the file.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>

#include "core/hdf5/h5.hpp"
#include "results/store/mesh_file.hpp"
#include "support/block.hpp"

using namespace langer;

TEST_CASE(
    "too many open files: the message names the limit, and the file opens once it is raised") {
  const std::string path =
      std::filesystem::temp_directory_path() / ("langer_open_" + std::to_string(getpid()) + ".h5");
  write_mesh(path, test::block({0, 1}, {0, 1}, {0, 1}), {"mesh", "", "0", {}, ""});
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_NOFILE, &before) == 0);
  // as many as are open now
  const int next = ::open("/dev/null", O_RDONLY);
  REQUIRE(next >= 0);
  ::close(next);
  rlimit low = before;
  low.rlim_cur = static_cast<rlim_t>(next);
  REQUIRE(setrlimit(RLIMIT_NOFILE, &low) == 0);
  std::string said;
  try {
    h5::File::open(path);
  } catch (const Failure& failure) {
    said = failure.what();
  }
  REQUIRE(setrlimit(RLIMIT_NOFILE, &before) == 0);
  CHECK(said.find("too many open files") != std::string::npos);
  CHECK(said.find("ulimit -n") != std::string::npos);
  CHECK(said.find("truncated") == std::string::npos);
  h5::File::open(path);
  std::filesystem::remove(path);
}

// Input files: regular ones are read, anything else is refused without waiting for it.
#include "core/base/input_file.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"

using namespace langer;

namespace {

namespace fs = std::filesystem;

fs::path empty_folder() {
  const fs::path path = fs::temp_directory_path() / ("langer_input_" + std::to_string(getpid()));
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

std::string refusal(const fs::path& path) {
  const auto start = std::chrono::steady_clock::now();
  std::string message;
  try {
    read_file(path.string(), "a table");
  } catch (const Failure& failure) {
    CHECK(failure.code() == Exit::input);
    message = failure.what();
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
  return message;
}

}  // namespace

TEST_CASE("a regular file is read with every byte, directly and through a link") {
  const fs::path folder = empty_folder();
  for (const std::size_t length : {0u, 1u, 65535u, 65536u, 65537u, 300000u}) {
    std::string bytes(length, '\0');
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<char>(i * 7 + i / 256);
    std::ofstream(folder / "file", std::ios::binary) << bytes;
    fs::remove(folder / "link");
    fs::create_symlink("file", folder / "link");
    CHECK(read_file((folder / "file").string()) == bytes);
    CHECK(read_file((folder / "link").string()) == bytes);
    CHECK(unreadable_reason((folder / "link").string()).empty());
  }
  fs::remove_all(folder);
}

TEST_CASE("a pipe, a device, a socket, a folder and nothing are refused at once by their kind") {
  const fs::path folder = empty_folder();
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  fs::create_symlink("pipe", folder / "link");
  fs::create_symlink("nowhere", folder / "lost");
  fs::create_symlink("loop", folder / "loop");
  const int socket_number = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (folder / "socket").c_str(), sizeof address.sun_path - 1);
  REQUIRE(bind(socket_number, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);

  const auto expected = [](const fs::path& path, const std::string& reason) {
    return path.string() + ": " + reason + "; expected a table";
  };
  CHECK(refusal(folder / "pipe") == expected(folder / "pipe", "this is a pipe, not a file"));
  CHECK(refusal(folder / "link") == expected(folder / "link", "this is a pipe, not a file"));
  CHECK(refusal(folder / "socket") == expected(folder / "socket", "this is a socket, not a file"));
  CHECK(refusal("/dev/zero") == expected("/dev/zero", "this is a device, not a file"));
  CHECK(refusal("/dev/tty") == expected("/dev/tty", "this is a device, not a file"));
  CHECK(refusal(folder) == expected(folder, "this is a folder, not a file"));
  CHECK(refusal(folder / "lost") == expected(folder / "lost", "there is no such file"));
  CHECK(refusal(folder / "pipe/x") == expected(folder / "pipe/x", "there is no such file"));
  CHECK(refusal("") == "there is no such file; expected a table");
  CHECK(refusal(folder / "loop").find("cannot be read (") != std::string::npos);
  close(socket_number);
  fs::remove_all(folder);
}

TEST_CASE("a file larger than the memory is refused before it is read") {
  const fs::path folder = empty_folder();
  const std::string path = (folder / "sparse").string();
  std::ofstream(path) << "x";
  // a file of holes takes no place on the disk
  if (truncate(path.c_str(), off_t{1} << 43) == 0)
    CHECK(refusal(path).find("more than half of the free memory") != std::string::npos);
  fs::remove_all(folder);
}

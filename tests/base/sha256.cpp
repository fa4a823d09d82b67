#include "core/base/sha256.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

using namespace langer;

TEST_CASE("checksums are those of FIPS 180-4 and of sha256sum") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(std::string(1'000'000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("a file has the checksum of its bytes, whatever its length is to the blocks") {
  const auto path =
      std::filesystem::temp_directory_path() / ("langer_sha256_" + std::to_string(getpid()));
  for (const std::size_t length : {0u, 1u, 55u, 56u, 63u, 64u, 65u, 1u << 20, (1u << 20) + 1}) {
    std::string bytes(length, '\0');
    for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<char>(i * 7 + i / 256);
    std::ofstream(path, std::ios::binary) << bytes;
    CHECK(sha256_of_file(path.string()) == sha256(bytes));
  }
  std::filesystem::remove(path);
}

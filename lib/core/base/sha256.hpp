// SHA-256 (FIPS 180-4), for those who check files with other tools; our own checksums are shorter
// (hdf5/checksum.hpp).
#pragma once

#include <string>
#include <string_view>

namespace langer {

std::string sha256(std::string_view bytes);  // 64 hex digits
std::string sha256_of_file(
    const std::string& path);  // throws std::runtime_error where it cannot be read

}  // namespace langer

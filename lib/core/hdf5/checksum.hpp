// A 64-bit checksum of bytes: FNV-1a over words of eight, each followed by a shift that brings high
// bits down. Every step is one to one, so a change within one word always shows, and any other goes
// unseen once in 2^64.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>

namespace langer {

inline std::uint64_t checksum(std::string_view bytes, std::uint64_t h = 0xcbf29ce484222325u) {
  const auto take = [&](std::uint64_t word) {
    h = (h ^ word) * 0x100000001b3u;
    h ^= h >> 32;
  };
  take(bytes.size());
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    std::size_t n = 8;
    if (bytes.size() < 8) n = bytes.size();
    std::memcpy(&word, bytes.data(), n);
    take(word);
    bytes.remove_prefix(n);
  }
  return h;
}

}  // namespace langer

// Paths that a browser asks for: what is read lies below the served folder, whatever the path.
#include <filesystem>
#include <fstream>

#include "core/base/error.hpp"
#include "fuzz.hpp"
#include "serve/folder.hpp"

namespace fs = std::filesystem;

namespace {

// <work>/secret lies outside of <work>/served; links lead to it.
const langer::ServedFolder& served() {
  static const langer::ServedFolder folder = [] {
    const fs::path work = fs::path(BINARY_DIR) / "served_files";
    fs::remove_all(work);
    fs::create_directories(work / "served" / "skin");
    fs::create_directories(work / "hidden");
    std::ofstream(work / "secret") << "secret";
    std::ofstream(work / "hidden" / "secret") << "secret";
    std::ofstream(work / "served" / "skin" / "solve.yaml") << "inside";
    std::ofstream(work / "served" / ".hidden") << "secret";
    fs::create_symlink("../secret", work / "served" / "link");
    fs::create_directory_symlink("../../hidden", work / "served" / "skin" / "folder");
    return langer::ServedFolder((work / "served").string());
  }();
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path(reinterpret_cast<const char*>(data), size);
  try {
    if (served().read(path, 1000) != "inside") std::abort();
  } catch (const langer::Failure& failure) {
    if (failure.code() != langer::Exit::input) std::abort();
  }
  try {
    const std::string absolute = fs::path(served().absolute(path)).lexically_normal();
    if (!absolute.starts_with(served().path())) std::abort();
  } catch (const langer::Failure&) {
  }
  return 0;
}

// Text -> a mesh of Abaqus or CalculiX whose indices all lead somewhere. Lines "**FILE name" begin
// further files, which *INCLUDE may name.
#include <filesystem>
#include <map>

#include "fuzz.hpp"
#include "meshing/exchange.hpp"
#include "meshing/inp.hpp"
#include "sound_mesh.hpp"

namespace {

constexpr const char* mark = "**FILE ";

std::map<std::string, std::string> files_of(const std::string& text) {
  std::map<std::string, std::string> files;
  std::string name = "input.inp";
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    if (line.starts_with(mark)) {
      name = line.substr(std::string(mark).size()) + ".input.inp";
    } else {
      files[name] += line + "\n";
    }
    begin = end + 1;
  }
  return files;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  const auto files = files_of(std::string(reinterpret_cast<const char*>(data), size));
  const InpOpener opener = [&](const std::string&, const std::string& named) {
    const std::string path = named + ".input.inp";
    const auto found = files.find(path);
    if (found == files.end()) return InpInclusion{path, "", "there is no such file"};
    return InpInclusion{path, found->second, ""};
  };
  fuzz::reads_or_refuses("input.inp", [&] {
    std::vector<std::string> notes;
    const auto main = files.find("input.inp");
    const std::string text = main == files.end() ? "" : main->second;
    const Mesh mesh = parse_inp(text, "input.inp", notes, opener);
    fuzz::need(mesh.n_cells() > 0);
    fuzz::need_sound(mesh);
  });
  return 0;
}

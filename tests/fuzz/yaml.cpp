// Text -> YAML -> configs: one with a member of every kind, and a material.
#include "config/sample.hpp"
#include "core/config/reader.hpp"
#include "core/config/writer.hpp"
#include "fuzz.hpp"
#include "mechanics/material/material.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto read = [&] {
    return parse_yaml(text, "input.yaml", "/nonexistent");
  };
  fuzz::reads_or_refuses("input.yaml", [&] {
    // what was read and written is read as the same
    const auto config = read_config<sample::Sample>(read()).config;
    const std::string written = to_text(to_tree(config));
    if (to_text(to_tree(
            read_config<sample::Sample>(parse_yaml(written, "input.yaml", "")).config)) != written)
      std::abort();
  });
  fuzz::reads_or_refuses("input.yaml", [&] { read_config<Material>(read()); });
  fuzz::reads_or_refuses("input.yaml", [&] {
    Tree tree = read();
    set_value(tree, "a.b[1].c", tree);
  });
  return 0;
}

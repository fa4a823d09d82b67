// Text -> layers: the config is read, written and read again as the same; then its layers are made.
#include "layers/layers_config.hpp"

#include "core/config/reader.hpp"
#include "core/config/writer.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto read = [](const std::string& yaml) {
    return read_config<LayersConfig>(parse_yaml(yaml, "input.yaml", "/nonexistent"));
  };
  fuzz::reads_or_refuses("input.yaml", [&] {
    const std::string written = to_text(to_tree(read(text).config));
    if (to_text(to_tree(read(written).config)) != written) std::abort();
  });
  fuzz::reads_or_refuses("input.yaml", [&] {
    const auto loaded = read(text);
    layers_at_rest(loaded.config, {}, loaded.where);
  });
  return 0;
}

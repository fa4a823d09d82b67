// Text -> a pipeline -> its steps; configs that it names are a small map, or missing.
#include "fuzz.hpp"
#include "pipeline/plan/expand.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  const std::string text(reinterpret_cast<const char*>(data), size);
  fuzz::reads_or_refuses("", [&] {
    const auto steps = pipeline::expand(
        pipeline::read_pipeline(parse_yaml(text, "input.yaml", "/nonexistent")),
        [](const std::string& path) {
          if (path.size() % 5 == 4)
            throw Failure(Exit::input, Error{{path}, "", "there is no such file", "", ""});
          return parse_yaml("{a: {b: [1, 2]}, c: 3}", path, "");
        });
    for (const pipeline::Step& step : steps)
      if (!step.stage || !pipeline::is_safe_path(step.output())) std::abort();
  });
  return 0;
}

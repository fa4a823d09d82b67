// Edits of the set-up page: first line the path of a key, second its new value (empty: the key is
// removed), the rest a YAML file. An edit is made or refused. The new text is valid YAML, and a
// value that was set is there when the edit is made once more, or this edit is refused.
#include "serve/yaml_edit.hpp"

#include "core/base/error.hpp"
#include "core/config/raw_yaml.hpp"
#include "fuzz.hpp"

namespace {

std::string first_line(std::string& text) {
  const std::size_t end = text.find('\n');
  const std::string line = text.substr(0, end);
  text = end == std::string::npos ? "" : text.substr(end + 1);
  return line;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace langer;
  std::string text(reinterpret_cast<const char*>(data), size);
  const std::string path = first_line(text);
  const std::string value = first_line(text);
  std::optional<std::string> wanted;
  if (!value.empty()) wanted = value;
  try {
    const std::string edited = edit_yaml(text, "input.yaml", path, wanted);
    try {
      parse_yaml_as_written(edited, "input.yaml");
    } catch (const Failure& failure) {
      std::fprintf(stderr, "the edited text is refused: %s\n", failure.what());
      std::abort();
    }
    // A value with an anchor, a tag or several lines is not edited again: that is refused.
    if (!wanted) return 0;
    const std::string again = edit_yaml(edited, "input.yaml", path, wanted);
    if (again != edited) {
      std::fprintf(stderr, "edited once:\n%s\nand twice:\n%s\n", edited.c_str(), again.c_str());
      std::abort();
    }
  } catch (const Failure& failure) {
    if (failure.code() != Exit::config && failure.code() != Exit::input) std::abort();
  }
  return 0;
}

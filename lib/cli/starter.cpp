// `langer new`: writes a starter project from the files of share/new.
#include "cli/starter.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "cli/schemas.hpp"
#include "cli/starter_files.hpp"
#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/member.hpp"
#include "core/hdf5/seal.hpp"

namespace langer {

namespace fs = std::filesystem;

// The scenes in the order of the files. Files of the scene "common" belong to all.
std::vector<std::string> starter_names() {
  std::vector<std::string> names;
  for (const StarterFile& f : starter_files)
    if (std::string(f.scene) != "common" && (names.empty() || names.back() != f.scene))
      names.push_back(f.scene);
  return names;
}

// Files of another person's project are never replaced, so the folder must be new or empty. Configs
// get a line that names their schema.
std::vector<std::string> write_starter(const std::string& scene, const std::string& folder) {
  const std::vector<std::string> known = starter_names();
  if (std::ranges::find(known, scene) == known.end()) {
    const std::string near = nearest(scene, known);
    throw Failure(Exit::config, Error{{},
                                      "",
                                      fmt::format("found the scene \"{}\"", scene),
                                      "one of " + list_words(known),
                                      did_you_mean(near)});
  }
  std::error_code ec;
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder, ec)))
    throw Failure(Exit::input, Error{{folder},
                                     "",
                                     "this is there already",
                                     "a new or an empty folder",
                                     "langer new SCENE FOLDER"});
  fs::create_directories(fs::path(folder) / "schema", ec);
  if (!fs::is_directory(fs::path(folder) / "schema")) {
    std::string found = "this folder cannot be made";
    if (ec) found += ": " + ec.message();
    throw Failure(Exit::input, Error{{folder}, "", found, "", ""});
  }
  std::vector<std::string> written;
  for (const StarterFile& f : starter_files) {
    if (f.scene != scene && std::string(f.scene) != "common") continue;
    const std::string kind = fs::path(f.name).stem();
    const bool yaml = fs::path(f.name).extension() == ".yaml" && has_schema(kind);
    std::string text(f.text);
    if (yaml) text = schema_line(kind, "schema") + text;
    write_text_file((fs::path(folder) / f.name).string(), text);
    if (yaml)
      write_text_file((fs::path(folder) / "schema" / schema_file(kind)).string(),
                      schema_text(kind));
    written.push_back(f.name);
  }
  return written;
}

}  // namespace langer

#include "pipeline/plan/run_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/input_file.hpp"
#include "core/base/lower_case.hpp"
#include "core/base/quoted.hpp"
#include "core/hdf5/replace.hpp"
#include "meshing/inp.hpp"
#include "pipeline/plan/overrides.hpp"
#include "results/store/curves_file.hpp"

namespace langer {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const std::string& path, std::string found, std::string hint = "") {
  throw Failure(Exit::input, Error{{path, 0, 0}, "", std::move(found), "", std::move(hint)});
}

}  // namespace

// The reason is that of the operating system: missing, a folder, or no permission.
void require_file(const std::string& path, const Place& named_at, const std::string& key) {
  const std::string reason = unreadable_reason(path);
  if (reason.empty()) return;
  if (key.empty()) refuse(path, reason);
  throw Failure(Exit::input, Error{named_at, key, path + ": " + reason, "", ""});
}

// A config may have one material for the scene (`material`), or one for each body (`materials`).
void require_one_source(const StageSpec& stage, const Tree& config,
                        const std::vector<std::string>& ports_given) {
  for (const Port& port : stage.inputs) {
    if (!port.or_key) continue;
    const Tree* key = config.find(port.name);
    const bool given = std::ranges::find(ports_given, port.name) != ports_given.end();
    if (key && given)
      throw Failure(Exit::config,
                    Error{key->place, port.name, "given here and as a file", "one of the two", ""});
    // or a mesh and a material for each of several bodies
    const Tree* bodies = config.find("bodies");
    if (bodies && bodies->map.empty()) bodies = nullptr;  // as an effective config writes it
    if (bodies && given && port.name == std::string_view("mesh"))
      throw Failure(Exit::config, Error{bodies->place, "bodies", "given here, and a mesh as a file",
                                        "one of the two", ""});
    const bool one_each = bodies || config.find(std::string(port.name) + "s") != nullptr;
    if (!key && !given && !one_each)
      throw Failure(Exit::config,
                    Error{config.place, port.name, "missing",
                          fmt::format("the key {0}, or a file (--{0})", port.name), ""});
  }
}

// The output is checked before the work, which may take hours: it must not be a folder or an input,
// and only files that Langer made are replaced.
void check_output(const std::string& output, const std::string& config, const InputFiles& inputs) {
  std::error_code ec;
  if (fs::is_directory(output, ec))
    refuse(output, "the output is a folder", "-o names the main output file");
  std::vector<std::string> sources{config};
  for (const auto& [port, files] : inputs)
    sources.insert(sources.end(), files.begin(), files.end());
  for (const std::string& source : sources)
    if (fs::equivalent(source, output, ec)) refuse(output, "the output would replace an input");
  require_own_output(output);
  // Unfinished output, journal and lock of a run are next to its output.
  for (const char* suffix : {".part", ".steps", ".lock"}) require_replaceable(output + suffix);
  fs::path folder = fs::path(output).parent_path();
  if (folder.empty()) folder = ".";
  fs::create_directories(folder, ec);
  if (!fs::is_directory(folder)) {
    std::string reason;
    if (ec) reason = ": " + ec.message();
    refuse(folder.string(), "this folder cannot be made" + reason);
  }
  // A file in the folder is written under another name and then renamed, which needs both rights.
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(folder.string(), "this folder cannot be written to");
}

// Each part of a tree knows its file, so no list of includes is needed.
std::set<std::string> files_of(const Tree& tree) {
  std::set<std::string> files{tree.place.file};
  for (const Tree& part : tree.list) files.merge(files_of(part));
  for (const auto& entry : tree.map) files.merge(files_of(entry.value));
  return files;
}

// The extension is compared in lower case, because other programs write .INP.
std::vector<std::string> files_included_by(const std::string& path) {
  const std::string extension = lower_case(fs::path(path).extension().string());
  std::error_code ec;
  if (extension != ".inp" || !fs::is_regular_file(path, ec)) return {};
  return included_inp_files(path);
}

// The values of YAML count and not its bytes, so comments and the order of keys do not matter.
std::string content_of(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".h5") return read_origin(path).content_id;
  if (extension == ".yaml" || extension == ".yml") return fnv1a(to_text(load_yaml(path)));
  return fnv1a(read_file(path));
}

// All named files are also protected from being replaced by outputs of this run.
Identity identity_of(const std::string& stage, const ConfigText& config, const Where& where,
                     const InputFiles& inputs, const std::string& command) {
  Identity identity{stage, config.full, fnv1a(config.hashed), {}, command};
  for (const auto& [port, files] : inputs)
    for (std::size_t i = 0; i < files.size(); ++i) {
      std::string name = port;
      if (files.size() > 1) name = item(port, i);
      identity.inputs[name] = content_of(files[i]);
    }
  // Files that the config names count by their key, and an .inp also with the files it includes.
  for (const NamedFile& file : config.files) {
    require_file(file.path, where(file.key), file.key);
    identity.inputs[file.key] = content_of(file.path);
    never_replace(file.path);
    const std::vector<std::string> included = files_included_by(file.path);
    for (std::size_t i = 0; i < included.size(); ++i) {
      identity.inputs[fmt::format("{}.include[{}]", file.key, i)] = content_of(included[i]);
      never_replace(included[i]);
    }
  }
  return identity;
}

std::string json_text(const Identity& identity, const std::vector<Summary>& results,
                      const std::vector<TextResult>& texts) {
  std::string s = fmt::format("{{\"stage\": \"{}\", \"config_hash\": \"{}\"", identity.stage,
                              identity.config_hash);
  for (const Summary& r : results) {
    std::string value = "null";
    if (std::isfinite(r.value)) value = number_text(r.value);
    s += fmt::format(", \"{}\": {}", csv_name(r.name, r.unit), value);
  }
  for (const TextResult& r : texts) s += fmt::format(", \"{}\": {}", r.name, quoted(r.text));
  return s + "}\n";
}

void apply_setting(Tree& config, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Failure(Exit::config, Error{{"--set", 0, 0},
                                      "",
                                      "found \"" + setting + "\"",
                                      "key=value, for example --set material.fibres[0].alpha=30",
                                      ""});
  const std::string key = setting.substr(0, equals);
  set_value(config, key, pipeline::typed_value(setting.substr(equals + 1), "--set"));
}

}  // namespace langer

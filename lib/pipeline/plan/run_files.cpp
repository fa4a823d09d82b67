#include "pipeline/plan/run_files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/input_file.hpp"
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

void need_file(const std::string& path, const Place& named_at, const std::string& key) {
  const std::string reason = unreadable_reason(path);
  if (reason.empty()) return;
  if (key.empty()) refuse(path, reason);
  throw Failure(Exit::input, Error{named_at, key, path + ": " + reason, "", ""});
}

void need_one_source(const StageSpec& stage, const Tree& config,
                     const std::vector<std::string>& ports_given) {
  for (const Port& port : stage.inputs) {
    if (!port.or_key) continue;
    const Tree* key = config.find(port.name);
    const bool given =
        std::find(ports_given.begin(), ports_given.end(), port.name) != ports_given.end();
    if (key && given)
      throw Failure(Exit::config,
                    Error{key->place, port.name, "given here and as a file", "one of the two", ""});
    const bool one_each =
        config.find(std::string(port.name) + "s") != nullptr;  // materials: one for each body
    if (!key && !given && !one_each)
      throw Failure(Exit::config,
                    Error{config.place, port.name, "missing",
                          fmt::format("the key {0}, or a file (--{0})", port.name), ""});
  }
}

void need_output(const std::string& output, const std::string& config, const InputFiles& inputs) {
  std::error_code ec;
  if (fs::is_directory(output, ec))
    refuse(output, "the output is a folder", "-o names the main output file");
  std::vector<std::string> sources{config};
  for (const auto& [port, files] : inputs)
    sources.insert(sources.end(), files.begin(), files.end());
  for (const std::string& source : sources)
    if (fs::equivalent(source, output, ec)) refuse(output, "the output would replace an input");
  require_own_output(output);
  for (const char* beside : {".part", ".steps", ".lock"}) require_replaceable(output + beside);
  const fs::path folder =
      fs::path(output).has_parent_path() ? fs::path(output).parent_path() : fs::path(".");
  fs::create_directories(folder, ec);
  if (!fs::is_directory(folder))
    refuse(folder.string(),
           "this folder cannot be made" + (ec ? ": " + ec.message() : std::string()));
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(folder.string(), "this folder cannot be written to");
}

std::set<std::string> files_of(const Tree& tree) {
  std::set<std::string> files{tree.place.file};
  for (const Tree& part : tree.list) files.merge(files_of(part));
  for (const auto& entry : tree.map) files.merge(files_of(entry.value));
  return files;
}

std::vector<std::string> files_included_by(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::error_code ec;
  if (extension != ".inp" || !fs::is_regular_file(path, ec)) return {};
  return included_inp_files(path);
}

std::string content_of(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".h5") return read_origin(path).content_id;
  if (extension == ".yaml" || extension == ".yml") return fnv1a(to_text(load_yaml(path)));
  return fnv1a(read_file(path));
}

Identity identity_of(const std::string& stage, const ConfigText& config, const Where& where,
                     const InputFiles& inputs, const std::string& command) {
  Identity identity{stage, config.full, fnv1a(config.hashed), {}, command};
  for (const auto& [port, files] : inputs)
    for (std::size_t i = 0; i < files.size(); ++i)
      identity.inputs[files.size() == 1 ? port : item(port, i)] = content_of(files[i]);
  for (const NamedFile& file : config.files) {
    need_file(file.path, where(file.key), file.key);
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

std::string json_text(const Identity& identity, const std::vector<Summary>& results) {
  std::string s = fmt::format("{{\"stage\": \"{}\", \"config_hash\": \"{}\"", identity.stage,
                              identity.config_hash);
  for (const Summary& r : results)
    s += fmt::format(", \"{}\": {}", csv_name(r.name, r.unit),
                     std::isfinite(r.value) ? number_text(r.value) : "null");
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

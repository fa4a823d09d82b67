#include "store/provenance.hpp"

#include <unistd.h>

#include <Eigen/Core>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <sstream>

#include <fmt/format.h>

#include "base/version.hpp"

namespace langer {

std::string fnv1a(const std::string& text) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (unsigned char c : text) h = (h ^ c) * 0x100000001b3u;
  return fmt::format("{:016x}", h);
}

namespace {

std::string joined(const std::map<std::string, std::string>& inputs) {
  std::string text;
  for (const auto& [port, id] : inputs) text += (text.empty() ? "" : " ") + port + "=" + id;
  return text;
}

std::map<std::string, std::string> separated(const std::string& text) {
  std::map<std::string, std::string> inputs;
  std::istringstream in(text);
  for (std::string item; in >> item;)
    if (const auto equals = item.find('='); equals != std::string::npos)
      inputs[item.substr(0, equals)] = item.substr(equals + 1);
  return inputs;
}

}  // namespace

std::string utc_now() {
  std::time_t now = std::time(nullptr);
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) now = static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10));
  char text[32] = "";
  std::tm parts{};
  if (gmtime_r(&now, &parts)) std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();  // nearly that of the program

std::string host_name() {
  char name[256] = "";
  return gethostname(name, sizeof name - 1) == 0 ? name : "";
}

std::string content_id(const Identity& identity, int schema_version) {
  return fnv1a(fmt::format("{}\n{}\n{}\n{}", identity.stage, schema_version, identity.config_hash, joined(identity.inputs)));
}

void write_identity(const h5::Group& root, const Schema& schema, const Identity& identity) {
  root.attribute("schema", std::string(schema.name));
  root.attribute("schema_version", std::int64_t{schema.version});
  root.attribute("units", std::string("mm N MPa s deg"));
  root.attribute("stage", identity.stage);
  root.attribute("config_hash", identity.config_hash);
  root.attribute("inputs", joined(identity.inputs));
  const h5::Group provenance = root.make_group("provenance");
  provenance.write_text("config", identity.config);
  provenance.write_text("code_version", fmt::format("{} ({})", version, revision));
  provenance.write_text("libraries", fmt::format("{}; Eigen {}.{}.{}; compiler {}", h5::library(), EIGEN_WORLD_VERSION,
                                                 EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, __VERSION__));
  provenance.write_text("created_utc", utc_now());
  provenance.write_text("host", host_name());
  provenance.write_text("command", identity.command);
  write_times(root);
  if (identity.cost) write_cost(root, *identity.cost);
}

void write_times(const h5::Group& root) {
  if (std::getenv("SOURCE_DATE_EPOCH")) return;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const h5::Group provenance = root.group("provenance");
  provenance.attribute("wall_seconds", fmt::format("{:.3f}", wall.count()));
  provenance.attribute("cpu_seconds", fmt::format("{:.3f}", static_cast<double>(std::clock()) / CLOCKS_PER_SEC));
}

void write_cost(const h5::Group& root, const Cost& cost) {
  if (std::getenv("SOURCE_DATE_EPOCH")) return;
  const h5::Group group = root.group("provenance").make_group("cost");
  group.write_scalar("cpu", cost.cpu, "s");
  group.write_scalar("wall", cost.wall, "s");
  group.write_scalar("memory", cost.memory, "MB");
}

namespace {
Origin origin(const h5::Group& root) {
  if (!root.has_attribute("schema") || !root.has_attribute("schema_version"))
    root.refuse("", "no schema attribute: not a file of langer");
  Origin origin;
  origin.schema = root.text_attribute("schema");
  origin.version = static_cast<int>(root.integer_attribute("schema_version"));
  Identity& identity = origin.identity;
  identity.stage = root.text_attribute("stage");
  identity.config_hash = root.text_attribute("config_hash");
  identity.inputs = separated(root.text_attribute("inputs"));
  if (root.has("provenance")) {
    const h5::Group provenance = root.group("provenance");
    if (provenance.has("config")) identity.config = provenance.read_text("config");
    if (provenance.has("command")) identity.command = provenance.read_text("command");
    if (provenance.has("cost")) {
      const h5::Group cost = provenance.group("cost");
      identity.cost = Cost{cost.read_scalar("cpu"), cost.read_scalar("wall"), cost.read_scalar("memory")};
    }
  }
  origin.content_id = content_id(identity, origin.version);
  return origin;
}
}  // namespace

Identity read_identity(const h5::Group& root, const Schema& schema) {
  const Origin found = origin(root);
  if (found.schema != schema.name || found.version != schema.version)
    root.refuse("", fmt::format("schema {}/{}", found.schema, found.version), fmt::format("{}/{}", schema.name, schema.version),
                found.schema == schema.name ? "written by another version of langer: make it again" : "");
  return found.identity;
}

Origin read_origin(const std::string& path) { return origin(h5::File::open(path).root()); }

void write_summary(const h5::Group& root, const std::vector<Summary>& summary) {
  const h5::Group group = root.make_group("summary");
  for (const Summary& s : summary) group.write_scalar(s.name, s.value, s.unit);
}

std::vector<Summary> read_summary(const h5::Group& root) {
  std::vector<Summary> summary;
  if (!root.has("summary")) return summary;
  const h5::Group group = root.group("summary");
  for (const std::string& name : group.datasets()) summary.push_back({name, group.read_scalar(name), group.unit(name)});
  return summary;
}

std::vector<Summary> read_summary(const std::string& path) {
  const h5::File file = h5::File::open(path);
  origin(file.root());
  return read_summary(file.root());
}

}  // namespace langer

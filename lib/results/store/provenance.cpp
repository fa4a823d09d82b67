#include "results/store/provenance.hpp"

#include <unistd.h>

#include <Eigen/Core>
#include <cstdlib>
#include <ctime>
#include <sstream>

#include <fmt/format.h>

#include "core/base/memory.hpp"
#include "core/base/stopwatch.hpp"
#include "core/base/text.hpp"
#include "core/base/version.hpp"
#include "core/hdf5/unit_attribute.hpp"

namespace langer {

// Fowler, Noll and Vo's hash: not cryptographic, but short and the same on all machines.
std::string fnv1a(const std::string& text) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (unsigned char c : text) h = (h ^ c) * 0x100000001b3u;
  return fmt::format("{:016x}", h);
}

namespace {

// "port=id port=id ...", as the attribute `inputs` has it.
std::string joined(const std::map<std::string, std::string>& inputs) {
  std::string text;
  for (const auto& [port, id] : inputs) append(text, " ", port + "=" + id);
  return text;
}

// The inverse of joined().
std::map<std::string, std::string> separated(const std::string& text) {
  std::map<std::string, std::string> inputs;
  std::istringstream in(text);
  for (std::string item; in >> item;)
    if (const auto equals = item.find('='); equals != std::string::npos)
      inputs[item.substr(0, equals)] = item.substr(equals + 1);
  return inputs;
}

void write(const h5::Group& group, const Cost& cost) {
  group.write_scalar("cpu", cost.cpu, "s");
  group.write_scalar("wall", cost.wall, "s");
  group.write_scalar("memory", cost.memory, "MB");
}

// Nothing in files without this group.
std::optional<Cost> read_cost(const h5::Group& provenance, const char* name) {
  if (!provenance.has(name)) return {};
  const h5::Group cost = provenance.group(name);
  const auto number = [&](const char* part) {
    return cost.read_finite(part, {}).at(0);
  };
  return Cost{number("cpu"), number("wall"), number("memory")};
}

}  // namespace

std::string code_version() { return fmt::format("{} ({})", version, revision); }

std::string utc_now() {
  std::time_t now = std::time(nullptr);
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH"))
    now = static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10));
  char text[32] = "";
  std::tm parts{};
  if (gmtime_r(&now, &parts)) std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string host_name() {
  char name[256] = "";
  if (gethostname(name, sizeof name - 1) == 0) return name;
  return "";
}

// Two outputs have the same id if stage, schema, config and inputs are the same.
std::string content_id(const Identity& identity, int schema_version) {
  return fnv1a(fmt::format("{}\n{}\n{}\n{}", identity.stage, schema_version, identity.config_hash,
                           joined(identity.inputs)));
}

void write_identity(const h5::Group& root, const Schema& schema, const Identity& identity) {
  root.attribute("schema", std::string(schema.name));
  root.attribute("schema_version", std::int64_t{schema.version});
  root.attribute("units", std::string(house_units));
  root.attribute("stage", identity.stage);
  root.attribute("config_hash", identity.config_hash);
  root.attribute("inputs", joined(identity.inputs));
  // What a person wants to know about the origin, but no content id depends on.
  const h5::Group provenance = root.make_group("provenance");
  provenance.write_text("config", identity.config);
  provenance.write_text("code_version", code_version());
  provenance.write_text("libraries", fmt::format("{}; Eigen {}.{}.{}; compiler {}", h5::library(),
                                                 EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                                                 EIGEN_MINOR_VERSION, __VERSION__));
  provenance.write_text("created_utc", utc_now());
  provenance.write_text("host", host_name());
  provenance.write_text("command", identity.command);
  if (std::getenv("SOURCE_DATE_EPOCH")) return;
  write(provenance.make_group("cost"), cost_so_far());
  if (identity.solution_cost)
    write(provenance.make_group("solution_cost"), *identity.solution_cost);
}

Cost cost_so_far() { return {cpu_seconds(), wall_seconds(), 1e-6 * peak_bytes()}; }

void write_cost(const h5::Group& root, const Cost& cost, bool continued) {
  if (std::getenv("SOURCE_DATE_EPOCH")) return;
  const h5::Group group = root.group("provenance").make_group("cost");
  write(group, cost);
  if (continued) group.attribute("continued", std::int64_t{1});
}

namespace {

// Reads the origin of a file. Files in other units are refused: no reader converts them.
Origin origin(const h5::Group& root) {
  if (!root.has_attribute("schema") || !root.has_attribute("schema_version"))
    root.refuse("", "no schema attribute: not a file of langer");
  if (root.has_attribute("units") && root.text_attribute("units") != house_units)
    root.refuse("", "units " + root.text_attribute("units"), house_units, "convert the values");
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
    origin.cost = read_cost(provenance, "cost");
    if (origin.schema != solution_schema.name) {
      identity.solution_cost = read_cost(provenance, "solution_cost");
    } else if (origin.cost && !provenance.group("cost").has_attribute("continued")) {
      identity.solution_cost = origin.cost;
    }
  }
  origin.content_id = content_id(identity, origin.version);
  return origin;
}
}  // namespace

// The message names the schema that was found and the one that is needed.
Identity read_identity(const h5::Group& root, const Schema& schema) {
  const Origin found = origin(root);
  const bool same_schema = found.schema == schema.name;
  if (same_schema && found.version >= schema.version && found.version <= schema.newest)
    return found.identity;
  std::string hint;
  if (same_schema) hint = "written by another version of langer: make it again";
  root.refuse("", fmt::format("schema {}/{}", found.schema, found.version),
              fmt::format("{}/{}", schema.name, schema.version), hint);
}

int schema_version(const h5::Group& root) {
  return static_cast<int>(root.integer_attribute("schema_version"));
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
  for (const std::string& name : group.datasets()) {
    require_known_unit(group, name);
    summary.push_back({name, group.read_scalar(name), group.unit(name)});
  }
  return summary;
}

std::vector<Summary> read_summary(const std::string& path) {
  const h5::File file = h5::File::open(path);
  origin(file.root());
  return read_summary(file.root());
}

}  // namespace langer

#include "pipeline/plan/pipeline_schema.hpp"

#include <fmt/format.h>

#include "core/config/json_schema.hpp"
#include "pipeline/plan/ports.hpp"
#include "pipeline/sweep/design.hpp"

namespace langer::pipeline {

namespace {

using namespace schema;

// Names of nodes and axes: `include` is not a name but reads another file.
constexpr const char* name_pattern = "^(?!include$)[A-Za-z0-9_+-]+$";

// A map from names to items of one kind.

Tree named(Tree one) {
  Tree t = object(
      {{"type", word("object")}, {"patternProperties", object({{name_pattern, std::move(one)}})}});
  refuse_others(t);
  return t;
}
Tree described_by(const std::string& says, Tree t) {
  t.map.insert(t.map.begin(), {"description", word(says)});
  return t;
}
// A map with these keys only.
Tree keys_of_map(std::vector<Tree::Entry> properties, const std::vector<std::string>& needed) {
  properties.push_back({"include", included()});
  Tree t = object({{"type", word("object")}, {"properties", object(std::move(properties))}});
  if (!needed.empty()) t.map.push_back({"required", words(needed)});
  refuse_others(t);
  return t;
}
// A value of an axis: a text, a number or a truth value.
Tree texts() { return types({"string", "number", "boolean"}); }
Tree one_or_several(Tree one) {
  Tree many = object({{"type", word("array")}, {"items", one}});
  return object({{"anyOf", list({std::move(one), std::move(many)})}});
}

// A map from any key to a value of one kind.
Tree map_of(Tree value) {
  return object({{"type", word("object")}, {"additionalProperties", std::move(value)}});
}

Tree array_of_texts() { return object({{"type", word("array")}, {"items", texts()}}); }

// The five kinds of axes. Each is a map with its own required key, so exactly one of them fits, and
// an editor knows which.
Tree variants_axis() {
  return keys_of_map({{"variants", described_by("settings, or the path of a config, by name",
                                                map_of(types({"object", "string", "null"})))}},
                     {"variants"});
}

Tree grid_axis() {
  return keys_of_map({{"grid", described_by("all combinations of values, by the path of their key",
                                            map_of(array_of_texts()))}},
                     {"grid"});
}

Tree design_axis(Definitions& definitions) {
  const Member design{"design", unit::none, "a design of experiments", false, {}, {}, ""};
  return keys_of_map(
      {{"design", described(value_schema<Design>(design, true, definitions), design)}}, {"design"});
}

Tree samples_axis() {
  return keys_of_map(
      {{"samples", described_by("number of samples of the fitted parameters; each has the key "
                                "number of the stage sample",
                                type("integer"))}},
      {"samples"});
}

Tree values_axis() {
  Tree values = array_of_texts();
  values.map.push_back({"minItems", plain_tree("1")});
  return keys_of_map(
      {{"key", described_by("path of the key that varies, such as fibre_angles[0]",
                            one_or_several(type("string")))},
       {"keys", described_by("several keys with the same value", one_or_several(type("string")))},
       {"values", described_by("its values", std::move(values))},
       {"unit", described_by("of the values, for tables", type("string"))}},
      {"values"});
}

Tree axis(Definitions& definitions) {
  return object({{"anyOf", list({variants_axis(), grid_axis(), design_axis(definitions),
                                 samples_axis(), values_axis()})}});
}

// A node of one stage, with the ports of that stage.
Tree node(const StageSpec& stage) {
  std::vector<Tree::Entry> properties{
      {"stage", object({{"const", word(stage.name)}})},
      {"config", described_by("a YAML file, the config itself, or absent: all defaults",
                              types({"string", "object"}))},
      {"set", described_by("values that replace those of the config, by the path of their key",
                           type("object"))},
      {"sweep", described_by("axes by name", named(reference("axis")))}};
  std::vector<std::string> needed{"stage"};
  bool gathers = false;
  for (const Port& port : stage.inputs) {
    const Tree member = object({{"type", word("object")}, {"required", words({"node"})}});
    Tree source = object({{"anyOf", list({type("string"), member})}});
    if (port.several) source = one_or_several(source);
    properties.push_back({port.name, described_by(fmt::format("a node or a file: {}", port.says),
                                                  std::move(source))});
    if (port.required) needed.push_back(port.name);
    gathers = gathers || port.several;
  }
  if (gathers)
    properties.push_back(
        {"over", described_by("axes that are gathered", one_or_several(type("string")))});
  return keys_of_map(std::move(properties), needed);
}

}  // namespace

// Nodes of different stages have different ports, so a node is checked by the schema of its own
// stage.
std::string pipeline_schema() {
  Definitions definitions;
  Tree axis_schema = axis(definitions);
  definitions["axis"] = std::move(axis_schema);
  Tree choices = list({});
  std::vector<std::string> names;
  for (const StageSpec& stage : stages()) {
    definitions[std::string("stage_") + stage.name] = node(stage);
    names.push_back(stage.name);
    // With if and then an editor shows the errors of the node's own stage. With anyOf it would show
    // those of all stages.
    choices.list.push_back(object(
        {{"if",
          object({{"properties", object({{"stage", object({{"const", word(stage.name)}})}})}})},
         {"then", reference(std::string("stage_") + stage.name)}}));
  }
  definitions["node"] =
      object({{"type", word("object")},
              {"properties", object({{"stage", object({{"description", word("which program runs")},
                                                       {"enum", words(names)}})}})},
              {"required", words({"stage"})},
              {"allOf", std::move(choices)}});
  Tree root = keys_of_map(
      {{"pipeline",
        described_by("its name: results are in runs/<name>",
                     object({{"type", word("string")}, {"pattern", word(name_pattern)}}))},
       {"nodes", described_by("its steps by name", named(reference("node")))}},
      {"pipeline", "nodes"});
  return document("Langer: pipeline", std::move(root), definitions);
}

}  // namespace langer::pipeline

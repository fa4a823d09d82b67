#include "core/config/json_schema.hpp"
#include "core/base/text.hpp"

#include <fmt/format.h>

#include "core/base/quoted.hpp"

namespace langer {

namespace {

// in one line where that is short
std::string flat(const Tree& t) {
  std::string s;
  switch (t.kind) {
    case Tree::Kind::null:
      return "null";
    case Tree::Kind::scalar:
      if (t.quoted) return quoted(t.scalar);
      return t.scalar;
    case Tree::Kind::list:
      for (const Tree& item : t.list) append(s, ", ", flat(item));
      return "[" + s + "]";
    case Tree::Kind::map:
      for (const auto& [key, value] : t.map) append(s, ", ", quoted(key) + ": " + flat(value));
      return "{" + s + "}";
  }
  return s;
}

}  // namespace

// JSON text with two spaces for each level. What fits in one line is written in one, which keeps
// lists of numbers readable.
std::string json_of(const Tree& t, int indent) {
  constexpr std::size_t widest = 100;
  const std::string one = flat(t);
  if (one.size() + static_cast<std::size_t>(indent) <= widest ||
      (t.kind != Tree::Kind::map && t.kind != Tree::Kind::list))
    return one;
  const std::string margin(static_cast<std::size_t>(indent) + 2, ' ');
  std::string s;
  for (const Tree& item : t.list) append(s, ",\n", margin + json_of(item, indent + 2));
  for (const auto& [key, value] : t.map)
    append(s, ",\n", margin + quoted(key) + ": " + json_of(value, indent + 2));
  const std::string end(static_cast<std::size_t>(indent), ' ');
  if (t.kind == Tree::Kind::map) return "{\n" + s + "\n" + end + "}";
  return "[\n" + s + "\n" + end + "]";
}

namespace schema {

// The value of "include": one name of a file, or a list of them.
Tree included() {
  return object(
      {{"description",
        word(
            "a file, or a list of files, whose keys are inserted here; keys next to it override them")},
       {"anyOf",
        list({type("string"), object({{"type", word("array")}, {"items", type("string")}})})}});
}

// The range of a number becomes minimum and maximum; an open end has no key.
Tree number(const Member& m, bool whole) {
  Tree t = type(whole ? "integer" : "number");
  const Range& r = m.range;
  if (std::isfinite(r.low))
    t.map.push_back(
        {r.low_included ? "minimum" : "exclusiveMinimum", plain_tree(number_text(r.low))});
  if (std::isfinite(r.high))
    t.map.push_back(
        {r.high_included ? "maximum" : "exclusiveMaximum", plain_tree(number_text(r.high))});
  return t;
}

// The text of an editor's tooltip: the documentation of the key, with its unit in brackets.
Tree described(Tree schema, const Member& m) {
  std::string says = m.doc;
  if (std::string(m.unit) != unit::none) says += fmt::format(" [{}]", m.unit);
  schema.map.insert(schema.map.begin(), {"description", word(says)});
  return schema;
}

// A text with a list of words accepts these alone. Free text may also be written without quotation
// marks as a number or as true or false, which an editor would otherwise mark as wrong.
Tree text_schema(const Member& m) {
  if (m.words.empty()) return types({"string", "number", "boolean"});
  return object({{"enum", words(m.words)}});
}

// An unknown key is most often misspelt, so an editor marks it as the reader refuses it.
void refuse_others(Tree& object) {
  object.map.push_back({"additionalProperties", plain_tree("false")});
}

// A part that includes a file may leave out required keys, as the file has them: such an object is
// checked against the part without its required keys, any other against the whole.
Tree or_included(Tree whole, const std::string& part) {
  return object({{"if", object({{"type", word("object")}, {"required", words({"include"})}})},
                 {"then", reference(part)},
                 {"else", std::move(whole)}});
}

// The whole schema: the rules of the root, and the shared parts under "definitions".
std::string document(const std::string& title, Tree root, const Definitions& definitions) {
  Tree all = object();
  for (const auto& [name, tree] : definitions) all.map.push_back({name, tree});
  Tree t = object(
      {{"$schema", word("http://json-schema.org/draft-07/schema#")}, {"title", word(title)}});
  for (Tree::Entry& entry : root.map) t.map.push_back(std::move(entry));
  // draft 7 ignores all other keys next to $ref
  if (const Tree* ref = t.find("$ref")) {
    Tree first = object({{"$ref", *ref}});
    std::erase_if(t.map, [](const Tree::Entry& e) { return e.key == "$ref"; });
    t.map.push_back({"allOf", list({first})});
  }
  t.map.push_back({"definitions", std::move(all)});
  return json_of(t) + "\n";
}

}  // namespace schema

}  // namespace langer

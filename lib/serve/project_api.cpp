#include "serve/project_api.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "cli/check.hpp"
#include "cli/schemas.hpp"
#include "cli/starter.hpp"
#include "core/base/error.hpp"
#include "core/base/text.hpp"
#include "core/config/raw_yaml.hpp"
#include "core/config/reader.hpp"
#include "report/json.hpp"
#include "serve/child.hpp"
#include "serve/page_files.hpp"
#include "serve/yaml_edit.hpp"

namespace langer {

namespace fs = std::filesystem;
using http::Reply;
using http::Request;
using report::Json;
using report::list;
using report::number;
using report::object;
using report::words;

namespace {

// Bounds of what one request may take.
constexpr std::size_t largest_order = 1 << 20;  // bytes of JSON
constexpr std::size_t largest_yaml = 1 << 20;
constexpr std::size_t largest_shown = 64 << 20;   // of a result that is sent to the browser
constexpr std::size_t largest_scene = 128 << 20;  // of what langer serve --scene prints
constexpr double longest_check = 60;              // [s]
constexpr double longest_scene = 300;

// For lists whose items are JSON already.
Json as_json(const Json& j) { return j; }

// Ends the request with a message for the page.
[[noreturn]] void refuse_request(const std::string& what, const std::string& found) {
  throw Failure(Exit::input, Error{{what}, "", found, "", ""});
}

Reply json(std::string text) { return {200, "application/json", std::move(text), {}}; }

// Status 400 for what was asked wrongly, 403 for paths that are refused.
Reply problem(int status, const std::string& message) {
  return {status, "application/json", object({{"problem", words(message)}}).text, {}};
}

// A part of the address behind "?"; empty if it is not there.
std::string asked(const Request& request, const std::string& key) {
  const auto found = request.query.find(key);
  if (found == request.query.end()) return "";
  return found->second;
}

// JSON is YAML, so an order is read by the reader of YAML.
Tree order_of(const Request& request) {
  if (request.body.size() > largest_order) refuse_request("the request", "is too large");
  Tree tree = parse_yaml_as_written(request.body, "the request");
  if (tree.kind != Tree::Kind::map) refuse_request("the request", "is no JSON object");
  return tree;
}

// A text of an order that must be there, and one that may be missing.
std::string text_of(const Tree& order, const std::string& key) {
  const Tree* value = order.find(key);
  if (!value || value->kind != Tree::Kind::scalar)
    refuse_request("the request", "has no text \"" + key + "\"");
  return value->scalar;
}
std::string text_or_empty(const Tree& order, const std::string& key) {
  const Tree* value = order.find(key);
  if (!value || value->kind != Tree::Kind::scalar) return "";
  return value->scalar;
}

// The folder of a project, "" or one name.
std::string checked_project(const std::string& project) {
  if (project.find('/') != std::string::npos)
    refuse_request(project, "is no project of this folder");
  if (const std::string why = refused_path(project); !why.empty()) refuse_request(project, why);
  return project;
}

bool is_yaml(const std::string& name) { return fs::path(name).extension() == ".yaml"; }

// A YAML file as the form reads it: every part with its place, by which messages find their field.
Json tree_json(const Tree& tree) {
  std::vector<std::pair<const char*, Json>> parts;
  switch (tree.kind) {
    case Tree::Kind::null:
      parts.emplace_back("kind", words("null"));
      break;
    case Tree::Kind::scalar:
      parts.emplace_back("kind", words("scalar"));
      parts.emplace_back("text", words(tree.scalar));
      parts.emplace_back("quoted", Json{tree.quoted ? "true" : "false"});
      break;
    case Tree::Kind::list:
      parts.emplace_back("kind", words("list"));
      parts.emplace_back("items", list(tree.list, tree_json));
      break;
    case Tree::Kind::map: {
      const auto entry = [](const Tree::Entry& e) {
        return object({{"key", words(e.key)}, {"value", tree_json(e.value)}});
      };
      parts.emplace_back("kind", words("map"));
      parts.emplace_back("entries", list(tree.map, entry));
      break;
    }
  }
  parts.emplace_back("line", number(tree.place.line));
  parts.emplace_back("column", number(tree.place.column));
  return object(parts);
}

// What a browser may show. Everything else is offered as a download.
const std::vector<std::pair<std::string, std::string>>& media_types() {
  static const std::vector<std::pair<std::string, std::string>> types = {
      {".html", "text/html; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".csv", "text/plain; charset=utf-8"},
      {".yaml", "text/plain; charset=utf-8"},
      {".log", "text/plain; charset=utf-8"},
      {".json", "application/json"}};
  return types;
}

}  // namespace

ProjectApi::ProjectApi(const ServedFolder& folder, const std::string& bin,
                       std::function<bool()> ends)
    : folder_(folder), bin_(bin), ends_(std::move(ends)), run_(folder, bin) {}

// A message instead of an exception. What a person can mend has the status 400.
Reply ProjectApi::reply(const Request& request, const std::string& path) {
  try {
    return answer(request, path);
  } catch (const Failure& failure) {
    return problem(400, failure.what());
  } catch (const std::exception& failure) {
    return problem(500, failure.what());
  }
}

// Pages and questions are asked by GET, which changes nothing. What writes or runs is a POST.
Reply ProjectApi::answer(const Request& request, const std::string& path) {
  const bool post = request.method == "POST";
  const auto is = [&](const char* name, bool by_post) {
    return path == name && post == by_post;
  };
  if (!post) {
    for (const PageFile& file : page_files())
      if (path == file.name) return {200, file.type, std::string(file.text), {}};
    if (path.starts_with("files/")) return served_file(path.substr(6));
  }
  const std::string project = checked_project(asked(request, "project"));
  if (is("api/state", false)) return json(state(project));
  if (is("api/schema", false)) return json(schema_text(asked(request, "kind")));
  if (is("api/file", false)) return json(file(project, asked(request, "file")));
  if (is("api/check", false)) return json(check(project));
  if (is("api/scene", false)) return json(scene(project));
  if (is("api/progress", false)) return json(run_.progress(project));
  if (is("api/upload", true)) {
    upload(request);
    return json("{}");
  }
  if (!post || !path.starts_with("api/")) return problem(404, "there is no such page");
  const Tree order = order_of(request);
  if (path == "api/edit")
    edit(order);
  else if (path == "api/write")
    write(order);
  else if (path == "api/new")
    make_new(order);
  else if (path == "api/run")
    run_.start(checked_project(text_or_empty(order, "project")));
  else if (path == "api/stop")
    run_.stop();
  else
    return problem(404, "there is no such page");
  return json("{}");
}

// The projects below the folder, and of one project its files, nodes and results.
std::string ProjectApi::state(const std::string& project) const {
  std::vector<Json> projects;
  if (folder_.has_file("pipeline.yaml")) projects.push_back(words(""));
  for (const std::string& name : folder_.folders(""))
    if (folder_.has_file(name + "/pipeline.yaml")) projects.push_back(words(name));
  std::vector<Json> files, nodes, data;
  std::string wrong;
  const bool here = folder_.has_file(below(project, "pipeline.yaml"));
  if (here) {
    for (const std::string& name : folder_.files(project)) {
      if (is_yaml(name))
        files.push_back(words(name));
      else
        data.push_back(words(name));
    }
    try {
      const std::string text = folder_.read(below(project, "pipeline.yaml"), largest_yaml);
      const Tree tree = parse_yaml_as_written(text, "pipeline.yaml");
      const Tree* known = tree.find("nodes");
      if (known)
        for (const Tree::Entry& node : known->map) {
          const Tree* stage = node.value.find("stage");
          const Tree* config = node.value.find("config");
          const Tree* material = node.value.find("material");
          const auto scalar = [](const Tree* t) {
            if (t && t->kind == Tree::Kind::scalar) return words(t->scalar);
            return Json{};
          };
          nodes.push_back(object({{"name", words(node.key)},
                                  {"stage", scalar(stage)},
                                  {"config", scalar(config)},
                                  {"material", scalar(material)}}));
        }
    } catch (const Failure& failure) {
      wrong = failure.what();
    }
  }
  return object({{"folder", words(folder_.path())},
                 {"projects", list(projects, as_json)},
                 {"starters", list(starter_names(), words)},
                 {"here", Json{here ? "true" : "false"}},
                 {"files", list(files, as_json)},
                 {"data", list(data, as_json)},
                 {"nodes", list(nodes, as_json)},
                 {"problem", words(wrong)},
                 {"report",
                  Json{folder_.has_file(below(project, "run/report/report.html")) ? "true"
                                                                                  : "false"}}})
      .text;
}

// The kind of a file that is wrong follows from its schema line all the same.
std::string ProjectApi::file(const std::string& project, const std::string& name) const {
  const std::string path = below(project, name);
  if (!is_yaml(name)) refuse_request(name, "is no YAML file");
  const std::string text = folder_.read(path, largest_yaml);
  Json tree;
  std::string kind, wrong;
  try {
    tree = tree_json(parse_yaml_as_written(text, name));
    kind = kind_of(folder_.absolute(path));
  } catch (const Failure& failure) {
    wrong = failure.what();
  }
  return object({{"text", words(text)},
                 {"kind", words(kind)},
                 {"tree", tree},
                 {"problem", words(wrong)}})
      .text;
}

// The text is read again for each edit: it may have been changed in an editor meanwhile.
void ProjectApi::edit(const Tree& order) {
  const std::string name = text_of(order, "file");
  const std::string path = below(checked_project(text_or_empty(order, "project")), name);
  if (!is_yaml(name)) refuse_request(name, "is no YAML file");
  std::optional<std::string> value;
  if (const Tree* given = order.find("value"); given && given->kind == Tree::Kind::scalar)
    value = given->scalar;
  const std::lock_guard lock(writes_);
  const std::string text = folder_.read(path, largest_yaml);
  const std::string changed = edit_yaml(text, name, text_of(order, "path"), value);
  if (changed != text) folder_.replace(path, changed);
}

// A text that is no YAML is refused, so that the page can always show what it has written.
void ProjectApi::write(const Tree& order) {
  const std::string name = text_of(order, "file");
  const std::string path = below(checked_project(text_or_empty(order, "project")), name);
  const std::string text = text_of(order, "text");
  if (!is_yaml(name)) refuse_request(name, "is no YAML file");
  if (text.size() > largest_yaml) refuse_request(name, "would be too large");
  parse_yaml_as_written(text, name);
  const std::lock_guard lock(writes_);
  folder_.replace(path, text);
}

// The folder must be new or empty; write_starter() refuses any other.
void ProjectApi::make_new(const Tree& order) {
  const std::string starter = text_of(order, "starter");
  const std::string name = text_of(order, "name");
  if (!is_name(name)) refuse_request(name, "a name has letters, digits, _, + and - only");
  const std::string folder = folder_.absolute(checked_project(name));
  const std::lock_guard lock(writes_);
  write_starter(starter, folder);
}

// Data only: no Makefile, no program, nothing that replaces a file.
void ProjectApi::upload(const Request& request) {
  const std::string project = checked_project(asked(request, "project"));
  const std::string name = asked(request, "name");
  const std::string stem = fs::path(name).stem();
  const std::string ending = fs::path(name).extension();
  const std::vector<std::string> known = {".csv", ".txt", ".tsv", ".stl",  ".step",
                                          ".stp", ".inp", ".msh", ".yaml", ".h5"};
  if (name.find('/') != std::string::npos || stem.find('.') != std::string::npos || !is_name(stem))
    refuse_request(name, "a file name has letters, digits, _, + and - only");
  if (std::ranges::find(known, ending) == known.end())
    refuse_request(name,
                   "found the ending \"" + ending + "\"; expected one of " + list_words(known));
  const std::lock_guard lock(writes_);
  folder_.create(below(project, name), request.body);
}

// Messages in the words of the program, one for each error.
std::string ProjectApi::check(const std::string& project) const {
  folder_.read(below(project, "pipeline.yaml"), largest_yaml);
  const ChildResult result =
      run_child({{bin_ + "/langer", "check", "pipeline.yaml"}, folder_.absolute(project)},
                longest_check, 1 << 20, ends_);
  std::string said = result.out + result.err;
  if (result.stopped) said += "the check took too long\n";
  return object({{"right", Json{result.code == 0 ? "true" : "false"}}, {"said", words(said)}}).text;
}

// In a process of its own: a body may take all the memory, and a file may be hostile.
std::string ProjectApi::scene(const std::string& project) const {
  folder_.read(below(project, "pipeline.yaml"), largest_yaml);
  const ChildResult result =
      run_child({{bin_ + "/langer", "serve", ".", "--scene"}, folder_.absolute(project)},
                longest_scene, largest_scene, ends_);
  const bool drawn = result.code == 0 && !result.stopped;
  std::string said = result.err;
  if (result.stopped) said += "this scene took too long\n";
  return object({{"scene", drawn ? Json{result.out} : Json{}}, {"said", words(said)}}).text;
}

// Results are shown in an origin of their own, without the network: a report may have come by mail.
Reply ProjectApi::served_file(const std::string& path) const {
  Reply reply;
  reply.body = folder_.read(path, largest_shown);
  reply.type = "application/octet-stream";
  for (const auto& [ending, type] : media_types())
    if (fs::path(path).extension() == ending) reply.type = type;
  reply.header["Content-Security-Policy"] =
      "sandbox allow-scripts allow-downloads; default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'; img-src data: blob:; font-src data:";
  return reply;
}

}  // namespace langer

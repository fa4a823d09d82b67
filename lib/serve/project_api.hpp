// What the set-up page asks its server: a small API over the files of a folder.
//
// A project is a folder with a pipeline.yaml: the served folder itself, or one directly below it.
// Everything is kept in its files; the server remembers nothing but the run that is going on.
//
//   GET   api/state     ?project                 projects, starters, files, nodes
//   POST  api/new       {starter, name}          the same as `langer new`
//   GET   api/schema    ?kind                    the same as `langer schema`
//   GET   api/file      ?project&file            text, kind, and the tree of a YAML file
//   POST  api/edit      {project, file, path, value}   value null: remove; text: YAML in one line
//   POST  api/write     {project, file, text}    a YAML file as a whole
//   POST  api/upload    ?project&name            a new file of data
//   GET   api/check     ?project                 the same as `langer check`
//   GET   api/scene     ?project                 body, sets, indenters, fibres, forecast
//   POST  api/run       {project};   POST api/stop;   GET api/progress ?project
//   GET   files/<path>                           a file of the folder
#pragma once

#include <functional>
#include <mutex>
#include <string>

#include "core/config/tree.hpp"
#include "serve/folder.hpp"
#include "serve/http/http_interface.hpp"
#include "serve/run_watcher.hpp"

namespace langer {

// Answers the requests of the page. Requests come from several threads: those that write wait for
// each other, and the run has a lock of its own. Programs run in processes of their own, so that a
// body that is too large, or a file that crashes a library, ends only the answer.
class ProjectApi {
 public:
  ProjectApi(const ServedFolder& folder, const std::string& bin, std::function<bool()> ends);
  // `path`: behind the token, such as "api/state". Never throws.
  http::Reply reply(const http::Request& request, const std::string& path);

 private:
  http::Reply answer(const http::Request& request, const std::string& path);
  std::string state(const std::string& project) const;
  std::string file(const std::string& project, const std::string& name) const;
  void edit(const Tree& order);
  void write(const Tree& order);
  void make_new(const Tree& order);
  void upload(const http::Request& request);
  std::string check(const std::string& project) const;
  std::string scene(const std::string& project) const;
  http::Reply served_file(const std::string& path) const;

  const ServedFolder& folder_;
  std::string bin_;
  std::function<bool()> ends_;
  std::mutex writes_;
  RunWatcher run_;
};

}  // namespace langer

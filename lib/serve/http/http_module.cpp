// The only file that includes cpp-httplib (Debian: libcpp-httplib-dev).
#include <atomic>
#include <chrono>
#include <thread>

#include <httplib.h>

#include "core/base/version.hpp"
#include "serve/http/http_interface.hpp"

namespace langer::http {

namespace {

// A repeated header is joined, so that a second Host cannot hide behind the first.
Request request_of(const httplib::Request& from) {
  Request request;
  request.method = from.method;
  request.path = from.path;
  for (const auto& [name, value] : from.params) request.query[name] = value;
  for (const auto& [name, value] : from.headers) {
    std::string lower = name;
    for (char& c : lower)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
    std::string& known = request.header[lower];
    if (!known.empty()) known += ",";
    known += value;
  }
  request.body = from.body;
  return request;
}

void answer(const Handler& handler, const httplib::Request& from, httplib::Response& to) {
  const Reply reply = handler(request_of(from));
  to.status = reply.status;
  for (const auto& [name, value] : reply.header) to.set_header(name.c_str(), value);
  to.set_content(reply.body, reply.type.c_str());
}

// Every path goes to the handler; methods that it does not know are answered by httplib.
bool listen(const ServerOptions& options, const Handler& handler) {
  httplib::Server server;
  server.new_task_queue = [] {
    return new httplib::ThreadPool(8);
  };
  server.set_payload_max_length(options.largest_body);
  server.set_read_timeout(5, 0);
  server.set_write_timeout(5, 0);
  server.set_keep_alive_timeout(1);
  const auto respond = [&](const httplib::Request& from, httplib::Response& to) {
    answer(handler, from, to);
  };
  server.Get(".*", respond);
  server.Post(".*", respond);
  int port = options.port;
  if (port == 0) {
    port = server.bind_to_any_port("127.0.0.1");
    if (port <= 0) return false;
  } else if (!server.bind_to_port("127.0.0.1", port)) {
    return false;
  }
  options.begins(port);
  std::atomic<bool> over = false;
  std::thread watcher([&] {
    while (!over && !options.ends()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.stop();
  });
  server.listen_after_bind();
  over = true;
  watcher.join();
  return true;
}

}  // namespace

}  // namespace langer::http

extern "C" __attribute__((visibility("default")))
const langer::http::Functions langer_http_module{langer::version, langer::http::listen};

#include "serve/serve.hpp"

#include <csignal>
#include <random>

#include <fmt/format.h>

#include "core/base/error.hpp"
#include "core/base/module_path.hpp"
#include "core/base/say.hpp"
#include "serve/child.hpp"
#include "serve/folder.hpp"
#include "serve/http/http_load.hpp"
#include "serve/project_api.hpp"

namespace langer {

namespace {

volatile std::sig_atomic_t signal_came = 0;
void note_end(int) { signal_came = 1; }

// 128 bits of the operating system.
std::string random_token() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", random(), random(), random(), random());
}

// In a time that does not depend on where the texts differ.
bool same_token(const std::string& given, const std::string& token) {
  if (given.size() != token.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i)
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token[i]);
  return difference == 0;
}

// A header of the request; empty if it is not there.
std::string header(const http::Request& request, const std::string& name) {
  const auto found = request.header.find(name);
  if (found == request.header.end()) return "";
  return found->second;
}

// Who may ask. A request is refused before its path is looked at
//   403  if its Host is another name: a page of another site that was made to point here
//   403  if its Origin is another page
//   403  without the token
class Door {
 public:
  Door(std::string token, ProjectApi& api) : token_(std::move(token)), api_(api) {}
  void set_port(int port) { port_ = port; }

  http::Reply reply(const http::Request& request) {
    http::Reply reply = checked_reply(request);
    // nothing from elsewhere, nothing kept, and the address with the token goes nowhere
    reply.header.emplace("Content-Security-Policy",
                         "default-src 'self'; img-src 'self' data: blob:; frame-ancestors 'none'; "
                         "base-uri 'none'; form-action 'none'");
    reply.header.emplace("Referrer-Policy", "no-referrer");
    reply.header.emplace("X-Content-Type-Options", "nosniff");
    reply.header.emplace("Cache-Control", "no-store");
    reply.header.emplace("Cross-Origin-Resource-Policy", "same-origin");
    return reply;
  }

 private:
  std::string token_;
  ProjectApi& api_;
  int port_ = 0;

  // Whether a name and port are those that the browser was given.
  bool is_own(const std::string& host) const {
    return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
  }
  http::Reply checked_reply(const http::Request& request) {
    const auto refuse = [](const std::string& why) {
      return http::Reply{403, "text/plain; charset=utf-8", why + "\n", {}};
    };
    if (!is_own(header(request, "host"))) return refuse("langer serve: this Host is not its own");
    const std::string origin = header(request, "origin");
    if (!origin.empty() && !(origin.starts_with("http://") && is_own(origin.substr(7))))
      return refuse("langer serve: another page may not ask");
    const std::size_t slash = request.path.find('/', 1);
    if (slash == std::string::npos || !same_token(request.path.substr(1, slash - 1), token_))
      return refuse("langer serve: open the address that the program has printed");
    return api_.reply(request, request.path.substr(slash + 1));
  }
};

}  // namespace

// The address is the only line on stdout, so that a script can read it.
int serve(const std::string& folder, int port) {
  const http::Functions& server = http::load();
  const std::string bin = program_folder().string();
  prepare_environment(bin);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, note_end);
  const auto ends = [] {
    return signal_came != 0;
  };
  const ServedFolder served(folder);
  ProjectApi api(served, bin, ends);
  const std::string token = random_token();
  Door door(token, api);
  http::ServerOptions options;
  options.port = port;
  options.ends = ends;
  options.begins = [&](int at) {
    door.set_port(at);
    say_line("langer: {} is set up at", served.path());
    std::fputs(fmt::format("http://127.0.0.1:{}/{}/\n", at, token).c_str(), stdout);
    std::fflush(stdout);
    say_line("langer: open this address in a browser; Ctrl-C ends the server and its runs");
  };
  if (!server.listen(options, [&](const http::Request& r) { return door.reply(r); }))
    throw Failure(Exit::input, Error{{"langer serve"},
                                     "",
                                     fmt::format("cannot listen on port {}", port),
                                     "",
                                     "leave --port out, and a free one is taken"});
  return 0;
}

}  // namespace langer

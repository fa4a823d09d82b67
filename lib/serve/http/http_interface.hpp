// The border to cpp-httplib. The library and those behind it (OpenSSL, brotli) are loaded with the
// module lib/langer/langer_http.so by `langer serve` alone, so other programs do not pay for them.
//
//   request  ->  handler (langer)  ->  reply
#pragma once

#include <functional>
#include <map>
#include <string>

namespace langer::http {

struct Request {
  std::string method;                         // "GET", "POST", ...
  std::string path;                           // decoded, without the part after "?"
  std::map<std::string, std::string> query;   // decoded
  std::map<std::string, std::string> header;  // names in lower case; repeated ones joined by ","
  std::string body;
};

struct Reply {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::map<std::string, std::string> header;
};

using Handler = std::function<Reply(const Request&)>;

struct ServerOptions {
  int port = 0;                          // 0: a free one
  std::size_t largest_body = 16 << 20;   // [bytes]; larger requests are refused
  std::function<void(int port)> begins;  // when it listens
  std::function<bool()> ends;            // asked several times a second
};

struct Functions {
  const char* made_with;  // version of the source; the program's own, or they do not fit together
  // Listens on 127.0.0.1 until `ends` says so. False if the port cannot be had.
  bool (*listen)(const ServerOptions& options, const Handler& handler);
};

inline constexpr const char* symbol = "langer_http_module";  // const Functions, of C linkage

}  // namespace langer::http

#include "serve/http/http_load.hpp"

#include <dlfcn.h>

#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/module_path.hpp"
#include "core/base/version.hpp"

namespace langer::http {

namespace {

[[noreturn]] void refuse(const std::string& found, const std::string& hint) {
  throw Failure(Exit::input, Error{{"langer serve"}, "", found, "", hint});
}

}  // namespace

// The module stays loaded until the program ends.
const Functions& load() {
  const std::string path = module_path("http");
  std::error_code none;
  if (!std::filesystem::exists(path, none))
    refuse("this build has no server: cpp-httplib was missing when it was configured",
           "install libcpp-httplib-dev and build again; everything else works without it");
  void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module)
    refuse(std::string("its server cannot be loaded: ") + dlerror(),
           "install the library (Debian 12: libcpp-httplib0.11)");
  const auto* functions = static_cast<const Functions*>(dlsym(module, symbol));
  if (!functions || std::string(functions->made_with) != version)
    refuse(path + " is of another version of Langer", "build or install Langer as a whole");
  return *functions;
}

}  // namespace langer::http

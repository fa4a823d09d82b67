#include "mechanics/linear/petsc/petsc_load.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <mutex>

#include "core/base/module_path.hpp"
#include "core/base/traps.hpp"
#include "core/base/version.hpp"

namespace langer {

namespace {

std::mutex mutex;
bool tried = false;
const petsc_module::Functions* functions = nullptr;

const petsc_module::Functions* load(std::string& why) {
  const NoTraps in_its_libraries;
  const std::string path = module_path("petsc");
  if (std::error_code ignored; !std::filesystem::exists(path, ignored)) {
    why = "there is no " + path + "; install libpetsc-real-dev and build Langer again";
    return nullptr;
  }
  void* module = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!module) {
    why = std::string("PETSc cannot be loaded: ") + dlerror() +
          "; install libpetsc-real (Debian 12: libpetsc-real3.18)";
    return nullptr;
  }
  const auto* found =
      static_cast<const petsc_module::Functions*>(dlsym(module, petsc_module::symbol));
  if (found && std::string(found->made_with) == version) return found;
  why = path + " is of another version of Langer; build or install Langer as a whole";
  return nullptr;
}

}  // namespace

const petsc_module::Functions* petsc(std::string& why) {
  static std::string words;
  const std::lock_guard alone(mutex);
  if (!tried) {
    functions = load(words);
    tried = true;
  }
  why = words;
  return functions;
}

Ranks* begin_ranks(std::string& why) {
  if (launched().n < 2) return nullptr;
  const petsc_module::Functions* module = petsc(why);
  if (!module) return nullptr;
  const NoTraps in_its_libraries;
  return ranks() = module->ranks(why);
}

void end_petsc() {
  if (functions) functions->end();
}

}  // namespace langer

#include "mechanics/linear/blas/kernels.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace langer::blas {

namespace {

constexpr const char* choice = "OPENBLAS_CORETYPE";

// Left in the environment by a restart, so that the second run can report it.
constexpr const char* fallback = "LANGER_BLAS_FALLBACK";

// Kernels without AVX. On a processor with AVX2 they are always a fallback.
constexpr std::array<std::string_view, 17> without_avx{
    "Generic", "Katmai",       "Coppermine", "Northwood", "Prescott", "Banias",
    "Core2",   "Penryn",       "Dunnington", "Nehalem",   "Atom",     "Athlon",
    "Opteron", "Opteron_SSE3", "Barcelona",  "Bobcat",    "Nano"};

}  // namespace

VectorInstructions vector_instructions() {
  VectorInstructions found;
#if defined(__x86_64__)
  found.avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  found.avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                 __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
                 __builtin_cpu_supports("avx512vl");
#endif
  return found;
}

std::string kernels_in_use() {
  // Looked up by name, since another BLAS does not have the function.
  using Name = char*();
  auto* name = reinterpret_cast<Name*>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  if (!name) {
    // A program that calls no BLAS does not load it. It then asks the installed library.
    void* library = dlopen("libopenblas.so.0", RTLD_LAZY | RTLD_LOCAL);
    if (library) name = reinterpret_cast<Name*>(dlsym(library, "openblas_get_corename"));
  }
  if (!name) return "";
  return name();
}

std::string better_kernels(std::string_view in_use, VectorInstructions processor) {
  const bool old = std::find(without_avx.begin(), without_avx.end(), in_use) != without_avx.end();
  if (!old) return "";
  if (processor.avx512) return "SkylakeX";
  if (processor.avx2) return "Haswell";
  return "";
}

void restart_with_better_kernels(char** argv) {
  if (std::getenv(choice)) return;
  const std::string in_use = kernels_in_use();
  const std::string better = better_kernels(in_use, vector_instructions());
  if (better.empty()) return;

  // The variable also stops the restarted program from a second restart.
  setenv(choice, better.c_str(), 1);
  setenv(fallback, in_use.c_str(), 1);
  execv("/proc/self/exe", argv);

  // Execution is not possible here: continue with the slow kernels, whose results are as good.
  unsetenv(choice);
  unsetenv(fallback);
}

std::string kernels_line() {
  const std::string in_use = kernels_in_use();
  if (in_use.empty()) return "";
  if (const char* before = std::getenv(fallback)) {
    return fmt::format("OpenBLAS kernels {}; OpenBLAS does not know this processor and chose {}",
                       in_use, before);
  }
  if (const std::string better = better_kernels(in_use, vector_instructions()); !better.empty()) {
    if (std::getenv(choice)) {
      return fmt::format("OpenBLAS kernels {} as {} says; {} would be faster", in_use, choice,
                         better);
    }
    return fmt::format("OpenBLAS kernels {}; langer-solve and langer-fit restart with {}", in_use,
                       better);
  }
  return fmt::format("OpenBLAS kernels {}", in_use);
}

}  // namespace langer::blas

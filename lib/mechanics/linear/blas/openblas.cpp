#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <new>

#include "mechanics/linear/blas/blas.hpp"

extern "C" {
void openblas_set_num_threads(int);
int openblas_get_num_threads();
int openblas_get_parallel();
}

namespace langer::blas {

// OpenBLAS takes a buffer of 128 MB for each of its threads, and where there is none asks again and
// again, for ever: whether there is memory for them is asked beforehand.
void check_buffers() {
  static const bool once = [] {
    const std::size_t bytes = (std::size_t{136} << 20) *
                              static_cast<std::size_t>(std::max(1, openblas_get_num_threads()));
    void* memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    munmap(memory, bytes);
    return true;
  }();
  (void)once;
}

void set_threads(int n) { openblas_set_num_threads(n); }

bool waits_for_openmp() {
  constexpr int by_openmp = 2;
  return openblas_get_parallel() == by_openmp && openblas_get_num_threads() > 1;
}

}  // namespace langer::blas

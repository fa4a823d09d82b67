// A BLAS of any make, as it is found when the program runs: MKL, BLIS and OpenBLAS are told how
// many threads, the reference BLAS has one; others go by their own variables.
#include <dlfcn.h>

#include <atomic>

#include "mechanics/linear/blas/blas.hpp"

namespace langer::blas {

namespace {

std::atomic<int> asked{1};

// the function in whichever library the program was loaded with
template <class F>
F* loaded(const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

void check_buffers() {}

void set_threads(int n) {
  asked = n;
  if (auto* mkl = loaded<void(int)>("MKL_Set_Num_Threads")) mkl(n);
  if (auto* openblas = loaded<void(int)>("openblas_set_num_threads")) openblas(n);
  if (auto* blis = loaded<void(long)>("bli_thread_set_num_threads")) blis(n);
}

bool waits_for_openmp() { return asked > 1; }  // not known: better slow than waiting for ever

}  // namespace langer::blas

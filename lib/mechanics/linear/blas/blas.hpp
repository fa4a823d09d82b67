// Threads of the BLAS, which every make of it sets by calls of its own. CMake compiles one of the
// two sources.
#pragma once

namespace langer::blas {

void check_buffers();     // std::bad_alloc where the BLAS would not get its work space
void set_threads(int n);  // for all later calls, where the BLAS can be told

// whether the BLAS waits for threads that omp_set_max_active_levels(0) withholds
bool waits_for_openmp();

}  // namespace langer::blas

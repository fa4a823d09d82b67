// Which kernels OpenBLAS uses, and a restart with better ones.
//
// OpenBLAS contains kernels for many processors and chooses one set when it is loaded. A version
// that is older than the processor may not recognise it. It then falls back to the oldest set
// (Prescott, SSE3), which factorizes at little more than half the speed. The choice can be made by
// the environment variable OPENBLAS_CORETYPE, but only before the library is loaded. A program that
// notices a fallback therefore sets the variable and executes itself again, once.
//
// A user who sets OPENBLAS_CORETYPE keeps that choice. Another BLAS is left alone.
#pragma once

#include <string>
#include <string_view>

namespace langer::blas {

// Vector instructions of this processor, as far as OpenBLAS has kernels for them.
struct VectorInstructions {
  bool avx2 = false;    // with FMA
  bool avx512 = false;  // F, DQ, CD, BW and VL
};

VectorInstructions vector_instructions();

// Name of the kernels in use, such as "Haswell", or in a program without BLAS those of the
// installed OpenBLAS; empty if there is none.
std::string kernels_in_use();

// Name of the kernels that suit the processor better than `in_use`; empty if there are none.
std::string better_kernels(std::string_view in_use, VectorInstructions processor);

// Executes this program again if OpenBLAS fell back to kernels that are too old. Returns if there
// is nothing to gain, if OPENBLAS_CORETYPE is set, or if the program cannot be executed again. To
// be called before the first call of the BLAS; `argv` ends with a null pointer.
void restart_with_better_kernels(char** argv);

// One line about the kernels for -v and langer doctor; empty for another BLAS.
std::string kernels_line();

}  // namespace langer::blas

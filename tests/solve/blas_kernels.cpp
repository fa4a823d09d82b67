// Which kernels OpenBLAS should use (mechanics/linear/blas/kernels.hpp).
#include "mechanics/linear/blas/kernels.hpp"

#include <doctest/doctest.h>

using langer::blas::better_kernels;

TEST_CASE("kernels without AVX are a fallback on a processor with AVX2") {
  CHECK(better_kernels("Prescott", {.avx2 = true, .avx512 = true}) == "SkylakeX");
  CHECK(better_kernels("Prescott", {.avx2 = true, .avx512 = false}) == "Haswell");
  CHECK(better_kernels("Core2", {.avx2 = true, .avx512 = false}) == "Haswell");
}

TEST_CASE("kernels that suit the processor are kept, and so are old ones of an old processor") {
  CHECK(better_kernels("Haswell", {.avx2 = true, .avx512 = true}) == "");
  CHECK(better_kernels("Zen", {.avx2 = true, .avx512 = false}) == "");
  CHECK(better_kernels("Cooperlake", {.avx2 = true, .avx512 = true}) == "");
  CHECK(better_kernels("Prescott", {.avx2 = false, .avx512 = false}) == "");
  CHECK(better_kernels("", {.avx2 = true, .avx512 = true}) == "");
}

# OpenBLAS kernels: a fallback is noticed and cured once, a choice of the user is kept, and the kernels
# do not change the force.
include(${ROOT}/tests/support/run.cmake)
copy_project()
find_program(CC NAMES cc gcc clang)
if(NOT CC)
  message("skipped: no C compiler")
  return()
endif()
unset(ENV{OPENBLAS_CORETYPE})
unset(ENV{LANGER_BLAS_FALLBACK})
set(solve ${BIN}/langer-solve configs/solve/accuracy_isotropic.yaml --set estimate=none
  --set mesh.geometry.indented_block.edge=0.35 --set path.first=0.5 --set path.largest=0.5)

# A library that imitates an OpenBLAS which does not know the processor: it says "Prescott" until
# OPENBLAS_CORETYPE chooses kernels.
file(WRITE ${WORK}/old.c "#include <stdlib.h>
const char* openblas_get_corename(void) {
  const char* chosen = getenv(\"OPENBLAS_CORETYPE\");
  return chosen ? chosen : \"Prescott\";
}
")
run(0 ${CC} -shared -fPIC -o ${WORK}/old.so ${WORK}/old.c)
file(STRINGS /proc/cpuinfo flags REGEX "^flags.* avx2 " LIMIT_COUNT 1)
if(flags AND NOT SANITIZED)
  set(ENV{LD_PRELOAD} ${WORK}/old.so)
  run(0 ${solve} -v -o restarted.h5)
  expect_said("OpenBLAS does not know this processor and chose Prescott")
  set(ENV{OPENBLAS_CORETYPE} Prescott)
  run(0 ${solve} -v -o chosen.h5)
  expect_said("OpenBLAS kernels Prescott as OPENBLAS_CORETYPE says")
  unset(ENV{OPENBLAS_CORETYPE})
  set(ENV{LD_PRELOAD})
endif()

# The forces of different kernels agree to the accuracy of Newton's iterations.
set(forces)
foreach(kernels Prescott Haswell)
  if(kernels STREQUAL Haswell AND NOT flags)
    continue()
  endif()
  set(ENV{OPENBLAS_CORETYPE} ${kernels})
  run(0 ${solve} --quiet --json -o ${kernels}.h5)
  string(REGEX MATCH "\"force_N\": ([0-9.]+)" found "${said}")
  string(SUBSTRING "${CMAKE_MATCH_1}" 0 10 force)  # nine digits
  list(APPEND forces ${force})
endforeach()
unset(ENV{OPENBLAS_CORETYPE})
list(GET forces 0 first)
list(GET forces -1 last)
expect_equal(${last} ${first} "force with other kernels")

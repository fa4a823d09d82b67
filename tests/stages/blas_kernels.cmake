# OpenBLAS kernels: a fallback is noticed and cured once, a choice of the user is kept, and the kernels
# do not change results by more than 1e-12.
include(${ROOT}/tests/support/run.cmake)
copy_project()
find_program(CC NAMES cc gcc clang)
if(NOT CC)
  message("skipped: no C compiler")
  return()
endif()
set(ENV{OPENBLAS_CORETYPE})
set(ENV{LANGER_BLAS_FALLBACK})
set(solve ${BIN}/langer-solve configs/solve/accuracy_isotropic.yaml --set estimate=none --set accuracy=null
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
  set(ENV{OPENBLAS_CORETYPE})
  set(ENV{LD_PRELOAD})
endif()

# results of different kernels
foreach(kernels Prescott Haswell)
  if(kernels STREQUAL Haswell AND NOT flags)
    continue()
  endif()
  set(ENV{OPENBLAS_CORETYPE} ${kernels})
  run(0 ${solve} --quiet -o ${kernels}.h5)
endforeach()
set(ENV{OPENBLAS_CORETYPE})
if(flags)
  run(0 ${BIN}/langer-compare-h5 Prescott.h5 Haswell.h5 1e-12)
endif()

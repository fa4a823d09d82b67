# What `make deb` and `make bundle` left in build-package: sizes, lintian, pipelines that run from the unpacked tar in a folder of another
# name. `make test-package` makes both before; here they are skipped with a word where they are not. install.cmake does the same with
# packages of the build that is tested.
if(NOT PACKAGE)
  set(PACKAGE ${ROOT}/build-package)
endif()
include(${ROOT}/tests/support/run.cmake)
include(${ROOT}/tests/support/package.cmake)
file(GLOB deb ${PACKAGE}/*.deb)
file(GLOB tar ${PACKAGE}/langer-*-linux-*.tar.gz)
if(NOT deb OR NOT tar)
  message("skipped: no package in ${PACKAGE}: make deb bundle")
  return()
endif()
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(folder ${WORK})
check_deb(${deb})
check_bundle(${tar})

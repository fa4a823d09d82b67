# One room opens files for writing: lib/core/base/output_file.cpp, which follows no links.
#   cmake -DROOT=<project> -P tests/output_room.cmake
# Excepted are HDF5's own call, which opens a file made there by its descriptor, the streams of gnuplot,
# which are in a folder made there, /dev/null, and the list of flags that the filter of gmsh forbids.
set(ways "std::ofstream|std::fstream|std::filebuf|fopen\\(|freopen\\(|tmpfile\\(|mkstemp|mkdtemp|O_CREAT|O_TRUNC|O_WRONLY|O_RDWR|creat\\(|H5Fcreate\\(|H5F_ACC_RDWR|fs::copy|copy_file\\(|filesystem::copy|create_symlink|create_hard_link")
set(excepted
  "lib/core/base/output_file.cpp=."
  "lib/core/hdf5/h5.cpp=H5Fcreate\\(name"
  "lib/meshing/gmsh/child_process.cpp=/dev/null"
  "lib/meshing/gmsh/restrict.cpp=^ *O_WRONLY . O_RDWR . O_CREAT"
  "lib/results/plot/gnuplot.cpp=/dev/null|O_EXCL . O_NOFOLLOW")
set(failed FALSE)
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/lib/*.hpp ${ROOT}/lib/*.cpp ${ROOT}/stages/*.hpp ${ROOT}/stages/*.cpp)
list(LENGTH files n)
if(n LESS 300)
  message(FATAL_ERROR "${n} sources found: is ${ROOT} the project?")
endif()
foreach(file ${files})
  file(STRINGS ${ROOT}/${file} lines REGEX "${ways}")
  foreach(line ${lines})
    if(line MATCHES "^ *//")
      continue()
    endif()
    set(allowed FALSE)
    foreach(rule ${excepted})
      string(REGEX MATCH "^([^=]+)=(.*)$" _ "${rule}")
      if(file STREQUAL CMAKE_MATCH_1 AND line MATCHES "${CMAKE_MATCH_2}")
        set(allowed TRUE)
      endif()
    endforeach()
    if(NOT allowed)
      message("${file}: ${line}\n  rule: files are opened for writing in lib/core/base/output_file.cpp only (create_file, write_text_file)")
      set(failed TRUE)
    endif()
  endforeach()
endforeach()
if(failed)
  message(FATAL_ERROR "files are opened for writing outside of their room")
endif()

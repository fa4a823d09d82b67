# Checks which folder includes which, and that third-party headers stay in their folder.
#   cmake -DROOT=<project> -P tests/layout.cmake
#
# A folder of lib/ is a room, and rooms that belong together form a wing. A file may include headers
# of its own room and of the rooms listed before it, so there are no cycles. `make map` draws the wings.
set(rooms
  core/base core/tensor core/config core/hdf5
  mechanics/mesh mechanics/contact mechanics/mortar mechanics/material mechanics/element mechanics/assembly
  mechanics/dynamics mechanics/linear mechanics/nonlinear mechanics/solve mechanics/vibration
  meshing
  results/store results/plot results/post
  layers
  scene/model scene/run
  accuracy/checks accuracy/estimate accuracy/refinement
  identification/fit identification/sensitivity identification/statistics identification/posterior
  identification/setup identification/population identification/laws identification/inverse
  export report
  pipeline/sweep pipeline/plan
  cli serve/http serve stages)

# beginning of an include -> the only place where it may stand
set(third_parties
  "yaml-cpp/=lib/core/config/" "hdf5=lib/core/hdf5/" "gmsh=lib/meshing/gmsh/"
  "petsc=lib/mechanics/linear/petsc/" "mpi=lib/mechanics/linear/petsc/"
  "metis=lib/mechanics/linear/petsc/" "cholmod=lib/mechanics/linear/"
  "umfpack=lib/mechanics/linear/" "kinsol=lib/mechanics/nonlinear/kinsol.cpp"
  "sundials=lib/mechanics/nonlinear/kinsol.cpp" "nvector=lib/mechanics/nonlinear/kinsol.cpp"
  "httplib=lib/serve/http/http_module.cpp" "CLI/=stages/common/arguments.cpp" "nlopt=lib/identification/fit/"
  "muParser=lib/core/config/formula.cpp"
  "boost/random=lib/identification/sensitivity/sobol_sequence.cpp"
  "boost/geometry=lib/mechanics/mortar/facet_search.cpp")
set(failed FALSE)

# The room of a path below lib/ is the longest entry of the list above that it begins with.
function(find_room path result)
  set(${result} -1 PARENT_SCOPE)
  foreach(room ${rooms})
    string(FIND "${path}" "${room}/" begins)
    if(begins EQUAL 0)
      list(FIND rooms ${room} index)
      set(${result} ${index} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/lib/*.hpp ${ROOT}/lib/*.cpp
  ${ROOT}/stages/*.hpp ${ROOT}/stages/*.cpp)
foreach(file ${files})
  string(REGEX REPLACE "^lib/" "" path ${file})
  find_room(${path} room)
  if(room EQUAL -1)
    message("${file}\n  rule: its folder is missing in the list of rooms in tests/layout.cmake")
    set(failed TRUE)
  endif()
  file(STRINGS ${ROOT}/${file} lines REGEX "^#include")
  foreach(line ${lines})
    if(line MATCHES "^#include \"([a-z_0-9/]+/)[a-z_0-9]+\\.hpp\"")
      find_room(${CMAKE_MATCH_1} below)
      if(below EQUAL -1 AND NOT file MATCHES "^stages/" OR below GREATER room)
        message("${file}: ${line}\n  rule: that folder is above this one (list of rooms in tests/layout.cmake)")
        set(failed TRUE)
      endif()
    elseif(line MATCHES "^#include <(.*)>")
      set(header ${CMAKE_MATCH_1})
      foreach(rule ${third_parties})
        string(REGEX MATCH "^([^=]+)=(.*)$" _ ${rule})
        set(library ${CMAKE_MATCH_1})
        set(place ${CMAKE_MATCH_2})
        string(FIND "${header}" "${library}" begins)
        string(FIND "${file}" "${place}" allowed)
        if(begins EQUAL 0 AND NOT allowed EQUAL 0)
          message("${file}: ${line}\n  rule: <${library}...> only in ${place}")
          set(failed TRUE)
        endif()
      endforeach()
    endif()
  endforeach()
endforeach()

# A file name exists once in lib/, except for a header and its source.
set(sources ${files})
list(FILTER sources INCLUDE REGEX "^lib/")
foreach(file ${sources})
  string(REGEX REPLACE "\\.[a-z]+$" "" stem ${file})
  get_filename_component(name ${stem} NAME)
  if(DEFINED stem_${name} AND NOT "${stem_${name}}" STREQUAL stem)
    message("${file}\n  rule: ${stem_${name}} has the same name")
    set(failed TRUE)
  endif()
  set(stem_${name} ${stem})
endforeach()

# One name, one type: two types of one name in the same namespace break each other silently when linked.
file(GLOB_RECURSE headers RELATIVE ${ROOT} ${ROOT}/lib/*.hpp)
foreach(file ${headers})
  file(STRINGS ${ROOT}/${file} inner REGEX "^namespace langer::")
  file(STRINGS ${ROOT}/${file} types REGEX "^(struct|class|enum class) [A-Za-z0-9]+( final)?( :[^;]*)? {")
  foreach(line ${types})
    string(REGEX MATCH "^(struct|class|enum class) ([A-Za-z0-9]+)" _ "${line}")
    set(type ${CMAKE_MATCH_2})
    if(inner)
      string(REGEX REPLACE "[^A-Za-z0-9]" "_" space "${inner}")
      set(type ${space}_${type})
    endif()
    if(DEFINED place_${type} AND NOT "${place_${type}}" STREQUAL file)
      message("${file}: ${line}\n  rule: ${place_${type}} defines a type of the same name")
      set(failed TRUE)
    endif()
    set(place_${type} ${file})
  endforeach()
endforeach()
# doctest's Approx adds 1 to the size of what it compares, so that small numbers pass as 0
# (tests/support/near.hpp has the comparison to use).
file(GLOB_RECURSE tests RELATIVE ${ROOT} ${ROOT}/tests/*.hpp ${ROOT}/tests/*.cpp)
foreach(file ${tests})
  file(STRINGS ${ROOT}/${file} lines REGEX "(^|[^A-Za-z])Approx *\\(")
  foreach(line ${lines})
    message("${file}: ${line}\n  rule: compare with near() of tests/support/near.hpp, not with doctest::Approx")
    set(failed TRUE)
  endforeach()
endforeach()
if(failed)
  message(FATAL_ERROR "the layout rules above are broken")
endif()

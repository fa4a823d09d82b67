# The man pages of a program and of its commands, by help2man from what the program says of itself:
#   cmake -DHELP2MAN=help2man -DPROGRAM=bin/langer-solve -DLANGER=bin/langer -DVERSION=0.4.0 -DFOLDER=pages/man1 -P cmake/man_pages.cmake
#
# help2man reads --help. Its table of keys is cut to the width of a terminal, so a page leaves it out and has a section CONFIG instead
# with all keys, as `langer describe` prints them. The commands of `langer` have pages of their own: `man langer-show`.
cmake_minimum_required(VERSION 3.25)
if(NOT DEFINED ENV{SOURCE_DATE_EPOCH})  # the date of a page is that of the sources, so that it is the same in every build
  execute_process(COMMAND git -C ${CMAKE_CURRENT_LIST_DIR} log -1 --format=%ct OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(date)
    set(ENV{SOURCE_DATE_EPOCH} ${date})
  endif()
endif()

# Text as troff: a backslash and a hyphen are escaped, and so is a full stop or a quote at the beginning of a line.
function(to_troff text result)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "(^|\n)([.'])" "\\1\\\\&\\2" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

# The page of the program or of one of its commands; ${help} is its --help.
function(write_page page help)
  string(REGEX MATCH "^[^\n]*[^.\n]" sentence "${help}")
  string(REGEX REPLACE "(\nUsage: [^\n]*\n)\n" "\\1\nOptions:\n" help "${help}")
  string(REGEX REPLACE "\nKeys of the config.*(\nExample:\n)" "\\1" help "${help}")
  string(REGEX MATCH "\nExample:\n(  [^\n]*\n)+" examples "${help}")
  string(REPLACE "${examples}" "" help "${help}")
  string(REPLACE "\nExample:\n" "" examples "${examples}")
  to_troff("${examples}" examples)
  string(REGEX MATCH "\nExit codes: [^\n]*\n" codes "${help}")
  string(REPLACE "${codes}" "" help "${help}")
  string(REPLACE "\nExit codes: " "" codes "${codes}")

  set(sections "[EXAMPLES]\n.nf\n${examples}.fi\n\n")
  string(REGEX REPLACE "^langer-" "" stage ${page})
  execute_process(COMMAND ${LANGER} describe ${stage} RESULT_VARIABLE no_stage OUTPUT_VARIABLE keys ERROR_QUIET)
  if(no_stage EQUAL 0)
    to_troff("${keys}" keys)
    string(APPEND sections "[CONFIG]\nA YAML file, in mm, N, MPa, s and degrees.\n.PP\n.nf\n${keys}.fi\n\n")
  endif()
  string(APPEND sections "[EXIT STATUS]\n${codes}\n[ENVIRONMENT]\n.TP\n.B NO_COLOR\nno colour on a terminal\n"
    ".TP\n.B SOURCE_DATE_EPOCH\nthe time written into files\n\n"
    "[SEE ALSO]\n.BR langer (1)\nlists the stages and commands, each of which has a page.\n")

  # help2man runs a program of the page's name; this one prints the text. Unchanged texts leave the page as it is.
  set(program ${FOLDER}/said/${page})
  file(CONFIGURE OUTPUT ${program}.txt CONTENT "@help@" @ONLY)
  file(CONFIGURE OUTPUT ${program}.sections CONTENT "@sections@" @ONLY)
  file(CONFIGURE OUTPUT ${program} CONTENT "#!/bin/sh\ncat \"$0.txt\"\n" @ONLY)
  file(CHMOD ${program} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
  set(out ${FOLDER}/${page}.1)
  if(${program}.txt IS_NEWER_THAN ${out} OR ${program}.sections IS_NEWER_THAN ${out})
    execute_process(COMMAND ${HELP2MAN} --no-info --version-string=${VERSION} "--name=${sentence}" "--source=Langer ${VERSION}"
      --include=${program}.sections --output=${out} ${program} COMMAND_ERROR_IS_FATAL ANY)
  endif()
  file(TOUCH ${out})
endfunction()

get_filename_component(name ${PROGRAM} NAME)
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
if(name STREQUAL "langer")
  string(REGEX REPLACE "\nExample:.*" "" listed "${help}")
  string(REGEX MATCHALL "\n  [a-z]+ " commands "${listed}")
  foreach(command ${commands})
    string(STRIP "${command}" command)
    execute_process(COMMAND ${PROGRAM} ${command} --help OUTPUT_VARIABLE command_help COMMAND_ERROR_IS_FATAL ANY)
    write_page(langer-${command} "${command_help}")
  endforeach()
endif()
write_page(${name} "${help}")

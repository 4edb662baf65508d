# SPDX-License-Identifier: Apache-2.0
# What is compiled for wide registers must share nothing: of several copies of an inline function the
# linker keeps one, and were it one of these, lesser machines would stop at an unknown instruction.
# cmake -DNM=nm -DOBJECTS=a.o|b.o -P kernel_symbols_test.cmake
string(REPLACE "|" ";" OBJECTS "${OBJECTS}")
if(NOT OBJECTS)
  message("not available here: this machine has portable kernels only")
  return()
endif()
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} -C --defined-only --extern-only ${object}
                  OUTPUT_VARIABLE symbols RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "${NM} cannot read ${object}")
  endif()
  string(REGEX MATCHALL "[^\n]+" lines "${symbols}")
  list(LENGTH lines count)
  if(NOT count EQUAL 1 OR NOT symbols MATCHES "boresight::k[A-Za-z0-9]+ColumnKernels")
    message(FATAL_ERROR "${object} shares more than its table of kernels:\n${symbols}")
  endif()
endforeach()
message("${OBJECTS}: one symbol each")

# Run at build time by strut_build_info_source; see build_info.cmake.
cmake_minimum_required(VERSION 3.25)
set(STRUT_COMMIT unknown)
# Without .git here, git would describe an enclosing checkout.
if(EXISTS ${STRUT_SOURCE_DIR}/.git)
  find_program(git git)
  if(git)
    execute_process(COMMAND ${git} describe --always --dirty --tags
      WORKING_DIRECTORY ${STRUT_SOURCE_DIR}
      OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE
      RESULT_VARIABLE failed ERROR_QUIET)
    if(NOT failed)
      set(STRUT_COMMIT ${described})
    endif()
  endif()
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/build_info.cc.in ${STRUT_OUTPUT} @ONLY)

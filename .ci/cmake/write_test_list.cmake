# Run after every link of a test program; see discover_tests.cmake.
cmake_minimum_required(VERSION 3.25)

# Stores the names of the test cases that match a Catch2 test specification.
function(list_tests specification output)
  execute_process(
    COMMAND ${STRUT_TEST_PROGRAM} ${specification} --list-test-names-only
    WORKING_DIRECTORY ${STRUT_WORKING_DIRECTORY}
    OUTPUT_VARIABLE names RESULT_VARIABLE count ERROR_VARIABLE errors)
  # The exit code of Catch2 2 is the number of listed tests.
  if(NOT count MATCHES "^[0-9]+$" OR errors)
    message(FATAL_ERROR "${STRUT_TEST_PROGRAM} ${specification}: ${count}\n${names}${errors}")
  endif()
  if(names MATCHES "[][;\\]")
    message(FATAL_ERROR "A test name may not contain [ ] ; or \\:\n${names}")
  endif()
  string(REGEX REPLACE "\n+$" "" names "${names}")
  string(REPLACE "\n" ";" names "${names}")
  set(${output} "${names}" PARENT_SCOPE)
endfunction()

list_tests("~[.]" all)  # hidden tests are helpers of other tests
foreach(label IN LISTS STRUT_TEST_LABELS)
  list_tests("[${label}]" with_${label})
endforeach()

set(script "")
foreach(name IN LISTS all)
  set(labels "")
  foreach(label IN LISTS STRUT_TEST_LABELS)
    if(name IN_LIST with_${label})
      list(APPEND labels ${label})
    endif()
  endforeach()
  if(NOT labels)
    list(JOIN STRUT_TEST_LABELS " " known)
    message(FATAL_ERROR "Test \"${name}\" carries none of the tags: ${known}")
  endif()
  set(lock "")
  if("cluster" IN_LIST labels)  # two Slurm instances at once on one machine slow each other down
    set(lock " RESOURCE_LOCK cluster")
  endif()
  string(REPLACE "," "\\," specification "${name}")
  string(APPEND script
    "add_test([==[${name}]==] [==[${STRUT_TEST_PROGRAM}]==] [==[${specification}]==])\n"
    "set_tests_properties([==[${name}]==] PROPERTIES\n"
    "  WORKING_DIRECTORY [==[${STRUT_WORKING_DIRECTORY}]==] LABELS [==[${labels}]==]${lock})\n")
endforeach()
file(WRITE ${STRUT_OUTPUT} "${script}")

# strut_discover_tests(TARGET) makes one ctest of each Catch2 test case of TARGET, with the labels
# among its tags, after every link of TARGET. (The Catch.cmake of Catch2 2.13 does not support labels.)
set(STRUT_TEST_LABELS unit property reference regression io cluster statistical threads slow)

function(strut_discover_tests target)
  set(listing ${CMAKE_CURRENT_BINARY_DIR}/${target}_list.cmake)
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND}
      -D "STRUT_TEST_PROGRAM=$<TARGET_FILE:${target}>"
      -D "STRUT_TEST_LABELS=${STRUT_TEST_LABELS}"
      -D "STRUT_WORKING_DIRECTORY=${PROJECT_SOURCE_DIR}"
      -D "STRUT_OUTPUT=${listing}"
      -P ${PROJECT_SOURCE_DIR}/.ci/cmake/write_test_list.cmake
    BYPRODUCTS ${listing}
    VERBATIM)
  # A program that was never built must fail the test run, not leave it empty.
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake
    "if(EXISTS \"${listing}\")\n  include(\"${listing}\")\nelse()\n"
    "  add_test(${target}_NOT_BUILT ${target}_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY
    TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/${target}_include.cmake)
endfunction()

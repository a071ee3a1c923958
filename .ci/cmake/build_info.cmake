# strut_add_build_info(TARGET) adds base/text/build_info.h's definition to TARGET.
#
# The commit is read at every build, not only when CMake configures; the generated source is written
# only if its content changed, so an unchanged checkout compiles and links nothing.
function(strut_add_build_info target)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/build_info.cc)
  set(script ${PROJECT_SOURCE_DIR}/.ci/cmake/write_build_info.cmake)
  add_custom_target(strut_build_info_source
    COMMAND ${CMAKE_COMMAND}
      -D STRUT_SOURCE_DIR=${PROJECT_SOURCE_DIR}
      -D STRUT_OUTPUT=${source}
      -D STRUT_VERSION=${PROJECT_VERSION}
      -D "STRUT_COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
      -D STRUT_BUILD_TYPE=$<CONFIG>
      -P ${script}
    BYPRODUCTS ${source}
    COMMENT "Reading the commit"
    VERBATIM)
  add_library(strut_build_info STATIC ${source})
  target_link_libraries(strut_build_info PRIVATE strut::options)
  add_dependencies(strut_build_info strut_build_info_source)

  get_target_property(type ${target} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    target_link_libraries(${target} INTERFACE strut_build_info)
  else()
    target_link_libraries(${target} PUBLIC strut_build_info)
  endif()
endfunction()

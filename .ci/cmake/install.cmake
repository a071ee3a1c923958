# The installed files, for use outside of the build folder: docs/api.md, docs/install.md.
#
#   bin/strut                        the program
#   share/man                        the manual page (jobs/)
#   share/bash-completion, zsh, fish completion scripts (jobs/)
#   share/strut/examples             called examples/ in the documentation
#   share/doc/strut                  the documentation
#   include/strut, lib, lib/cmake    the rooms as libraries: find_package(strut)
#
# No file contains its prefix: the tree can be moved.
include(CMakePackageConfigHelpers)

set(strut_of_programs OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)
install(DIRECTORY examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/strut/examples
  PATTERN __pycache__ EXCLUDE
  PATTERN *.py PERMISSIONS ${strut_of_programs}
  PATTERN run_loop PERMISSIONS ${strut_of_programs})
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES .ci/package/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Where the documentation's links look for the examples.
file(RELATIVE_PATH strut_examples_link ${CMAKE_INSTALL_FULL_DOCDIR}
  ${CMAKE_INSTALL_FULL_DATADIR}/strut/examples)
install(CODE "file(CREATE_LINK ${strut_examples_link}
  \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/examples\" SYMBOLIC)")

# Headers that are not installed, since they need libraries that only our sources link.
set(strut_inner_headers
  base/math/matrix_map base/math/xsimd_backend base/parallel/team model/kernel/run_cases model/kernel/run_derivatives
  model/integrate/sundials train/network/block_layers io/format/hdf5_calls io/format/json io/format/parse_toml
  io/format/read_json io/format/toml_source)
list(JOIN strut_inner_headers "|" strut_inner_headers)
set(strut_rooms base model kernel io model_files estimate sweep train diagnose)
foreach(room IN LISTS strut_rooms)
  set_target_properties(strut_${room} PROPERTIES EXPORT_NAME ${room})
  target_compile_features(strut_${room} INTERFACE cxx_std_20)
  target_include_directories(strut_${room} INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/strut>)
  if(IS_DIRECTORY ${PROJECT_SOURCE_DIR}/${room})  # the kernel's headers are part of the model's
    install(DIRECTORY ${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/strut
      FILES_MATCHING PATTERN *.h
      REGEX "/(${strut_inner_headers})\\.h$" EXCLUDE)
  endif()
endforeach()

# Eigen's matrices may be allocated in strut and freed in a project that uses it, and the linker keeps one
# copy of each inline function. Both sides must therefore agree on threads, on alignment (Eigen derives it
# from -march; base/math/eigen_abi.h compares it), and on the heap (Eigen's choice depends on
# -fsanitize=address).
separate_arguments(strut_flags UNIX_COMMAND "${CMAKE_CXX_FLAGS}")
get_target_property(strut_eigen_folders Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
list(TRANSFORM strut_eigen_folders PREPEND -I)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/eigen_alignment.cc
  "#include <Eigen/Core>\nstrut_alignment EIGEN_DEFAULT_ALIGN_BYTES EIGEN_MAX_STATIC_ALIGN_BYTES \
EIGEN_MALLOC_ALREADY_ALIGNED\n")
execute_process(
  COMMAND ${CMAKE_CXX_COMPILER} ${strut_flags} ${strut_eigen_folders} -E -P
    ${CMAKE_CURRENT_BINARY_DIR}/eigen_alignment.cc
  OUTPUT_VARIABLE strut_preprocessed COMMAND_ERROR_IS_FATAL ANY)
if(NOT strut_preprocessed MATCHES "strut_alignment ([0-9]+) ([0-9]+) ([01])")
  message(FATAL_ERROR "Eigen/Core does not tell its alignment")
endif()
foreach(room IN ITEMS estimate diagnose)
  target_compile_definitions(strut_${room} INTERFACE
    $<INSTALL_INTERFACE:EIGEN_DONT_PARALLELIZE>
    $<INSTALL_INTERFACE:EIGEN_MALLOC_ALREADY_ALIGNED=${CMAKE_MATCH_3}>
    $<INSTALL_INTERFACE:STRUT_EIGEN_HEAP_ALIGNMENT=${CMAKE_MATCH_1}>
    $<INSTALL_INTERFACE:STRUT_EIGEN_STATIC_ALIGNMENT=${CMAKE_MATCH_2}>)
endforeach()

set(strut_package ${CMAKE_INSTALL_LIBDIR}/cmake/strut)
list(TRANSFORM strut_rooms PREPEND strut_ OUTPUT_VARIABLE strut_libraries)
install(TARGETS ${strut_libraries} EXPORT strut ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT strut NAMESPACE strut:: FILE strutTargets.cmake DESTINATION ${strut_package})
configure_package_config_file(.ci/cmake/strutConfig.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/strutConfig.cmake INSTALL_DESTINATION ${strut_package})
# Before 1.0, a change of the second number breaks compatibility.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/strutConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/strutConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/strutConfigVersion.cmake DESTINATION ${strut_package})

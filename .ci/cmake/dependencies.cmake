# All external libraries. Their Debian packages: .ci/packages

# xsimd's own package file requires linking xtl, which its headers do not need.
find_path(STRUT_XSIMD_INCLUDE_DIR xsimd/xsimd.hpp REQUIRED)
add_library(strut_xsimd INTERFACE)
target_include_directories(strut_xsimd SYSTEM INTERFACE ${STRUT_XSIMD_INCLUDE_DIR})
add_library(strut::xsimd ALIAS strut_xsimd)

find_path(STRUT_RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
add_library(strut_random123 INTERFACE)
target_include_directories(strut_random123 SYSTEM INTERFACE ${STRUT_RANDOM123_INCLUDE_DIR})
add_library(strut::random123 ALIAS strut_random123)

# Debian's matio has no CMake package.
find_path(STRUT_MATIO_INCLUDE_DIR matio.h REQUIRED)
find_library(STRUT_MATIO_LIBRARY matio REQUIRED)
add_library(strut::matio INTERFACE IMPORTED GLOBAL)
target_include_directories(strut::matio SYSTEM INTERFACE ${STRUT_MATIO_INCLUDE_DIR})
target_link_libraries(strut::matio INTERFACE ${STRUT_MATIO_LIBRARY})

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
# Otherwise Eigen's products use their own threads wherever OpenMP is on: more than --threads allows, and
# with blocks, and therefore bits, that depend on the number of threads.
set_property(TARGET Eigen3::Eigen APPEND PROPERTY INTERFACE_COMPILE_DEFINITIONS EIGEN_DONT_PARALLELIZE)
find_package(HDF5 1.10 REQUIRED COMPONENTS C HL)
find_package(SUNDIALS 6.4 REQUIRED
  COMPONENTS kinsol cvode nvecserial sunmatrixdense sunlinsoldense sunnonlinsolfixedpoint)
find_package(tomlplusplus 3.3 REQUIRED)
find_package(Boost 1.74 REQUIRED COMPONENTS program_options)
# Required by the JSON parser of Boost 1.74, which the tests use: it uses names that it deprecates itself.
set_property(TARGET Boost::headers APPEND PROPERTY
  INTERFACE_COMPILE_DEFINITIONS BOOST_BIND_GLOBAL_PLACEHOLDERS)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(fmt 9.1 REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(ZLIB 1.2 REQUIRED)
find_package(OpenSSL 3.0 REQUIRED COMPONENTS Crypto)
if(STRUT_BUILD_TESTS)
  find_package(Catch2 2.13 REQUIRED)
endif()
if(STRUT_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

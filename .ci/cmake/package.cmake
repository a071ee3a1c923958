# `cpack -G DEB` in the build folder makes strut_VERSION_ARCHITECTURE.deb, `cpack -G TGZ` a tarball with
# the shared libraries in it: docs/install.md.
set(STRUT_MAINTAINER "The strut authors <strut@example.org>" CACHE STRING
  "Name and address in the package, of whoever hands it out")
set(CPACK_PACKAGE_NAME strut)
set(CPACK_PACKAGE_VENDOR "The strut authors")
set(CPACK_PACKAGE_CONTACT ${STRUT_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "identification of worn vehicle suspensions by simulation")
set(CPACK_PACKAGE_DESCRIPTION_FILE ${PROJECT_SOURCE_DIR}/.ci/package/description)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${strut_of_programs})  # whatever the umask
set(CPACK_GENERATOR DEB)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # Depends: packages of the program's shared libraries
# For the libraries, which are static, and for examples/python.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, libeigen3-dev, libhdf5-dev, libsundials-dev, \
libtomlplusplus-dev, libfmt-dev, libssl-dev, zlib1g-dev, python3-h5py, python3-numpy")
if(STRUT_PYTHON)
  # Two packages: strut, with all that belongs to no component, and python3-strut.
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME strut)
  math(EXPR strut_next_python "${Python_VERSION_MINOR} + 1")  # the module is of one version
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-strut)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "strut (= ${PROJECT_VERSION}), \
python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), \
python3 (<< ${Python_VERSION_MAJOR}.${strut_next_python}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-xarray")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "identification of worn vehicle suspensions, from Python
 The engine of strut as a module: runs, many runs in lanes and threads, exact
 derivatives, sweeps, networks and diagnoses, with NumPy arrays.")
endif()
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/.ci/package/components.cmake)
include(CPack)

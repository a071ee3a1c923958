# strut::options holds the compile options of all our sources.
add_library(strut_options INTERFACE)
add_library(strut::options ALIAS strut_options)
target_include_directories(strut_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_features(strut_options INTERFACE cxx_std_20)

# No code reads errno after sqrt or exp, and setting it costs a branch and a call each time. No other
# floating-point relaxation is enabled: -ffast-math would break the guards against NaN.
target_compile_options(strut_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -fno-math-errno
  $<$<BOOL:${STRUT_WARNINGS_AS_ERRORS}>:-Werror>)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # No function is replaced at load time: position-independent code inlines as other code does.
  target_compile_options(strut_options INTERFACE -fno-semantic-interposition)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False positives on "text" + std::string (GCC bug 105651).
  target_compile_options(strut_options INTERFACE -Wno-restrict)
endif()

if(STRUT_SANITIZE)
  set(sanitize -fsanitize=${STRUT_SANITIZE} -fno-sanitize-recover=all)
  if(STRUT_SANITIZE MATCHES address AND STRUT_SANITIZE MATCHES undefined)
    # The address sanitizer detects bad pointers; a second check doubles the compile time.
    list(APPEND sanitize -fno-sanitize=null,alignment,object-size,vptr)
  endif()
  # A target with the property STRUT_UNCHECKED is compiled without.
  target_compile_options(strut_options INTERFACE -fno-omit-frame-pointer
    "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:STRUT_UNCHECKED>>>:${sanitize}>")
  target_link_options(strut_options INTERFACE -fsanitize=${STRUT_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC's documentation: with -fsanitize this warning has false positives (here in std::regex).
    target_compile_options(strut_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()

if(STRUT_COVERAGE)
  target_compile_options(strut_options INTERFACE --coverage -fprofile-abs-path)
  target_link_options(strut_options INTERFACE --coverage)
endif()

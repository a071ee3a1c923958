// Catch2's main, compiled once for all test files.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

// Asked by the leak checker of the address sanitizer: the HDF5 library does not free all that it
// made of a file before it refused it as damaged.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

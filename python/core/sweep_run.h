// A planned sweep that runs inside Python.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>

namespace strut {

/// Simulates what is missing in a sweep's folder, with `retry_failed` also what failed.
/// `watch(cases, done, failed)` is called about ten times a second. Ctrl-C publishes finished
/// shards and raises KeyboardInterrupt. Returns a dictionary of counts.
pybind11::dict run_folder(const std::filesystem::path& folder, int threads, bool retry_failed,
                          const pybind11::object& watch);

}  // namespace strut

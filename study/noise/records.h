// The test cases of a noise study's networks, as bounds and fits need them.
#pragma once

#include <cstdint>
#include <vector>

#include "estimate/measured_run.h"
#include "study/noise/trainings.h"

namespace strut {

struct TestCase {
  std::int64_t number = 0;  // among the usable cases of the data
  Case setup;               // with the case's parameters
};

/// The first `request.fits` test cases of the snapshots, or all where there are fewer.
std::vector<TestCase> list_test_cases(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                      const NoiseSnapshots& snapshots);
/// The same of the windows.
std::vector<TestCase> list_window_cases(const NoiseStudyRequest& request,
                                        const NoiseStudyData& data);

/// The window of a test case with the hit time, biases and noise of its first copy. It is simulated
/// anew with a fourth of the sweep's usual step: the sweep's records are sampled too coarsely to be
/// shifted by a hit time and stay exact where noise is far below that of real sensors. The setup of
/// the run is the middle of the grid, not the case. Throws InputError.
MeasuredRun draw_record(const NoiseStudyRequest& request, const NoiseStudyData& data, double scale,
                        const TestCase& test);

}  // namespace strut

// The cases that a noise study's networks are tested with, as bounds and fits take them.
#pragma once

#include <cstdint>
#include <vector>

#include "estimate/measured_run.h"
#include "jobs/study/noise_trainings.h"

namespace strut {

struct TestCase {
  std::int64_t number = 0;  // among the usable cases of the data
  Case setup;               // with the case's parameters
};

/// The first `request.fits` test cases of the snapshots; fewer where there are fewer.
std::vector<TestCase> list_test_cases(const NoiseStudyRequest& request, const NoiseStudyData& data,
                                      const NoiseSnapshots& snapshots);
/// Those of the windows.
std::vector<TestCase> list_window_cases(const NoiseStudyRequest& request,
                                        const NoiseStudyData& data);

/// The window of a test case with the hit time, biases and noise of its first copy, simulated anew
/// with a fourth of the sweep's usual step: records of a sweep are sampled too coarsely to be moved
/// by a hit time and still be exact where noise is far below that of real sensors. Its own setup
/// knows of the case no more than the middle of the grid. Throws InputError.
MeasuredRun draw_record(const NoiseStudyRequest& request, const NoiseStudyData& data, double scale,
                        const TestCase& test);

}  // namespace strut

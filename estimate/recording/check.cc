#include "estimate/recording/check.h"

#include "estimate/recording/alignment.h"
#include "estimate/recording/check_alignment.h"

namespace strut {

std::vector<RecordingFinding> check_recordings(const std::vector<MeasuredRun>& runs,
                                               const std::vector<Unknown>& free, int threads) {
  AlignmentOptions options;
  options.threads = threads;
  std::vector<RecordingFinding> findings =
      check_alignment(runs, align_recordings(runs, free, options));
  return findings;
}

}  // namespace strut

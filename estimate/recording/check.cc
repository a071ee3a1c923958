#include "estimate/recording/check.h"

#include <algorithm>
#include <iterator>

#include "estimate/recording/alignment.h"
#include "estimate/recording/check_alignment.h"
#include "estimate/recording/check_readings.h"

namespace strut {

std::vector<RecordingFinding> check_recordings(const std::vector<MeasuredRun>& runs,
                                               const std::vector<Unknown>& free, int threads) {
  AlignmentOptions options;
  options.threads = threads;
  // The search changes parameters by factors.
  std::vector<Unknown> moved;
  std::copy_if(free.begin(), free.end(), std::back_inserter(moved),
               [](const Unknown& u) { return u.kind == UnknownKind::kParameter && u.start > 0.0; });
  std::vector<RecordingFinding> findings;
  for (auto& some : {check_alignment(runs, align_recordings(runs, moved, options)),
                     check_clocks(runs), check_sensors(runs), check_copies(runs)}) {
    findings.insert(findings.end(), some.begin(), some.end());
  }
  return findings;
}

}  // namespace strut

#include "estimate/recording/finding.h"

namespace strut {

std::string RecordingFinding::describe() const {
  std::string text = run.empty() ? "" : run + ": ";
  if (!channel.empty()) text += channel + " ";
  text += what;
  return advice.empty() ? text : text + ": " + advice;
}

bool RecordingFinding::is_mistake() const {
  switch (kind) {
    case FindingKind::kSign:
    case FindingKind::kFactor:
    case FindingKind::kSwapped:
    case FindingKind::kStranger:
      return true;
    case FindingKind::kLag:
      return channel.empty();
    case FindingKind::kDroppedSamples:
    case FindingKind::kUnevenClock:
    case FindingKind::kSaturation:
    case FindingKind::kQuantization:
    case FindingKind::kMains:
    case FindingKind::kCopy:
      return false;
  }
  return false;
}

}  // namespace strut

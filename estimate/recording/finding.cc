#include "estimate/recording/finding.h"

namespace strut {

std::string RecordingFinding::describe() const {
  std::string text = run.empty() ? "" : run + ": ";
  if (!channel.empty()) text += channel + " ";
  text += what;
  return advice.empty() ? text : text + ": " + advice;
}

}  // namespace strut

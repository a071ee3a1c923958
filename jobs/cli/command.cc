#include "jobs/cli/command.h"

namespace strut {

const std::vector<ExitMeaning>& list_exit_meanings() {
  static const std::vector<ExitMeaning> meanings = {
      {"0", "done"},
      {"1", "completed; the result is negative"},
      {"2", "the input is invalid"},
      {"3", "the environment failed; files written so far are complete"},
      {"70", "a bug in strut; the message says what to report"},
      {"130, 143", "interrupted; files written so far are complete"},
  };
  return meanings;
}

}  // namespace strut

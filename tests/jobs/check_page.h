// Reports read by a browser.
#pragma once

#include <string>

#include "tests/support/run_shell.h"

namespace strut::test {

/// Fails unless the page is well formed, fetches nothing, and a browser draws `charts` charts and
/// says nothing against it (tests/jobs/check_page.py). Warns where there is no browser.
inline void check_page(const std::string& page, int charts) {
  const Outcome outcome =
      run_shell("/usr/bin/python3 " STRUT_SOURCE_DIR "/tests/jobs/check_page.py " + page + " " +
                std::to_string(charts));
  INFO(page << "\n" << outcome.messages);
  if (outcome.code == 77) {
    WARN("no Chromium: " << page << " was not drawn");
    return;
  }
  CHECK(outcome.code == 0);
}

}  // namespace strut::test

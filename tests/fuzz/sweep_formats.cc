// Files of runners in a sweep folder, beside its shards.
#include "io/store/claims.h"
#include "io/store/journal.h"
#include "sweep/folder.h"
#include "sweep/status.h"
#include "tests/fuzz/format.h"

namespace strut::fuzz {
namespace {

namespace fs = std::filesystem;

/// Returns the sweep whose subfolder holds `path`, opened once.
const Plan& open_plan(const SweepFolder& folder) {
  static const Plan plan = open_sweep_folder(folder);
  return plan;
}

void read_journal_file(const fs::path& path) {
  const SweepFolder folder{path.parent_path()};
  read_journal(path);
  read_status(folder, open_plan(folder));
}

void read_claims_folder(const fs::path& path) { list_claims(Folder(path.parent_path())); }

}  // namespace

std::vector<Format> list_sweep_formats() {
  const Dictionary journal = {true,
                              {"file=", "shards/000000.h5", "shards/999999999999.h5", "../../x",
                               "cases=", "failures=", "diverged:3", "digest=", "%3A", "%00", "%1b",
                               "check=", "duplicate=1", " ", "\n", "time="},
                              {"%25", "a:1,"}};
  const Dictionary claim = {true,
                            {"host", "pid", "boot", "start", "counter", "=", " ", "\n", "..", "/",
                             "~", "runner.", std::string(1, '\0')},
                            {}};
  return {
      {"journal", "sweep/journal", {"sweep/journal.seed"}, journal, read_journal_file},
      {"claim", "sweep/claims/000001", {"sweep/claim.seed"}, claim, read_claims_folder},
      {"runner", "sweep/claims/runner.host.1.ab", {"sweep/runner.seed"}, claim, read_claims_folder},
  };
}

}  // namespace strut::fuzz

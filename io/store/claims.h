// Assigns units of work (shards) to runners, by files that need neither file locks nor a common
// clock.
//
// A runner proves that it is alive by a counter in `claims/runner.NAME`, which a thread increments
// at every heartbeat. A claim is a file `claims/UNIT` that names its runner; it is made by link(2),
// so that exactly one runner wins. A claim is stale if its runner's process is dead (decided by
// process number and start time, on the same host, boot and namespace only), if its runner's file
// is missing, or if the counter did not change for a whole lease of the reader's own monotonic
// clock. No wall clock and no file time is ever read. In rare races, taking over a stale claim may
// let two runners do the same shard: harmless, since a published shard is never replaced; such
// duplicates are counted.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/file/folder.h"

namespace strut {

struct ClaimOptions {
  std::chrono::milliseconds heartbeat{1000};
  std::chrono::milliseconds lease{30000};  // a runner is dead if its counter stalls this long
  /// Work done on the units that are held, which others read in ClaimInfo; called by the
  /// heartbeat's thread. May be empty.
  std::function<std::uint64_t()> count_work = {};
};

struct ClaimInfo {
  std::string unit;
  std::string runner;      // HOST.PID.NONCE
  std::uint64_t work = 0;  // of the runner, on all units that it holds, at its last heartbeat
};

class Claims {
 public:
  /// Starts the heartbeat of this process in `folder`, on a thread that takes no signals and that a
  /// full disk does not end; removes the files of dead runners of this host. Throws
  /// EnvironmentError; InputError if a link or pipe stands in place of a claim.
  Claims(const Folder& folder, const ClaimOptions& options);
  /// Stops the heartbeat and releases all claims.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// Returns the name of this runner, HOST.PID.NONCE.
  const std::string& runner() const;

  enum class Answer { kMine, kTaken };
  /// Claims `unit`, taking over a stale claim. Never blocks for the lease: if the process of a
  /// claim is not known to be dead, the counter is noted, and the answer is kTaken until the
  /// counter has not changed for a lease between two calls. A unit that this object holds is
  /// kTaken. Throws EnvironmentError, and std::invalid_argument if the name is "", contains '/' or
  /// '~', or starts with ".", "runner." or "new.". All methods may be called from any thread.
  Answer claim(const std::string& unit);
  /// Releases a claim, unless another runner took it over. A claim that cannot be removed is stale
  /// once this process ends.
  void release(const std::string& unit);

  /// Returns false if the runner of that name is dead: it ended normally, its process ended, or, if
  /// its process cannot be observed from here, its counter did not change for a lease between two
  /// calls. Its files in tmp/ may then be removed.
  bool may_be_alive(const std::string& runner);

  /// Returns whether a name has the form of a runner's, HOST.PID.NONCE.
  static bool is_runner_name(const std::string& name);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Lists the claims in `folder` whose runners may be alive, judged once, for status; changes
/// nothing. Throws EnvironmentError; InputError if a link or pipe stands in place of a claim.
std::vector<ClaimInfo> list_claims(const Folder& folder);

}  // namespace strut

// Who works on which shard: files that need no locks of the file system and no common clock.
//
// A runner shows that it lives by a counter in `claims/runner.NAME`, which a thread of its own
// raises every heartbeat. A claim is a file `claims/UNIT` that names its runner, made by link(2),
// so that one of many wins. A claim is stale when its runner's process is gone (told by its number
// only on the same host, boot and namespace of process ids, and with the same start time), when its
// runner's file is gone, or when the counter stood still for a whole lease by the reader's own
// monotonic clock. No wall clock and no time of a file is ever read. Taking a stale claim over may,
// in rare races, let two runners do the same shard: harmless, since a published shard is never
// replaced, and counted.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "io/file/folder.h"

namespace strut {

struct ClaimOptions {
  std::chrono::milliseconds heartbeat{1000};
  std::chrono::milliseconds lease{30000};  // a counter that stands still that long is a dead runner
};

struct ClaimInfo {
  std::string unit;
  std::string runner;  // HOST.PID.NONCE
};

class Claims {
 public:
  /// Starts the heartbeat of this process in `folder`, by a thread that takes no signals and that a
  /// full disk does not end; removes what killed runners of this host left of themselves. Throws
  /// EnvironmentError; InputError where a link or pipe stands in a claim's place.
  Claims(const Folder& folder, const ClaimOptions& options);
  /// Stops the heartbeat and gives back all claims.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// HOST.PID.NONCE
  const std::string& runner() const;

  enum class Answer { kMine, kTaken };
  /// Claims `unit`, taking over a stale claim. Never blocks for the lease: of a claim whose process
  /// is not known to be gone it notes the counter and answers kTaken until that stood still for the
  /// lease between two calls. A unit that this object holds is kTaken. Throws EnvironmentError; and
  /// std::invalid_argument where the name is "", has '/' or '~', or starts with ".", "runner." or
  /// "new.". All may be called from any thread.
  Answer claim(const std::string& unit);
  /// Does nothing to a claim that another runner took over. What cannot be removed is stale once
  /// this process ends.
  void release(const std::string& unit);

  /// False where the runner of that name is gone: it ended properly, or its process ended, or,
  /// where its process cannot be seen from here, its counter stood still for a lease between two
  /// calls. To collect what it left in tmp/.
  bool may_live(const std::string& runner);

  /// Whether a name is HOST.PID.NONCE, as runners are named.
  static bool is_runner_name(const std::string& name);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The claims in `folder` whose runners may live at one look, for status; stands beside, changes
/// nothing. Throws EnvironmentError; InputError where a link or pipe stands in a claim's place.
std::vector<ClaimInfo> list_claims(const Folder& folder);

}  // namespace strut

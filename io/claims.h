// Who works on which shard: files that need no locks of the file system and no common clock.
//
// A runner shows that it lives by a counter in `claims/runner.NAME`, which a thread of its own raises
// every heartbeat. A claim is a file `claims/UNIT` that names its runner, made by link(2), so that
// one of many wins. A claim is stale when its runner's process is gone (same host and boot), or when
// its counter stood still for a whole lease by the reader's own monotonic clock. Taking a stale claim
// over may, in rare races, let two runners do the same shard: harmless, since a published shard is
// never replaced, and counted.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

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
  /// Starts the heartbeat of this process in `folder`. Throws EnvironmentError.
  Claims(const std::filesystem::path& folder, const ClaimOptions& options);
  /// Gives back all claims and stops the heartbeat.
  ~Claims();
  Claims(const Claims&) = delete;
  Claims& operator=(const Claims&) = delete;

  /// HOST.PID.NONCE
  const std::string& runner() const;

  enum class Answer { kMine, kTaken };
  /// Claims `unit`, taking over a stale claim. Never blocks for the lease: of a foreign host's claim
  /// it notes the counter and answers kTaken until the lease has passed between two calls. Throws
  /// EnvironmentError.
  Answer claim(const std::string& unit);
  void release(const std::string& unit);

  /// False where the runner of that name is surely gone; used to collect what it left in tmp/.
  bool may_live(const std::string& runner);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The claims in `folder` whose runners may live, for status; stands beside, changes nothing.
std::vector<ClaimInfo> list_claims(const std::filesystem::path& folder);

}  // namespace strut

#include "io/store/claims.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

#include "base/text/parse_number.h"
#include "io/file/process_identity.h"
#include "io/file/sha256.h"
#include "io/file/temporary_file.h"
#include "io/store/heartbeat.h"

namespace strut {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kRunnerPrefix = "runner.";
constexpr std::string_view kNewPrefix = "new.";
constexpr char kTakeoverMark = '~';
constexpr std::size_t kNonceDigits = 16;
constexpr char kHexDigits[] = "0123456789abcdef";

std::string calc_nonce() {
  std::array<unsigned char, kNonceDigits / 2> bytes{};
  if (::getentropy(bytes.data(), bytes.size()) != 0) {
    throw file_failure("claims", "random numbers are not available", errno);
  }
  return to_hex(bytes);
}

// Returns the end of HOST.PID.NONCE; for any other text, one that a file name can contain.
std::string get_nonce(const std::string& runner) {
  const std::string nonce = runner.substr(runner.rfind('.') + 1);
  const bool is_plain = nonce.find_first_not_of(kHexDigits) == std::string::npos;
  return is_plain ? nonce : "unknown";
}

bool is_unit_name(const std::string& name) {
  return !name.empty() && name.find_first_of("/~") == std::string::npos &&
         !name.starts_with(kRunnerPrefix) && !name.starts_with(kNewPrefix) && name[0] != '.';
}

// Parts of HOST.PID.NONCE.
struct RunnerName {
  std::string host;
  std::string process;
};

std::optional<RunnerName> parse_runner_name(const std::string& runner) {
  const auto nonce = runner.rfind('.');
  const auto process =
      nonce == std::string::npos || nonce == 0 ? std::string::npos : runner.rfind('.', nonce - 1);
  if (process == std::string::npos || process == 0) return std::nullopt;
  const bool is_nonce = runner.size() - nonce - 1 == kNonceDigits &&
                        runner.find_first_not_of(kHexDigits, nonce + 1) == std::string::npos;
  const std::string number = runner.substr(process + 1, nonce - process - 1);
  if (!is_nonce || parse_number<pid_t>(number).value_or(0) <= 0) return std::nullopt;
  return RunnerName{runner.substr(0, process), number};
}

std::string make_claim_text(const std::string& runner) { return runner + "\n"; }

// Returns the runner that a claim names; nullopt if there is no claim.
std::optional<std::string> read_holder(const Folder& folder, const std::string& claim) {
  const auto text = folder.read_if_present(claim);
  if (!text) return std::nullopt;
  return text->substr(0, text->find('\n'));
}

std::string get_runner_file(const std::string& runner) {
  return std::string(kRunnerPrefix) + runner;
}

std::optional<RunnerFile> read_runner(const Folder& folder, const std::string& runner) {
  if (!parse_runner_name(runner)) return std::nullopt;
  const auto text = folder.read_if_present(get_runner_file(runner));
  if (!text) return std::nullopt;
  return read_runner_text(*text);
}

}  // namespace

struct Claims::State {
  State(const Folder& claims_folder, const ClaimOptions& claim_options);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void remove_abandoned();
  bool is_abandoned(const std::string& file);
  bool is_abandoned_takeover(const std::string& file);
  bool is_abandoned_temporary(const std::string& file);
  struct Judgment {
    Liveness liveness;
    bool is_stalled;  // the counter did not change for a lease
  };
  Judgment judge(const std::string& runner);
  bool is_stalled(const std::string& runner, const std::string& text);
  bool acquire(const std::string& claim);
  bool take_over(const std::string& claim, const std::string& holder);
  void remove_own(const std::string& claim) const;
  TemporaryFile make_temporary(const std::string& target) const {
    return {folder, std::string(kNewPrefix) + name, folder, target};
  }

  Folder folder;
  ClaimOptions options;
  ProcessIdentity identity;
  std::string name;
  std::mutex mutex;
  std::set<std::string> held;

  struct Observation {
    std::string text;  // content of the runner's file
    Clock::time_point since;
  };
  std::map<std::string, Observation> observations;  // by runner
  std::optional<Heartbeat> heartbeat;
};

Claims::State::State(const Folder& claims_folder, const ClaimOptions& claim_options)
    : folder(claims_folder), options(claim_options), identity(find_own_identity()) {
  name = fmt::format("{}.{}.{}", identity.host, identity.process, calc_nonce());
  const std::string runner_file = get_runner_file(name);
  {
    TemporaryFile file = make_temporary(runner_file);
    const std::string text = write_runner_text(identity, 0, 0);
    file.write(text);
    // Otherwise a power cut may leave an empty file, whose runner only the lease would prove dead.
    file.flush_and_compare(std::as_bytes(std::span(text)));
    file.name_over();
  }
  remove_abandoned();
  heartbeat.emplace(folder, runner_file, identity, options.heartbeat, options.count_work);
}

Claims::State::~State() {
  heartbeat.reset();
  for (const std::string& unit : held) remove_own(unit);
  // Last: a claim without its runner's file counts as abandoned.
  folder.try_remove(get_runner_file(name));
}

// Removes the files of dead runners of this host: their own files first, after which their claims
// are stale for everybody, then temporary files and rights to take over.
void Claims::State::remove_abandoned() {
  for (const std::string& file : folder.list()) {
    if (file.starts_with(kRunnerPrefix)) {
      const auto content = read_runner(folder, file.substr(kRunnerPrefix.size()));
      if (content && check_liveness(content->identity, identity) == Liveness::kDead) {
        folder.try_remove(file);
      }
    }
  }
  for (const std::string& file : folder.list()) {
    if (is_abandoned(file)) folder.try_remove(file);
  }
}

bool Claims::State::is_abandoned(const std::string& file) {
  const std::size_t mark = file.find(kTakeoverMark);
  if (mark != std::string::npos && is_unit_name(file.substr(0, mark))) {
    return is_abandoned_takeover(file);
  }
  return file.starts_with(kNewPrefix) && is_abandoned_temporary(file);
}

// UNIT~NONCE
bool Claims::State::is_abandoned_takeover(const std::string& file) {
  const auto holder = read_holder(folder, file);
  return holder && judge(*holder).liveness == Liveness::kDead;
}

// new.RUNNER.NUMBER
bool Claims::State::is_abandoned_temporary(const std::string& file) {
  const std::string runner = file.substr(
      kNewPrefix.size(), file.rfind('.') - std::min(file.rfind('.'), kNewPrefix.size()));
  const auto parsed = parse_runner_name(runner);
  if (!parsed || runner == name || read_runner(folder, runner)) return false;
  const auto text = folder.read_if_present(file);
  if (!text) return false;
  // A claim before it got its name, whose runner has ended.
  if (*text == make_claim_text(runner)) return true;
  // A runner's file before it got its name, which may be about to happen.
  const RunnerFile content = read_runner_text(*text);
  if (!content.identity.start.empty()) {
    return check_liveness(content.identity, identity) == Liveness::kDead;
  }
  // Its runner was killed before it wrote its identity. A runner that is about to write it, in a
  // container that shares this host's name, loses its file, reports that and ends.
  return parsed->host == identity.host && !is_process_number_taken(parsed->process);
}

// A runner makes its file first and removes it last: without a file the runner is dead.
Claims::State::Judgment Claims::State::judge(const std::string& runner) {
  const auto content = read_runner(folder, runner);
  if (!content) return {Liveness::kDead, true};
  return {check_liveness(content->identity, identity), is_stalled(runner, content->text)};
}

bool Claims::State::is_stalled(const std::string& runner, const std::string& text) {
  const Clock::time_point now = Clock::now();
  const auto [known, is_new] = observations.try_emplace(runner, Observation{text, now});
  if (is_new || known->second.text != text) {
    known->second = {text, now};
    return false;
  }
  return now - known->second.since >= options.lease;
}

bool Claims::State::acquire(const std::string& claim) {
  {
    TemporaryFile file = make_temporary(claim);
    file.write(make_claim_text(name));
    if (file.name_new()) return true;
  }
  const auto holder = read_holder(folder, claim);
  if (!holder) return false;         // released just now
  if (*holder == name) return true;  // link(2) succeeded, though it reported an error
  const Judgment judgment = judge(*holder);
  const bool stale = judgment.liveness == Liveness::kDead || judgment.is_stalled;
  return stale && take_over(claim, *holder);
}

// If several runners find the claim of `holder` stale, only the runner that holds the claim
// "CLAIM~NONCE", NONCE of the holder, may replace it. That right is an ordinary claim, which can be
// taken over itself. A runner that gets it later finds another holder and leaves the claim alone.
bool Claims::State::take_over(const std::string& claim, const std::string& holder) {
  const std::string right = claim + kTakeoverMark + get_nonce(holder);
  if (!acquire(right)) return false;
  const bool unchanged = read_holder(folder, claim) == holder;
  if (unchanged) {
    try {
      TemporaryFile file = make_temporary(claim);
      file.write(make_claim_text(name));
      file.name_over();
    } catch (const EnvironmentError&) {
      remove_own(right);
      throw;
    }
  }
  remove_own(right);
  return unchanged;
}

// Removes a claim unless another runner considered this one dead and holds the claim now. A claim
// that cannot be removed is stale once this process ends.
void Claims::State::remove_own(const std::string& claim) const {
  try {
    if (read_holder(folder, claim) == name) folder.try_remove(claim);
  } catch (const std::runtime_error&) {
  }
}

Claims::Claims(const Folder& folder, const ClaimOptions& options)
    : state_(std::make_unique<State>(folder, options)) {}

Claims::~Claims() = default;

const std::string& Claims::runner() const { return state_->name; }

Claims::Answer Claims::claim(const std::string& unit) {
  if (!is_unit_name(unit)) {
    throw std::invalid_argument(fmt::format("Claims: '{}' is not the name of a unit", unit));
  }
  const std::lock_guard lock(state_->mutex);
  if (state_->held.contains(unit) || !state_->acquire(unit)) return Answer::kTaken;
  state_->held.insert(unit);
  return Answer::kMine;
}

void Claims::release(const std::string& unit) {
  const std::lock_guard lock(state_->mutex);
  if (state_->held.erase(unit) > 0) state_->remove_own(unit);
}

bool Claims::may_be_alive(const std::string& runner) {
  const std::lock_guard lock(state_->mutex);
  if (runner == state_->name) return true;
  const State::Judgment judgment = state_->judge(runner);
  return judgment.liveness == Liveness::kAlive ||
         (judgment.liveness == Liveness::kUnknown && !judgment.is_stalled);
}

bool Claims::is_runner_name(const std::string& name) { return parse_runner_name(name).has_value(); }

std::vector<ClaimInfo> list_claims(const Folder& folder) {
  const ProcessIdentity own = find_own_identity();
  std::vector<ClaimInfo> claims;
  const std::vector<std::string> names = folder.list();
  claims.reserve(names.size());
  for (const std::string& unit : names) {
    if (!is_unit_name(unit)) continue;
    const auto holder = read_holder(folder, unit);
    const auto runner = holder ? read_runner(folder, *holder) : std::nullopt;
    if (runner && check_liveness(runner->identity, own) != Liveness::kDead) {
      claims.push_back({unit, *holder, runner->work});
    }
  }
  return claims;
}

}  // namespace strut

#include "io/store/claims.h"

#include <fcntl.h>
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
#include "io/file/temporary_file.h"
#include "io/store/heartbeat.h"

namespace strut {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kRunnerPrefix = "runner.";
constexpr std::string_view kNewPrefix = "new.";
constexpr char kTakeoverMark = '~';
constexpr std::size_t kNonceDigits = 16;

std::string calc_nonce() {
  std::array<unsigned char, kNonceDigits / 2> bytes{};
  if (::getentropy(bytes.data(), bytes.size()) != 0) {
    throw file_failure("claims", "no random numbers", errno);
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string nonce;
  for (const unsigned char byte : bytes) nonce += {kDigits[byte >> 4], kDigits[byte & 15]};
  return nonce;
}

// The end of HOST.PID.NONCE; of a text that is no such name, something that a file name can hold.
std::string get_nonce(const std::string& runner) {
  const std::string nonce = runner.substr(runner.rfind('.') + 1);
  const bool is_plain = nonce.find_first_not_of("0123456789abcdef") == std::string::npos;
  return is_plain ? nonce : "unknown";
}

bool is_unit_name(const std::string& name) {
  return !name.empty() && name.find_first_of("/~") == std::string::npos &&
         !name.starts_with(kRunnerPrefix) && !name.starts_with(kNewPrefix) && name[0] != '.';
}

// HOST.PID.NONCE, taken apart.
struct RunnerName {
  std::string host;
  std::string process;
};

std::optional<RunnerName> parse_runner_name(const std::string& runner) {
  const auto nonce = runner.rfind('.');
  const auto process =
      nonce == std::string::npos || nonce == 0 ? std::string::npos : runner.rfind('.', nonce - 1);
  if (process == std::string::npos || process == 0) return std::nullopt;
  const bool is_nonce =
      runner.size() - nonce - 1 == kNonceDigits &&
      runner.find_first_not_of("0123456789abcdef", nonce + 1) == std::string::npos;
  const std::string number = runner.substr(process + 1, nonce - process - 1);
  if (!is_nonce || parse_number<pid_t>(number).value_or(0) <= 0) return std::nullopt;
  return RunnerName{runner.substr(0, process), number};
}

// The runner that a claim names; nullopt: there is no claim.
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

  void collect();
  bool is_abandoned_file(const std::string& file);
  struct Judgment {
    Life life;
    bool stands_still;  // for a lease
  };
  Judgment judge(const std::string& runner);
  bool stands_still(const std::string& runner, const std::string& text);
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

  struct Seen {
    std::string text;
    Clock::time_point since;
  };
  std::map<std::string, Seen> seen;  // by runner: what its file said, and since when
  std::optional<Heartbeat> heartbeat;
};

Claims::State::State(const Folder& claims_folder, const ClaimOptions& claim_options)
    : folder(claims_folder), options(claim_options), identity(find_own_identity()) {
  name = identity.host + "." + identity.process + "." + calc_nonce();
  const std::string runner_file = get_runner_file(name);
  {
    TemporaryFile file = make_temporary(runner_file);
    const std::string text = write_runner_text(identity, 0);
    file.write(text);
    // Else a power cut may leave an empty file, of which only the lease tells that nobody lives.
    file.flush_and_compare(std::as_bytes(std::span(text)));
    file.name_over();
  }
  collect();
  heartbeat.emplace(folder, runner_file, identity, options.heartbeat);
}

Claims::State::~State() {
  heartbeat.reset();
  for (const std::string& unit : held) remove_own(unit);
  // Last: a claim without its runner's file counts as abandoned.
  folder.try_remove(get_runner_file(name));
}

// Removes what killed runners of this host left: their own files, which leaves their claims without
// a runner for anybody to take, files on the way to a name, and rights to take over.
void Claims::State::collect() {
  for (const std::string& file : folder.list()) {
    if (file.starts_with(kRunnerPrefix)) {
      const auto content = read_runner(folder, file.substr(kRunnerPrefix.size()));
      if (content && judge_process(content->identity, identity) == Life::kGone) {
        folder.try_remove(file);
      }
    }
  }
  for (const std::string& file : folder.list()) {
    if (is_abandoned_file(file)) folder.try_remove(file);
  }
}

bool Claims::State::is_abandoned_file(const std::string& file) {
  if (file.find(kTakeoverMark) != std::string::npos &&
      is_unit_name(file.substr(0, file.find('~')))) {
    const auto holder = read_holder(folder, file);
    return holder && judge(*holder).life == Life::kGone;
  }
  if (!file.starts_with(kNewPrefix)) return false;
  // new.RUNNER.NUMBER
  const std::string runner = file.substr(
      kNewPrefix.size(), file.rfind('.') - std::min(file.rfind('.'), kNewPrefix.size()));
  const auto parsed = parse_runner_name(runner);
  if (!parsed || runner == name || read_runner(folder, runner)) return false;
  const auto text = folder.read_if_present(file);
  if (!text) return false;
  // A claim on the way to its name, and its runner has ended.
  if (*text == runner + "\n") return true;
  // A runner's file on the way to its name, perhaps right now.
  const RunnerFile content = read_runner_text(*text);
  if (!content.identity.start.empty()) {
    return judge_process(content.identity, identity) == Life::kGone;
  }
  // Killed before it could write who it is. A runner that is about to, in a container that shares
  // this host's name, loses its file, says so and ends.
  return parsed->host == identity.host && !is_process_number_taken(parsed->process);
}

// A runner makes its file first and removes it last: no file, no runner.
Claims::State::Judgment Claims::State::judge(const std::string& runner) {
  const auto content = read_runner(folder, runner);
  if (!content) return {Life::kGone, true};
  return {judge_process(content->identity, identity), stands_still(runner, content->text)};
}

bool Claims::State::stands_still(const std::string& runner, const std::string& text) {
  const Clock::time_point now = Clock::now();
  const auto [known, is_new] = seen.try_emplace(runner, Seen{text, now});
  if (is_new || known->second.text != text) {
    known->second = {text, now};
    return false;
  }
  return now - known->second.since >= options.lease;
}

bool Claims::State::acquire(const std::string& claim) {
  {
    TemporaryFile file = make_temporary(claim);
    file.write(name + "\n");
    if (file.name_new()) return true;
  }
  const auto holder = read_holder(folder, claim);
  if (!holder) return false;         // given back this moment
  if (*holder == name) return true;  // made, though the answer was an error
  const Judgment judgment = judge(*holder);
  const bool stale = judgment.life == Life::kGone || judgment.stands_still;
  return stale && take_over(claim, *holder);
}

// Of several that found the claim of `holder` stale one may replace it: the one that holds the
// claim "CLAIM~NONCE of the holder", an ordinary claim that can be taken over itself. Whoever gets
// it later finds another holder named and leaves it.
bool Claims::State::take_over(const std::string& claim, const std::string& holder) {
  const std::string right = claim + kTakeoverMark + get_nonce(holder);
  if (!acquire(right)) return false;
  const bool unchanged = read_holder(folder, claim) == holder;
  if (unchanged) {
    try {
      TemporaryFile file = make_temporary(claim);
      file.write(name + "\n");
      file.name_over();
    } catch (const EnvironmentError&) {
      remove_own(right);
      throw;
    }
  }
  remove_own(right);
  return unchanged;
}

// Not where another runner took us for dead and the claim is its own now. What cannot be removed is
// stale when this process ends.
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
  if (!is_unit_name(unit)) throw std::invalid_argument("Claims: '" + unit + "' is no unit's name");
  const std::lock_guard lock(state_->mutex);
  if (state_->held.contains(unit) || !state_->acquire(unit)) return Answer::kTaken;
  state_->held.insert(unit);
  return Answer::kMine;
}

void Claims::release(const std::string& unit) {
  const std::lock_guard lock(state_->mutex);
  if (state_->held.erase(unit) > 0) state_->remove_own(unit);
}

bool Claims::may_live(const std::string& runner) {
  const std::lock_guard lock(state_->mutex);
  if (runner == state_->name) return true;
  const State::Judgment judgment = state_->judge(runner);
  return judgment.life == Life::kRuns ||
         (judgment.life == Life::kUnknown && !judgment.stands_still);
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
    if (runner && judge_process(runner->identity, own) != Life::kGone) {
      claims.push_back({unit, *holder});
    }
  }
  return claims;
}

}  // namespace strut

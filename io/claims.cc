#include "io/claims.h"

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

#include "io/file_sync.h"
#include "io/heartbeat.h"
#include "io/process_identity.h"

namespace strut {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::string_view kRunnerPrefix = "runner.";
constexpr std::string_view kNewPrefix = "new.";
constexpr char kTakeoverMark = '~';

std::string calc_nonce() {
  std::array<unsigned char, 8> bytes{};
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

// The runner that a claim names; none: there is no claim.
std::optional<std::string> read_holder(const fs::path& claim) {
  const auto text = read_if_present(claim);
  if (!text) return std::nullopt;
  return text->substr(0, text->find('\n'));
}

fs::path get_runner_path(const fs::path& folder, const std::string& runner) {
  return folder / (std::string(kRunnerPrefix) + runner);
}

std::optional<RunnerFile> read_runner(const fs::path& folder, const std::string& runner) {
  if (runner.empty() || runner.find('/') != std::string::npos) return std::nullopt;
  const auto text = read_if_present(get_runner_path(folder, runner));
  if (!text) return std::nullopt;
  return read_runner_text(*text);
}

// A missing folder is an empty one.
std::vector<std::string> list_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    names.push_back(it->path().filename().string());
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw file_failure(folder, "cannot be listed", error.value());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

struct Claims::State {
  State(const fs::path& claims_folder, const ClaimOptions& claim_options);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void collect_runners() const;
  struct Judgment {
    Life life;
    bool stands_still;  // for a lease
  };
  Judgment judge(const std::string& runner);
  bool stands_still(const std::string& runner, const std::string& text);
  bool acquire(const fs::path& claim);
  bool take_over(const fs::path& claim, const std::string& holder);
  void remove_own(const fs::path& claim) const;

  fs::path folder;
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

Claims::State::State(const fs::path& claims_folder, const ClaimOptions& claim_options)
    : folder(claims_folder), options(claim_options), identity(find_own_identity()) {
  name = identity.host + "." + identity.process + "." + calc_nonce();
  const fs::path path = get_runner_path(folder, name);
  {
    TemporaryFile file(folder / (std::string(kNewPrefix) + name), path);
    const std::string text = write_runner_text(identity, 0);
    file.write(text);
    // Else a power cut may leave an empty file, of which only the lease tells that nobody lives.
    file.flush_and_compare(std::as_bytes(std::span(text)));
    file.name_over();
  }
  collect_runners();
  heartbeat.emplace(path, identity, options.heartbeat);
}

Claims::State::~State() {
  heartbeat.reset();
  for (const std::string& unit : held) remove_own(folder / unit);
  // Last: a claim without its runner's file counts as abandoned.
  ::unlink(get_runner_path(folder, name).c_str());
}

// What killed runners of this host left. Their claims then name nobody, and anybody takes them.
void Claims::State::collect_runners() const {
  const std::vector<std::string> names = list_names(folder);
  for (const std::string& file : names) {
    if (!file.starts_with(kRunnerPrefix)) continue;
    const std::string runner = file.substr(kRunnerPrefix.size());
    const auto content = read_runner(folder, runner);
    if (!content || judge_process(content->identity, identity) != Life::kGone) continue;
    const std::string left = std::string(kNewPrefix) + runner + ".";
    for (const std::string& other : names) {
      if (other.starts_with(left)) ::unlink((folder / other).c_str());
    }
    ::unlink((folder / file).c_str());
  }
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

bool Claims::State::acquire(const fs::path& claim) {
  {
    TemporaryFile file(folder / (std::string(kNewPrefix) + name), claim);
    file.write(name + "\n");
    if (file.name_new()) return true;
  }
  const auto holder = read_holder(claim);
  if (!holder) return false;         // given back this moment
  if (*holder == name) return true;  // made, though the answer was an error
  const Judgment judgment = judge(*holder);
  const bool stale = judgment.life == Life::kGone || judgment.stands_still;
  return stale && take_over(claim, *holder);
}

// Of several that found the claim of `holder` stale one may replace it: the one that holds the
// claim "CLAIM~NONCE of the holder", an ordinary claim that can be taken over itself. Whoever gets
// it later finds another holder named and leaves it.
bool Claims::State::take_over(const fs::path& claim, const std::string& holder) {
  const fs::path right = claim.string() + kTakeoverMark + get_nonce(holder);
  if (!acquire(right)) return false;
  const bool unchanged = read_holder(claim) == holder;
  if (unchanged) {
    try {
      TemporaryFile file(folder / (std::string(kNewPrefix) + name), claim);
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
void Claims::State::remove_own(const fs::path& claim) const {
  try {
    if (read_holder(claim) == name) ::unlink(claim.c_str());
  } catch (const EnvironmentError&) {
  }
}

Claims::Claims(const fs::path& folder, const ClaimOptions& options)
    : state_(std::make_unique<State>(folder, options)) {}

Claims::~Claims() = default;

const std::string& Claims::runner() const { return state_->name; }

Claims::Answer Claims::claim(const std::string& unit) {
  if (!is_unit_name(unit)) throw std::invalid_argument("Claims: '" + unit + "' is no unit's name");
  const std::lock_guard lock(state_->mutex);
  if (state_->held.contains(unit) || !state_->acquire(state_->folder / unit)) return Answer::kTaken;
  state_->held.insert(unit);
  return Answer::kMine;
}

void Claims::release(const std::string& unit) {
  const std::lock_guard lock(state_->mutex);
  if (state_->held.erase(unit) > 0) state_->remove_own(state_->folder / unit);
}

bool Claims::may_live(const std::string& runner) {
  const std::lock_guard lock(state_->mutex);
  if (runner == state_->name) return true;
  const State::Judgment judgment = state_->judge(runner);
  return judgment.life == Life::kRuns ||
         (judgment.life == Life::kUnknown && !judgment.stands_still);
}

std::vector<ClaimInfo> list_claims(const fs::path& folder) {
  const ProcessIdentity own = find_own_identity();
  std::vector<ClaimInfo> claims;
  const std::vector<std::string> names = list_names(folder);
  claims.reserve(names.size());
  for (const std::string& unit : names) {
    if (!is_unit_name(unit)) continue;
    const auto holder = read_holder(folder / unit);
    const auto runner = holder ? read_runner(folder, *holder) : std::nullopt;
    if (runner && judge_process(runner->identity, own) != Life::kGone) {
      claims.push_back({unit, *holder});
    }
  }
  return claims;
}

}  // namespace strut

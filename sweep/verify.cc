#include "sweep/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <map>

#include "base/error/input_error.h"
#include "base/math/permutation.h"
#include "io/format/named_texts.h"
#include "io/store/shard_layout.h"
#include "sweep/shard_store.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Stream of the random choice of cases to simulate again.
constexpr std::uint64_t kSampleStream = 0x7665726966790000;

bool same_columns(const std::vector<ColumnInfo>& a, const std::vector<ColumnInfo>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const ColumnInfo& x, const ColumnInfo& y) { return x.name == y.name; });
}

bool same_schema(const ShardSchema& a, const ShardSchema& b) {
  return same_columns(a.parameters, b.parameters) && same_columns(a.snapshot, b.snapshot) &&
         same_columns(a.history, b.history) && a.history_samples == b.history_samples;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool is_close(double a, double b, double tolerance) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= tolerance * std::max({1.0, std::abs(a), std::abs(b)});
}

/// True if status, event time, snapshot and histories of row `a` of `x` and row `b` of `y` agree to
/// `tolerance`, relative or, below 1, absolute.
bool is_close(const ShardRows& x, std::size_t a, const ShardRows& y, std::size_t b,
              double tolerance) {
  const auto close = [&](double p, double q) { return is_close(p, q, tolerance); };
  const auto close_rows = [&](const std::vector<double>& u, const std::vector<double>& v) {
    const std::size_t columns = u.size() / x.size();
    const auto of_x = u.begin() + static_cast<std::ptrdiff_t>(a * columns);
    const auto of_y = v.begin() + static_cast<std::ptrdiff_t>(b * columns);
    return std::equal(of_x, of_x + static_cast<std::ptrdiff_t>(columns), of_y, close);
  };
  bool all = x.status[a] == y.status[b] && close(x.event_time[a], y.event_time[b]) &&
             close_rows(x.snapshot, y.snapshot);
  for (std::size_t h = 0; h < x.history.size(); ++h) {
    all = all && close_rows(x.history[h], y.history[h]);
  }
  return all;
}

/// A sweep folder and what its plan and its journal say about it.
struct VerifyInput {
  const SweepFolder& folder;
  const Plan& plan;
  const ShardSchema schema;
  const SweepExtent extent;
  const ShardRecords records;
};

void add_damage(const VerifyInput& input, const fs::path& file, const std::string& error,
                VerifyReport& report) {
  // A reader's message starts with the file's path.
  const std::string path = file.string() + ": ";
  const std::size_t skipped = error.rfind(path, 0) == 0 ? path.size() : 0;
  report.damaged.push_back(input.folder.name_of(file) + ": " + error.substr(skipped));
}

// --- shards ----------------------------------------------------------------------------------

/// Reads a file once and checks its seal against its bytes. Throws InputError if it is damaged,
/// without the remedy, which `strut verify` states once for all files.
SealedBytes read_checked(const fs::path& file) {
  try {
    return read_sealed(file, kShardSeal);
  } catch (const InputError&) {
    const SealCheck check = check_sealed_file(file, kShardSeal);
    if (!check.fault.empty()) throw InputError(file.string() + ": " + check.fault);
    throw;
  }
}

/// Checks plan, number and journal of one file; returns false, and reports the fault, if it does
/// not match.
bool check_seal_of(const VerifyInput& input, const fs::path& file, const SealedBytes& sealed,
                   std::int64_t shard, VerifyReport& report) {
  const std::string fault = input.records.find_fault(file, shard, make_shard_seal(sealed.seal));
  if (!fault.empty()) add_damage(input, file, fault, report);
  return fault.empty();
}

/// Checks the overlays of a shard. A damaged one is reported under its own name, not its shard's.
bool check_retries(const VerifyInput& input, std::int64_t shard, VerifyReport& report) {
  if (!input.records.has_retries(shard)) return true;
  for (int round = 0; round < count_retries(input.folder, shard); ++round) {
    const fs::path file = input.folder.retry(shard, round);
    try {
      if (!check_seal_of(input, file, read_checked(file), shard, report)) return false;
    } catch (const InputError& e) {
      add_damage(input, file, e.what(), report);
      return false;
    }
  }
  return true;
}

/// True if the parameters and the stratum of a row are those of the plan.
bool matches_plan(const VerifyInput& input, const ShardRows& rows, std::size_t row) {
  const std::size_t axes = input.schema.parameters.size();
  std::vector<double> planned(axes);
  input.plan.calc_parameters(rows.case_id[row], planned);
  return rows.layer[row] == input.plan.calc_stratum(rows.case_id[row]) &&
         std::equal(planned.begin(), planned.end(),
                    rows.parameters.begin() + static_cast<std::ptrdiff_t>(row * axes), same_bits);
}

/// Returns the number of valid rows; counts and reports the others.
std::int64_t check_rows(const VerifyInput& input, std::int64_t shard, const ShardRows& rows,
                        VerifyReport& report) {
  const auto [first, last] = input.plan.shard_range(shard);
  std::int64_t valid = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::int64_t position = first + static_cast<std::int64_t>(row);
    const std::int64_t id = rows.case_id[row];
    if (position < last && id == input.plan.calc_case_id(position)) {
      const bool is_valid = matches_plan(input, rows, row);
      ++(is_valid ? valid : report.foreign);
      report.failed += is_valid && rows.status[row] != 0 ? 1 : 0;
    } else {
      ++(input.plan.find_position(id) >= 0 ? report.misplaced : report.foreign);
    }
  }
  const std::int64_t wrong = static_cast<std::int64_t>(rows.size()) - valid;
  if (wrong > 0) {
    add_damage(input, input.folder.shard(shard),
               fmt::format("{} rows do not match the plan", wrong), report);
  }
  return valid;
}

/// Checks a shard with its overlays; returns the number of valid rows. Throws InputError if the
/// shard is damaged.
std::int64_t check_shard(const VerifyInput& input, std::int64_t shard, VerifyReport& report,
                         DataDigest& digest) {
  const fs::path file = input.folder.shard(shard);
  const bool planned = shard < input.plan.shard_count();
  const SealedBytes sealed = read_checked(file);
  if (!planned || !check_seal_of(input, file, sealed, shard, report)) {
    report.foreign += static_cast<std::int64_t>(read_shard(file, sealed).rows.size());
    if (!planned) add_damage(input, file, "the plan has no such shard", report);
    return 0;
  }
  if (!check_retries(input, shard, report)) return 0;
  Shard mended = read_shard(file, sealed);
  if (input.records.has_retries(shard)) apply_retries(input.folder, mended);
  ++report.shards;
  if (!same_schema(mended.schema, input.schema)) {
    add_damage(input, file, "its columns do not match the plan", report);
    return 0;
  }
  digest.add(calc_rows_digest(mended.rows));
  return check_rows(input, shard, mended.rows, report);
}

void check_all_shards(const VerifyInput& input, const std::function<void(std::int64_t)>& progress,
                      VerifyReport& report) {
  DataDigest digest;
  std::int64_t valid = 0;
  for (const std::int64_t shard : list_shards(input.folder)) {
    try {
      valid += check_shard(input, shard, report, digest);
    } catch (const InputError& e) {
      add_damage(input, input.folder.shard(shard), e.what(), report);
    }
    progress(valid);
  }
  report.missing = input.plan.case_count() - valid;
  report.data_digest = digest.text();
}

// --- other files -----------------------------------------------------------------------------

bool is_expected(const SweepFolder& folder, const fs::path& file) {
  const std::int64_t shard = std::strtoll(file.filename().c_str(), nullptr, 10);
  if (file == folder.shard(shard)) return true;
  for (int round = 0; round < count_retries(folder, shard); ++round) {
    if (file == folder.retry(shard, round)) return fs::exists(folder.shard(shard));
  }
  return false;
}

/// Reports every file in shards/ and retries/ that is not a shard or a retry of one.
void check_other_files(const VerifyInput& input, VerifyReport& report) {
  std::error_code error;
  for (const fs::path& folder : {input.folder.shards(), input.folder.retries()}) {
    for (fs::directory_iterator file(folder, error), end; !error && file != end;
         file.increment(error)) {
      if (is_expected(input.folder, file->path())) continue;
      add_damage(input, file->path(), "does not belong to this sweep", report);
    }
  }
}

// --- simulations -----------------------------------------------------------------------------

/// The kernel of the instruction set that a shard was simulated with; null if this machine lacks
/// it.
const Kernel* find_kernel(const Shard& shard) {
  const auto isa = find_text(shard.provenance.texts, kInstructionSetKey);
  for (const Kernel& kernel : list_kernels()) {
    if (isa == kernel.isa) return &kernel;
  }
  return nullptr;
}

/// Simulates a row of a shard again.
ShardRows simulate_row(const VerifyInput& input, const ShardRows& rows, std::size_t row,
                       const Kernel& kernel) {
  ShardRows again = ShardRows::make(input.schema, 1);
  CaseSimulator simulator(input.plan, kernel);
  const std::int64_t id = rows.case_id.at(row);
  if (rows.attempt[row] <= 1) {
    simulator.simulate(std::span(&id, 1), again, 0, std::atomic<bool>(false));
  } else {
    simulator.retry(id, rows.attempt[row], again, 0);
  }
  return again;
}

void compare_row(const VerifyInput& input, const VerifyOptions& options, const Shard& shard,
                 std::size_t row, VerifyReport& report) {
  const Kernel* const own = find_kernel(shard);
  const bool exact = own != nullptr;
  const ShardRows again = simulate_row(input, shard.rows, row, exact ? *own : *options.fallback);
  const bool same = exact ? calc_row_hash(again, 0) == calc_row_hash(shard.rows, row)
                          : is_close(again, 0, shard.rows, row, options.tolerance);
  ++report.resimulated;
  if (!exact) ++report.compared_by_tolerance;
  if (!same) report.differing.push_back(fmt::format("case {}", shard.rows.case_id[row]));
}

void simulate_again(const VerifyInput& input, const VerifyOptions& options, VerifyReport& report) {
  const std::int64_t cases = input.plan.case_count();
  const Permutation choice(cases, options.seed, kSampleStream);
  std::map<std::int64_t, std::vector<std::size_t>> rows_of;
  const std::int64_t per_shard = input.plan.shard_range(0).second;
  for (std::int64_t i = 0; i < std::min(options.sample, cases); ++i) {
    const std::int64_t position = choice.apply(i);
    rows_of[position / per_shard].push_back(static_cast<std::size_t>(position % per_shard));
  }
  for (const auto& [shard, rows] : rows_of) {
    try {
      const Shard mended = read_shard_with_retries(input.folder, input.extent, shard);
      for (const std::size_t row : rows) compare_row(input, options, mended, row, report);
    } catch (const InputError&) {
      // The shard is missing or damaged, which check_all_shards has reported.
    }
  }
}

}  // namespace

VerifyReport verify_sweep(const SweepFolder& folder, const Plan& plan, const VerifyOptions& options,
                          const std::function<void(std::int64_t)>& progress) {
  const VerifyInput input{folder, plan, plan.make_schema(), plan.make_extent(),
                          ShardRecords(folder, plan.make_extent())};
  VerifyReport report;
  report.cases = plan.case_count();
  check_all_shards(input, progress, report);
  check_other_files(input, report);
  if (options.sample > 0) simulate_again(input, options, report);
  return report;
}

}  // namespace strut

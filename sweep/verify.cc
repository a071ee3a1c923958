#include "sweep/verify.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>

#include "base/error/input_error.h"
#include "base/math/permutation.h"
#include "sweep/shard_store.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Two instruction sets agree to this, relative.
constexpr double kAcrossInstructionSets = 1e-9;
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

bool is_close(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return std::abs(a - b) <= kAcrossInstructionSets * std::max({1.0, std::abs(a), std::abs(b)});
}

/// Rows `a` and `b` of two sets agree, where not bit for bit then to kAcrossInstructionSets.
bool is_close(const ShardRows& x, std::size_t a, const ShardRows& y, std::size_t b) {
  const auto close_rows = [&](const std::vector<double>& u, const std::vector<double>& v) {
    const std::size_t columns = u.size() / x.size();
    const auto of_x = u.begin() + static_cast<std::ptrdiff_t>(a * columns);
    const auto of_y = v.begin() + static_cast<std::ptrdiff_t>(b * columns);
    return std::equal(of_x, of_x + static_cast<std::ptrdiff_t>(columns), of_y,
                      [](double p, double q) { return is_close(p, q); });
  };
  bool close = x.status[a] == y.status[b] && is_close(x.event_time[a], y.event_time[b]) &&
               close_rows(x.snapshot, y.snapshot);
  for (std::size_t h = 0; h < x.history.size(); ++h) {
    close = close && close_rows(x.history[h], y.history[h]);
  }
  return close;
}

class Verification {
 public:
  Verification(const SweepFolder& folder, const Plan& plan, const VerifyOptions& options)
      : folder_(folder),
        plan_(plan),
        options_(options),
        schema_(plan.make_schema()),
        extent_(plan.make_extent()),
        records_(folder, extent_) {
    report_.cases = plan.case_count();
  }

  VerifyReport run(const std::function<void(std::int64_t)>& progress) {
    std::int64_t sound = 0;
    for (const std::int64_t shard : list_shards(folder_)) {
      sound += check_shard(shard);
      progress(sound);
    }
    check_other_files();
    report_.missing = plan_.case_count() - sound;
    report_.data_digest = digest_.text();
    if (options_.sample > 0) simulate_again();
    return report_;
  }

 private:
  void add_damage(const fs::path& file, const std::string& what) {
    // A reader's message begins with the file's path.
    const std::string path = file.string() + ": ";
    const std::size_t skipped = what.rfind(path, 0) == 0 ? path.size() : 0;
    report_.damaged.push_back(folder_.name_of(file) + ": " + what.substr(skipped));
  }

  /// Bytes, plan, number and journal of one file; false, and told, where something is wrong.
  bool check_file(const fs::path& file, std::int64_t shard) {
    const SealCheck check = check_sealed_file(file, kShardSeal);
    if (!check.fault.empty()) throw InputError(file.string() + ": " + check.fault);
    const std::string fault = records_.find_fault(file, shard, make_shard_seal(check.seal));
    if (!fault.empty()) add_damage(file, fault);
    return fault.empty();
  }

  /// The same of an overlay: where its bytes are damaged, it is not its shard that is.
  bool check_retry(const fs::path& file, std::int64_t shard) {
    try {
      return check_file(file, shard);
    } catch (const InputError& e) {
      add_damage(file, e.what());
      return false;
    }
  }

  /// Returns the number of cases that are as the plan wants them.
  std::int64_t check_shard(std::int64_t shard) {
    const fs::path file = folder_.shard(shard);
    try {
      if (shard >= plan_.shard_count() || !check_file(file, shard)) {
        report_.foreign += static_cast<std::int64_t>(read_shard(file).rows.size());
        if (shard >= plan_.shard_count()) add_damage(file, "the plan has no such shard");
        return 0;
      }
      for (int round = 0; round < count_retries(folder_, shard); ++round) {
        if (!check_retry(folder_.retry(shard, round), shard)) return 0;
      }
      Shard mended = read_shard(file);
      apply_retries(folder_, mended);
      ++report_.shards;
      if (same_schema(mended.schema, schema_)) return check_rows(file, shard, mended.rows);
      add_damage(file, "its columns are not the plan's");
    } catch (const InputError& e) {
      add_damage(file, e.what());
    }
    return 0;
  }

  std::int64_t check_rows(const fs::path& file, std::int64_t shard, const ShardRows& rows) {
    const auto [first, last] = plan_.shard_range(shard);
    std::int64_t sound = 0, wrong = 0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::int64_t position = first + static_cast<std::int64_t>(row);
      if (position < last && rows.case_id[row] == plan_.calc_case_id(position)) {
        check_row(rows, row) ? ++sound : ++wrong;
      } else if (plan_.find_position(rows.case_id[row]) >= 0) {
        ++report_.twice;
      } else {
        ++report_.foreign;
      }
      digest_.add(calc_row_hash(rows, row));
    }
    report_.foreign += wrong;
    if (sound < static_cast<std::int64_t>(rows.size())) {
      add_damage(file, std::to_string(static_cast<std::int64_t>(rows.size()) - sound) +
                           " rows are not the plan's");
    }
    return sound;
  }

  /// Parameters and layer of a row against the plan.
  bool check_row(const ShardRows& rows, std::size_t row) const {
    const std::size_t axes = schema_.parameters.size();
    std::vector<double> planned(axes);
    plan_.calc_parameters(rows.case_id[row], planned);
    return rows.layer[row] == plan_.calc_layer(rows.case_id[row]) &&
           std::equal(planned.begin(), planned.end(),
                      rows.parameters.begin() + static_cast<std::ptrdiff_t>(row * axes), same_bits);
  }

  /// Everything in shards/ and retries/ that is no shard of any number.
  void check_other_files() {
    std::error_code error;
    for (const fs::path& place : {folder_.shards(), folder_.retries()}) {
      for (fs::directory_iterator file(place, error), end; !error && file != end;
           file.increment(error)) {
        if (!is_expected(file->path())) add_damage(file->path(), "no file of this sweep");
      }
    }
  }

  bool is_expected(const fs::path& file) const {
    const std::int64_t shard = std::strtoll(file.filename().c_str(), nullptr, 10);
    if (file == folder_.shard(shard)) return true;
    for (int round = 0; round < count_retries(folder_, shard); ++round) {
      if (file == folder_.retry(shard, round)) return fs::exists(folder_.shard(shard));
    }
    return false;
  }

  void simulate_again() {
    const Permutation choice(plan_.case_count(), options_.seed, kSampleStream);
    std::map<std::int64_t, std::vector<std::size_t>> rows_of;
    const std::int64_t per_shard = plan_.shard_range(0).second;
    for (std::int64_t i = 0; i < std::min(options_.sample, plan_.case_count()); ++i) {
      const std::int64_t position = choice.apply(i);
      rows_of[position / per_shard].push_back(static_cast<std::size_t>(position % per_shard));
    }
    for (const auto& [shard, rows] : rows_of) {
      try {
        const Shard mended = read_shard_with_retries(folder_, extent_, shard);
        for (const std::size_t row : rows) compare_case(mended, row);
      } catch (const InputError&) {
        // Missing or damaged, and told already.
      }
    }
  }

  void compare_case(const Shard& shard, std::size_t row) {
    const auto isa = std::find_if(shard.provenance.texts.begin(), shard.provenance.texts.end(),
                                  [](const auto& text) { return text.first == "instruction_set"; });
    const Kernel* kernel = options_.fallback;
    bool exact = false;
    for (const Kernel& known : list_kernels()) {
      if (isa != shard.provenance.texts.end() && isa->second == known.isa) {
        kernel = &known, exact = true;
      }
    }
    const ShardRows& rows = shard.rows;
    ShardRows again = ShardRows::make(schema_, 1);
    CaseSimulator simulator(plan_, *kernel);
    const std::int64_t id = rows.case_id.at(row);
    if (rows.attempt[row] <= 1) {
      simulator.simulate(std::span(&id, 1), again, 0, std::atomic<bool>(false));
    } else {
      simulator.retry(id, rows.attempt[row], again, 0);
    }
    const bool same =
        exact ? calc_row_hash(again, 0) == calc_row_hash(rows, row) : is_close(again, 0, rows, row);
    ++report_.resimulated;
    if (!exact) ++report_.compared_by_tolerance;
    if (!same) report_.differing.push_back("case " + std::to_string(id));
  }

  const SweepFolder& folder_;
  const Plan& plan_;
  const VerifyOptions& options_;
  const ShardSchema schema_;
  const SweepExtent extent_;
  const ShardRecords records_;
  DataDigest digest_;
  VerifyReport report_;
};

}  // namespace

VerifyReport verify_sweep(const SweepFolder& folder, const Plan& plan, const VerifyOptions& options,
                          const std::function<void(std::int64_t)>& progress) {
  return Verification(folder, plan, options).run(progress);
}

}  // namespace strut

// Measures whether the memory of training depends on the number of cases: writes shards of
// synthetic cases, trains on them with `strut train`, and prints times and peak memory.
//
//   stream_benchmark STRUT FOLDER [CASES [THREADS]]
//
// FOLDER needs about 200 bytes per case, for the shards and the trainer's copy of the rows. Exit
// code 1 if training needs 500 MB or more.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>

#include "base/math/random.h"
#include "base/parallel/team.h"
#include "io/store/shard.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kShardCases = 50'000;
constexpr double kMemoryLimit = 500e6;  // bytes
constexpr std::size_t kParameters = 4;

using Row = std::array<double, kParameters>;

/// A smooth, well-conditioned map of [-1, 1]^4 with a curvature of a tenth, like states over
/// parameters.
Row calc_states(const Row& p) {
  const double bend = p[0] * p[1] + 0.5 * p[2] * p[2] - 0.3 * p[3] * p[0];
  return {p[0] + 0.3 * p[1] - 0.2 * p[2] + 0.1 * bend, p[1] - 0.4 * p[3] + 0.1 * p[0] * p[2],
          p[2] + 0.2 * p[0] + 0.1 * p[1] * p[3], p[3] - 0.3 * p[2] + 0.1 * bend};
}

ShardSchema make_schema() {
  ShardSchema schema;
  for (const char* name : {"front_stiffness", "front_damping", "rear_stiffness", "rear_damping"}) {
    schema.parameters.push_back({name, "1", "synthetic, -1 to 1"});
  }
  for (const char* name :
       {"body_position_z", "body_velocity_z", "body_acceleration_z", "pitch_angle"}) {
    schema.snapshot.push_back({name, "1", "synthetic"});
  }
  schema.status_meaning = "0 done";
  return schema;
}

ShardRows make_rows(const ShardSchema& schema, std::int64_t first, std::int64_t count) {
  ShardRows rows = ShardRows::make(schema, static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows.case_id[i] = first + static_cast<std::int64_t>(i);
    rows.event_time[i] = 0.6;
    Row p;
    for (std::size_t k = 0; k < kParameters; ++k) {
      const auto counter = static_cast<std::uint64_t>(rows.case_id[i]) * kParameters + k;
      p[k] = 2.0 * calc_uniform(1, 0, counter) - 1.0;
    }
    const Row x = calc_states(p);
    std::copy(p.begin(), p.end(), rows.parameters.begin() + static_cast<long>(i * kParameters));
    std::copy(x.begin(), x.end(), rows.snapshot.begin() + static_cast<long>(i * kParameters));
  }
  return rows;
}

fs::path make_path(const fs::path& folder, std::int64_t shard) {
  return folder / (std::to_string(shard) + ".h5");
}

void write_shards(const fs::path& folder, std::int64_t cases, int threads) {
  const ShardSchema schema = make_schema();
  const std::string plan_hash(64, '0');
  const std::int64_t shards = (cases + kShardCases - 1) / kShardCases;
  fs::create_directories(folder);
  // Remove shards of an earlier, longer run.
  for (std::int64_t old = shards; fs::remove(make_path(folder, old)); ++old) continue;
  std::mutex library;  // the HDF5 library is not thread-safe
  share_items(threads, static_cast<std::size_t>(shards), [&](std::size_t item, int) {
    const auto shard = static_cast<std::int64_t>(item);
    const std::int64_t first = shard * kShardCases;
    const CompressedShard data =
        compress_shard(schema, make_rows(schema, first, std::min(kShardCases, cases - first)));
    const std::lock_guard lock(library);
    const std::vector<std::byte> image = make_shard_image(data, {plan_hash, shard, {}});
    std::ofstream file(make_path(folder, shard), std::ios::binary);
    file.write(reinterpret_cast<const char*>(image.data()),
               static_cast<std::streamsize>(image.size()));
    if (!file.flush()) throw EnvironmentError(folder.string() + ": cannot be written");
  });
}

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

/// Trains and prints time and peak memory; returns true if the memory stayed below the limit.
bool train(const std::string& program, const fs::path& folder, const std::string& options) {
  const double begin = now();
  const std::string command = program + " train " + (folder / "*.h5").string() + " -o " +
                              (folder / "model").string() + " --force " + options;
  std::printf("\n%s\n", options.c_str());
  std::fflush(stdout);
  if (std::system(command.c_str()) != 0) return false;
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);  // the maximum of all children so far
  const double memory = 1024.0 * static_cast<double>(usage.ru_maxrss);
  std::printf("%.1f s, at most %.0f MB\n", now() - begin, memory / 1e6);
  return memory < kMemoryLimit;
}

}  // namespace
}  // namespace strut

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: stream_benchmark STRUT FOLDER [CASES [THREADS]]\n");
    return 2;
  }
  const std::string program = argv[1];
  const std::filesystem::path folder = argv[2];
  const std::int64_t cases = argc > 3 ? std::atoll(argv[3]) : 10'000'000;
  const int threads = argc > 4 ? std::atoi(argv[4]) : 2;
  const double begin = strut::now();
  strut::write_shards(folder, cases, threads);
  std::printf("%lld cases written in %.1f s\n", static_cast<long long>(cases),
              strut::now() - begin);
  const std::string same = " --hidden 27,19,11 --threads " + std::to_string(threads);
  bool ok = strut::train(program, folder, "--gram-rows 20000 --epochs 8" + same);
  ok = strut::train(program, folder, "--growing --epochs 25" + same) && ok;
  ok = strut::train(program, folder, "--epochs 1" + same) && ok;
  return ok ? 0 : 1;
}

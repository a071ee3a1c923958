#include "jobs/run/print.h"

#include <fmt/format.h>

#include <cmath>
#include <iostream>

#include "jobs/cli/clock.h"
#include "jobs/cli/progress.h"

namespace strut {

std::string describe_progress(const RunProgress& progress, double start) {
  const std::int64_t done = progress.elsewhere + progress.simulated;
  const std::int64_t reached = progress.present + done;
  const double rate = static_cast<double>(done) / (now() - start);
  std::string line =
      fmt::format("{}/{} cases", format_count(reached), format_count(progress.cases));
  if (reached < progress.cases) {
    const double remaining = static_cast<double>(progress.cases - reached) / rate;
    line += fmt::format(", {}/s, {} to go", format_count(std::llround(rate)),
                        format_duration(remaining));
  }
  if (progress.failed > 0) line += fmt::format(", {} failed", format_count(progress.failed));
  if (progress.retried > 0) line += fmt::format(", {} retried", format_count(progress.retried));
  return line;
}

Json make_json(const RunProgress& progress, const RunSummary& summary, double seconds) {
  Json damaged = Json::array();
  for (const auto& [shard, what] : summary.damaged) damaged.push_back(what);
  Json parts = Json::object();
  parts["prepare"] = summary.simulation.prepare;
  parts["integrate"] = summary.simulation.integrate;
  parts["retry"] = summary.simulation.retry;
  parts["compress"] = summary.compress;
  parts["write"] = summary.write;
  Json json = Json::object();
  json["cases"] = progress.cases.load();
  json["present"] = progress.present.load();
  json["written"] = progress.written.load();
  json["elsewhere"] = progress.elsewhere.load();
  json["failed"] = summary.failed;
  json["mended"] = summary.mended;
  json["still_failing"] = summary.still_failing;
  json["duplicates"] = summary.duplicates;
  json["shards"] = summary.shards_written;
  json["bytes"] = summary.bytes;
  json["seconds"] = seconds;
  json["runs_per_s"] = static_cast<double>(progress.written) / seconds;
  json["thread_seconds"] = parts;
  json["damaged"] = damaged;
  json["interrupted"] = summary.stopped;
  return json;
}

void print_summary(const OpenSweep& sweep, const RunProgress& progress, const RunSummary& summary,
                   double seconds) {
  const std::int64_t present = progress.present + progress.elsewhere;
  const double rate = static_cast<double>(progress.written) / seconds;
  std::cout << fmt::format("{} simulated in {} ({}/s)", format_count(progress.written, "case"),
                           format_duration(seconds), format_count(std::llround(rate)));
  if (present > 0) std::cout << fmt::format(", {} were there already", format_count(present));
  std::cout << fmt::format("; {} failed in all\n", format_count(summary.failed));
  const std::int64_t dropped = progress.simulated - progress.written;
  if (dropped > 0) {
    std::cout << fmt::format("{} cases of unfinished shards are dropped\n", format_count(dropped));
  }
  if (summary.mended + summary.still_failing > 0) {
    std::cout << fmt::format("retried: {} succeeded, {} still fail\n", format_count(summary.mended),
                             format_count(summary.still_failing));
  }
  if (summary.duplicates > 0) {
    std::cout << fmt::format("{} shards were made twice, by two runners; one copy is kept\n",
                             summary.duplicates);
  }
  std::cout << fmt::format("data: {} ({}, {} new)\n", sweep.folder.shards().string(),
                           format_count(summary.shards_written, "shard"),
                           format_bytes(static_cast<double>(summary.bytes)));
}

}  // namespace strut

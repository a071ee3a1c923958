// Slurm, by its own commands: no library of one version, no accounting database.
#pragma once

#include <optional>

#include "cluster/dispatcher.h"

namespace strut {

class SlurmDispatcher : public Dispatcher {
 public:
  /// Its commands are in PATH.
  static bool is_there();

  std::string name() const override { return "slurm"; }
  std::string find_place() const override;
  SiteLimits check(const Resources& resources, const std::filesystem::path& folder) const override;
  Findings examine(const Resources& resources, const std::filesystem::path& folder) const override;
  std::vector<NodeAnswer> ask_nodes(const Resources& resources) const override;
  std::string make_script(const TaskArray& tasks) const override;
  std::vector<std::string> make_command(const TaskArray& tasks, const std::filesystem::path& script,
                                        const std::vector<std::string>& after) const override;
  std::string try_tasks(const TaskArray& tasks) const override;
  std::string submit(const TaskArray& tasks, const std::filesystem::path& script,
                     const std::vector<std::string>& after) const override;
  std::string find_job(const JobRecord& record) const override;
  QueueAnswer query(const std::vector<JobRecord>& jobs) const override;
  void cancel(const std::vector<JobRecord>& jobs) const override;
  bool requeue_own() const override;
  std::int64_t find_own_end() const override;
  int count_own_restarts() const override;
};

/// "2-03:04:05", "03:04:05", "04:05", "5" (minutes), "infinite", as Slurm writes durations [s].
/// Nothing where it is none.
std::optional<double> parse_slurm_time(const std::string& text);
/// To the next minute, as Slurm counts: "1-02:30:00".
std::string format_slurm_time(double seconds);

}  // namespace strut

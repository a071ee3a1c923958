// Slurm, through its commands: independent of library versions and of an accounting database.
#pragma once

#include <optional>

#include "cluster/dispatcher.h"

namespace strut {

class SlurmDispatcher : public Dispatcher {
 public:
  /// Why `sbatch` does not answer: "sbatch: command not found"; empty: it does.
  static std::string find_fault();

  static constexpr const char* kName = "slurm";
  std::string name() const override { return kName; }
  std::string find_cluster_name() const override;
  SiteLimits check(const Resources& resources, const std::filesystem::path& folder) const override;
  Findings examine(const Resources& resources, const std::filesystem::path& folder) const override;
  std::vector<NodeInstructionSets> list_node_instruction_sets(
      const Resources& resources) const override;
  std::string make_script(const TaskArray& tasks) const override;
  std::vector<std::string> make_command(const TaskArray& tasks, const std::filesystem::path& script,
                                        const std::vector<std::string>& after) const override;
  std::string dry_run(const TaskArray& tasks) const override;
  std::string submit(const TaskArray& tasks, const std::filesystem::path& script,
                     const std::vector<std::string>& after) const override;
  std::string find_job(const JobRecord& record) const override;
  QueueAnswer query(const std::vector<JobRecord>& jobs) const override;
  void cancel(const std::vector<JobRecord>& jobs) const override;
  bool requeue_own() const override;
  std::int64_t find_own_deadline() const override;
  int count_own_restarts() const override;
};

/// Parses a duration as Slurm writes it, "2-03:04:05", "03:04:05", "04:05", "5" (minutes) or
/// "infinite", to seconds; nullopt for any other text.
std::optional<double> parse_slurm_time(const std::string& text);
/// Formats a duration for Slurm, rounded up to minutes: "1-02:30:00".
std::string format_slurm_time(double seconds);

}  // namespace strut

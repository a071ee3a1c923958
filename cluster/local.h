// Runs tasks on this machine, in the background, one after another.
#pragma once

#include "cluster/dispatcher.h"

namespace strut {

/// A job is a session of processes. The text that submit() returns contains host, boot and start
/// time of its leader, so that no later process is mistaken for it. Since anybody may write such a
/// text, the process is accepted and stopped only if it belongs to this user, leads a session and
/// bears the job's mark.
class LocalDispatcher : public Dispatcher {
 public:
  static constexpr const char* kName = "local";
  std::string name() const override { return kName; }
  std::string find_cluster_name() const override { return ""; }
  SiteLimits check(const Resources& resources, const std::filesystem::path& folder) const override;
  Findings examine(const Resources& resources, const std::filesystem::path& folder) const override;
  std::vector<NodeInstructionSets> list_node_instruction_sets(
      const Resources& resources) const override;
  std::string make_script(const TaskArray& tasks) const override;
  std::vector<std::string> make_command(const TaskArray& tasks, const std::filesystem::path& script,
                                        const std::vector<std::string>& after) const override;
  std::string dry_run(const TaskArray&) const override { return ""; }
  std::string submit(const TaskArray& tasks, const std::filesystem::path& script,
                     const std::vector<std::string>& after) const override;
  std::string find_job(const JobRecord&) const override { return ""; }
  QueueAnswer query(const std::vector<JobRecord>& jobs) const override;
  void cancel(const std::vector<JobRecord>& jobs) const override;
  bool requeue_own() const override { return false; }
  std::int64_t find_own_deadline() const override { return 0; }
  int count_own_restarts() const override { return 0; }

 private:
  mutable std::string last_;  // the last job of this object, for which the next one waits
};

}  // namespace strut

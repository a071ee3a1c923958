// This machine: one array after the other, in the background, task by task.
#pragma once

#include "cluster/dispatcher.h"

namespace strut {

/// A job is a session of processes. What submit() returns tells host, boot and start of its leader,
/// so that no later process is taken for it. Anybody may write such a text, so what it names is
/// believed and stopped only where it is this user's, leads a session and bears the job's mark.
class LocalDispatcher : public Dispatcher {
 public:
  std::string name() const override { return "local"; }
  std::string find_place() const override { return ""; }
  SiteLimits check(const Resources& resources, const std::filesystem::path& folder) const override;
  Findings examine(const Resources& resources, const std::filesystem::path& folder) const override;
  std::vector<NodeAnswer> ask_nodes(const Resources& resources) const override;
  std::string make_script(const TaskArray& tasks) const override;
  std::vector<std::string> make_command(const TaskArray& tasks, const std::filesystem::path& script,
                                        const std::vector<std::string>& after) const override;
  std::string try_tasks(const TaskArray&) const override { return ""; }
  std::string submit(const TaskArray& tasks, const std::filesystem::path& script,
                     const std::vector<std::string>& after) const override;
  std::string find_job(const JobRecord&) const override { return ""; }
  QueueAnswer query(const std::vector<JobRecord>& jobs) const override;
  void cancel(const std::vector<JobRecord>& jobs) const override;
  bool requeue_own() const override { return false; }
  std::int64_t find_own_end() const override { return 0; }
  int count_own_restarts() const override { return 0; }

 private:
  mutable std::string last_;  // what this object submitted last: the next waits for it
};

}  // namespace strut

// This machine: one array after the other, in the background, task by task.
#pragma once

#include "jobs/dispatch/dispatcher.h"

namespace strut {

/// A job is a process group; its name tells host, boot and start, so that no other process is ever
/// taken for it.
class LocalDispatcher : public Dispatcher {
 public:
  std::string name() const override { return "local"; }
  std::string find_place() const override { return ""; }
  SiteLimits check(const Resources& resources, const std::filesystem::path& folder) const override;
  Findings examine(const Resources& resources, const std::filesystem::path& folder) const override;
  std::vector<NodeAnswer> ask_nodes(const Resources& resources) const override;
  std::string make_script(const TaskArray& tasks) const override;
  std::string try_script(const std::filesystem::path&) const override { return ""; }
  std::string submit(const std::filesystem::path& script,
                     const std::vector<std::string>& after) const override;
  std::string find_job(const std::string&) const override { return ""; }
  QueueAnswer query(const std::map<std::string, std::string>& names) const override;
  void cancel(const std::map<std::string, std::string>& names) const override;
  bool requeue_own() const override { return false; }
  std::int64_t find_own_end() const override { return 0; }
  int count_own_restarts() const override { return 0; }

 private:
  mutable std::string last_;  // what this object submitted last: the next waits for it
};

}  // namespace strut

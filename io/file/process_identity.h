// Which process a name stands for, and whether that one still runs.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace strut {

/// What makes a process the same one. A process id means something only on one host since its last
/// boot and within one namespace of process ids (two containers may share host name and numbers),
/// and only until the number is given out again, which the start time tells.
struct ProcessIdentity {
  std::string host;        // letters, digits, '-', '.', '_'
  std::string boot;        // /proc/sys/kernel/random/boot_id
  std::string name_space;  // "pid:[4026531836]"
  std::string process;
  std::string start;  // clock ticks since boot
};

/// This process. What the system does not tell is empty.
ProcessIdentity find_own_identity();

/// Whether some process of this host, in this namespace, has the number.
bool is_process_number_taken(const std::string& process);

enum class Life {
  kGone,     // ended, a zombie, or its number is another process's now
  kRuns,     // perhaps stopped
  kUnknown,  // of another host, boot or namespace, or hidden
};

/// `own`: this process. By the process number where host, boot and namespace are the same.
Life judge_process(const ProcessIdentity& process, const ProcessIdentity& own);

/// Whose a process of this host is, as the system tells.
struct ProcessOwner {
  uid_t user = 0;
  std::string group, session;            // their leaders' numbers
  std::vector<std::string> environment;  // NAME=VALUE, as it was started with; empty where hidden
};

/// nullopt where there is no such process, or it may not be looked at.
std::optional<ProcessOwner> find_process_owner(const std::string& process);

}  // namespace strut

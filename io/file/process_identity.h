// Identifies processes across hosts and boots, and tests whether one still runs.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace strut {

/// Identity of a process. A process number is unique only on one host since its last boot and
/// within one namespace of process numbers (two containers may share host name and numbers), and
/// only until the number is reused, which the start time reveals.
struct ProcessIdentity {
  std::string host;        // letters, digits, '-', '.', '_'
  std::string boot;        // /proc/sys/kernel/random/boot_id
  std::string name_space;  // "pid:[4026531836]"
  std::string process;
  std::string start;  // clock ticks since boot
};

/// Returns the identity of this process; fields that the system does not provide are empty.
ProcessIdentity find_own_identity();

/// Returns whether a process of this host and namespace has the number.
bool is_process_number_taken(const std::string& process);

enum class Liveness {
  kDead,     // ended, a zombie, or its number was reused
  kAlive,    // running, or stopped by a signal
  kUnknown,  // from another host, boot or namespace, or hidden
};

/// Returns whether `process` runs, seen from `own`, this process.
Liveness check_liveness(const ProcessIdentity& process, const ProcessIdentity& own);

/// Owner of a process of this host, as /proc shows it.
struct ProcessOwner {
  uid_t user = 0;
  std::string group, session;            // process numbers of their leaders
  std::vector<std::string> environment;  // NAME=VALUE, as at its start; empty if hidden
};

/// Returns nullopt if there is no such process or its details may not be read.
std::optional<ProcessOwner> find_process_owner(const std::string& process);

}  // namespace strut

// Calls of Slurm's commands and parsing of their answers; for the files of SlurmDispatcher only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/file/run_child.h"

namespace strut::slurm {

std::vector<std::string> split(const std::string& text, char separator);

/// Runs a command of Slurm, without the environment variables that would replace our options or
/// hide parts of its answer.
ChildOutput call(const std::vector<std::string>& words);

/// Runs a command and returns its output. Throws EnvironmentError if it fails.
std::string ask(const std::vector<std::string>& words);

/// Settings of a site: "MaxArraySize            = 1001" of `scontrol show config`.
using Settings = std::map<std::string, std::string>;

/// Reads the settings. Throws EnvironmentError.
Settings read_settings();

}  // namespace strut::slurm

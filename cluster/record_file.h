// The small files that a submission leaves in a sweep's folder. The folder may come from anywhere.
#pragma once

#include <optional>
#include <string>

#include "io/file/folder.h"

namespace strut {

/// Remedy for a damaged file.
inline constexpr char kRecordRemedy[] = "move this file away";

/// Reads a file; nullopt if it is missing. Throws InputError for a link, for anything else that is
/// not a regular file, and for a file larger than any that strut writes.
std::optional<std::string> read_record_file(const Folder& folder, const std::string& name);

}  // namespace strut

// The small files that a submission leaves in a sweep's folder. The folder may come from anywhere.
#pragma once

#include <optional>
#include <string>

#include "io/file/folder.h"

namespace strut {

/// What is to be done about a damaged one.
constexpr const char* kRecordRemedy = "; move this file away";

/// The content of a file; nullopt where it is missing. Throws InputError for a link, for anything
/// else that is not a regular file, and for one larger than any that strut writes.
std::optional<std::string> read_record_file(const Folder& folder, const std::string& name);

}  // namespace strut

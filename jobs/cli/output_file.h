// The file or folder that a command writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/cli/arguments.h"
#include "report/content.h"

namespace strut {

/// The rule for every file that a command writes: refuses one that could not be written, or must
/// not be, before the work is done. Throws InputError, which names the option, where `output` is a
/// folder or device, part of a sweep, one of `inputs`, which the command reads, or exists and
/// `may_replace` is false: then `remedy` says what to do. EnvironmentError where its folder is
/// missing.
void check_output_file(const std::string& option, const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs, bool may_replace,
                       const std::string& remedy = "--force replaces it");

/// The rule for a folder into which a command writes, which may be missing. Throws InputError,
/// which names the option, where it is a file, or lies in a subfolder of a sweep.
void check_output_folder(const std::string& option, const std::filesystem::path& folder);

/// TOML files and the files that they name: what a command that reads them must not write.
std::vector<std::filesystem::path> list_files_read(
    const std::vector<std::filesystem::path>& toml_files);

/// The value of --output, which --force lets replace a file; `inputs`: what the command reads,
/// besides the files that those of them in TOML name. Throws InputError where it is missing, and as
/// check_output_file does.
std::filesystem::path find_output_file(const Arguments& arguments,
                                       const std::vector<std::string>& inputs);

/// The folder of --output, made where it is missing, into which a page goes, `files` beside it.
/// Throws InputError where it is missing, a file, part of a sweep, or holds `content` of before and
/// --force is not given; where one of the files is one of `inputs`, what the command reads, or not
/// of an earlier page of that content; EnvironmentError where it cannot be made.
std::filesystem::path find_output_folder(const Arguments& arguments, const FolderContent& content,
                                         const std::vector<std::string>& files,
                                         const std::vector<std::filesystem::path>& inputs);

}  // namespace strut

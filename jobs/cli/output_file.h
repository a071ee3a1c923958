// The file or folder that a command writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/cli/arguments.h"
#include "report/content.h"

namespace strut {

/// Checks, before any work is done, that a command can and may write `output`. Throws InputError,
/// which names the option, if `output` is a folder or device, part of a sweep, or one of `inputs`
/// (the files that the command reads), or if it exists and `may_replace` is false; the message then
/// ends with `remedy`. What may be replaced is a result of the same kind: a file with a seal of
/// another kind than `seal`, the one that the command writes, is refused. Throws EnvironmentError
/// if the folder is missing.
void check_output_file(const std::string& option, const std::filesystem::path& output,
                       const std::vector<std::filesystem::path>& inputs, bool may_replace,
                       const std::string& remedy = "--force replaces it",
                       const std::string& seal = "");

/// Refuses a name that vehicles, maneuvers, sweeps and tires have, for a command that writes HDF5.
/// Throws InputError.
void refuse_source(const std::string& option, const std::filesystem::path& output);

/// Checks a folder, which may be missing, into which a command writes. Throws InputError, which
/// names the option, if it is a file or lies in a subfolder of a sweep.
void check_output_folder(const std::string& option, const std::filesystem::path& folder);

/// Lists TOML files and the files that they name, none of which a command may overwrite.
std::vector<std::filesystem::path> list_files_read(
    const std::vector<std::filesystem::path>& toml_files);

/// Returns the value of --output, which may be an existing file with --force. `inputs`: the files
/// that the command reads, without those that the TOML files among them name. Throws InputError if
/// the option is missing, and as check_output_file does, which `seal` is for.
std::filesystem::path find_output_file(const Arguments& arguments,
                                       const std::vector<std::string>& inputs,
                                       const std::string& seal = "");

/// Returns the folder of --output, created if missing, for a page and `files` beside it. Throws
/// InputError if the option is missing; if the folder is a file, part of a sweep, or already
/// contains `content` and --force is not given; if one of the files is one of `inputs` (the files
/// that the command reads) or does not belong to an earlier page of that content. Throws
/// EnvironmentError if the folder cannot be created.
std::filesystem::path find_output_folder(const Arguments& arguments, const FolderContent& content,
                                         const std::vector<std::string>& files,
                                         const std::vector<std::filesystem::path>& inputs);

}  // namespace strut

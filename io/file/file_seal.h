// The seal of a file: a text in its first 512 bytes, HDF5's user block, or, in a merged file, in
// its last 512 bytes, with the size of the file and the SHA-256 of all other bytes. A flipped bit
// anywhere is found from the file alone, before the HDF5 library reads it. A file with a user block
// is not recognized by all tools: netCDF's look for HDF5's signature in the first bytes.
//
//     strut shard seal 1
//     plan 3f5a...
//     shard 42
//     size 81234
//     sha256 9b0c...      of all bytes outside the seal
//     seal 77e1...        SHA-256 of the lines above; zeros up to byte 512
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace strut {

inline constexpr std::size_t kSealBytes = 512;

/// Fault of a file whose values lie in other files.
inline constexpr char kViewFault[] =
    "a view over shards cannot be verified; `strut merge DIR -o FILE` writes a copy";

/// Fault of a merged file that lost its seal.
inline constexpr char kLostSealFault[] =
    "damaged: a merged file without the seal at its end; "
    "`strut merge DIR -o FILE --force` makes it anew";

/// A kind of sealed file.
struct SealKind {
  const char* name;      // "shard"
  const char* remedy;    // for a damaged file of this kind
  const char* sealing;   // for a file that an earlier version wrote without a seal
  bool is_last = false;  // the last bytes of the file are the seal, not the first
};

inline constexpr SealKind kShardSeal = {
    "shard",
    "`strut verify DIR --quarantine` moves it aside, `strut run DIR` then simulates it again", ""};
inline constexpr SealKind kPlanSeal = {
    "plan", "`strut plan DIR/request.toml -o NEW` makes the same plan.h5 to replace it",
    "`strut plan DIR/request.toml -o DIR` seals it"};
inline constexpr SealKind kModelSeal = {"model", "`strut train` makes it anew",
                                        "`strut train` writes sealed ones"};
inline constexpr SealKind kCheckpointSeal = {
    "checkpoint", "`strut train` without --resume starts anew", "the next one will be sealed"};
inline constexpr SealKind kMergedSeal = {
    "merged", "`strut merge DIR -o FILE --force` makes it anew",
    "`strut merge DIR -o FILE --force` writes a sealed one", true};

/// Further lines of a seal, specific to its kind: (key, text).
using SealLines = std::vector<std::pair<std::string, std::string>>;

/// Content of a seal that the writer chooses.
struct SealLabel {
  SealKind kind = kShardSeal;
  SealLines lines = {};
};

struct FileSeal {
  std::string kind;
  SealLines lines;
  std::uint64_t size = 0;  // bytes of the whole file
  std::string sha256;      // digest of all bytes outside the seal, 64 digits

  /// Returns the text of a line; empty if there is no such line.
  std::string get(const std::string& key) const;
};

/// The seal of a file and the result of checking it.
struct SealCheck {
  FileSeal seal;
  std::string fault;   // empty: the file is intact
  std::string remedy;  // empty: none, as for a file of another kind
};

/// Reads the seal and compares the size. Throws InputError if the file cannot be read.
SealCheck check_seal(const std::filesystem::path& path, const SealKind& kind);
/// Checks likewise, given the bytes of the seal of a file of `size` bytes.
SealCheck check_seal(std::span<const std::byte> seal_bytes, std::uint64_t size,
                     const SealKind& kind);
/// Checks the seal, the size and every byte.
SealCheck check_sealed_file(const std::filesystem::path& path, const SealKind& kind);
/// Checks likewise, given all bytes of a file.
SealCheck check_sealed_bytes(std::span<const std::byte> bytes, const SealKind& kind);

/// Returns the seal if the file is intact. Otherwise throws InputError with file, fault and remedy.
FileSeal require_intact(const std::filesystem::path& path, SealCheck check);

struct SealedBytes {
  FileSeal seal;
  std::vector<std::byte> bytes;  // content of the whole file
};

/// Reads a file once and checks every byte; if it has no seal of this kind, the rest is not read.
/// Throws InputError.
SealedBytes read_sealed(const std::filesystem::path& path, const SealKind& kind);

/// Returns the kind of a file's seal; empty if it has none.
std::string find_seal_kind(const std::filesystem::path& path);

/// Returns false for an HDF5 file without a seal, as earlier versions of strut wrote plans, models,
/// checkpoints and merged files; true for any other file, even one whose seal is invalid. Throws
/// InputError if the file cannot be read.
bool is_sealed(const std::filesystem::path& path);

/// Throws InputError if an HDF5 file without a seal has a global heap. strut wrote global heaps
/// only in views over other files, and in merged files that have a seal; a flipped bit in one may
/// crash the HDF5 library.
void refuse_global_heap(const std::filesystem::path& path);

/// Overwrites the first kSealBytes bytes of a file's image with its seal, or appends them. Throws
/// CheckError if the lines do not fit.
void seal_image(const SealLabel& label, std::vector<std::byte>& image);
/// Seals a file on disk likewise, which messages call `shown`. Throws EnvironmentError.
void seal_file(const SealLabel& label, const std::filesystem::path& path,
               const std::filesystem::path& shown);

}  // namespace strut

// The seal of a file: a text in its first 512 bytes, HDF5's user block, with the size of the file
// and the SHA-256 of all bytes after it. A flipped bit anywhere is found from the file alone,
// before the HDF5 library reads it.
//
//     strut shard seal 1
//     plan 3f5a...
//     shard 42
//     size 81234
//     sha256 9b0c...      of all bytes from 512 on
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

/// A kind of sealed file.
struct SealKind {
  const char* name;     // "shard"
  const char* remedy;   // for a damaged file of this kind
  const char* sealing;  // for a file that an earlier version wrote without a seal
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
inline constexpr SealKind kMergedSeal = {"merged",
                                         "`strut merge DIR -o FILE --force` makes it anew",
                                         "`strut merge DIR -o FILE --force` writes a sealed one"};

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
  std::string sha256;      // digest of all bytes after the seal, 64 digits

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
/// Checks likewise, given the first bytes of a file of `size` bytes.
SealCheck check_seal(std::span<const std::byte> first_bytes, std::uint64_t size,
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

/// Reads a file once and checks every byte; if its first bytes are not a seal, the rest is not
/// read. Throws InputError.
SealedBytes read_sealed(const std::filesystem::path& path, const SealKind& kind);

/// Returns the kind of the seal that a file begins with; empty if it does not begin with a seal.
std::string find_seal_kind(const std::filesystem::path& path);

/// Returns false for an HDF5 file without a seal, as earlier versions of strut wrote plans, models,
/// checkpoints and merged files; true for any other file, even one whose seal is invalid. Throws
/// InputError if the file cannot be read.
bool is_sealed(const std::filesystem::path& path);

/// Throws InputError if an HDF5 file without a seal has a global heap. strut writes global heaps
/// only in views over other files, and a flipped bit in one may crash the HDF5 library.
void refuse_global_heap(const std::filesystem::path& path);

/// Overwrites the first kSealBytes bytes of a file's image with its seal. Throws CheckError if the
/// lines do not fit.
void seal_image(const SealLabel& label, std::span<std::byte> image);
/// Seals a file on disk, which messages call `shown`. Throws EnvironmentError.
void seal_file(const SealLabel& label, const std::filesystem::path& path,
               const std::filesystem::path& shown);

}  // namespace strut

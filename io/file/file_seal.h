// The seal of a file: a text in its first 512 bytes, HDF5's user block, that holds the size of the
// file and the SHA-256 of everything behind it. A flipped bit anywhere is found with the file
// alone, before the HDF5 library sees it.
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

/// What is wrong with a file whose values lie in others.
inline constexpr char kViewFault[] =
    "a view over shards cannot be verified; `strut merge DIR -o FILE` writes a copy";

/// A kind of file that is sealed.
struct SealKind {
  const char* name;     // "shard"
  const char* remedy;   // what to do where a file of this kind is damaged
  const char* sealing;  // how to seal one that an earlier version wrote without a seal
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

/// Lines of a seal that only some kinds have: (key, text).
using SealLines = std::vector<std::pair<std::string, std::string>>;

/// What a writer must know to seal a file.
struct SealLabel {
  SealKind kind = kShardSeal;
  SealLines lines = {};
};

struct FileSeal {
  std::string kind;
  SealLines lines;
  std::uint64_t size = 0;  // bytes of the whole file
  std::string sha256;      // of all bytes behind the seal, 64 digits

  /// Text of a line; empty where there is none.
  std::string get(const std::string& key) const;
};

/// A seal, and what is wrong with the file.
struct SealCheck {
  FileSeal seal;
  std::string fault;   // empty: nothing
  std::string remedy;  // empty: none, as for a file of another kind
};

/// Reads the seal and compares the size. Throws InputError where the file cannot be read.
SealCheck check_seal(const std::filesystem::path& path, const SealKind& kind);
/// As above, of the first bytes of a file of `size` bytes.
SealCheck check_seal(std::span<const std::byte> first_bytes, std::uint64_t size,
                     const SealKind& kind);
/// Reads every byte, block by block.
SealCheck check_sealed_file(const std::filesystem::path& path, const SealKind& kind);
/// As above, of all bytes of a file.
SealCheck check_sealed_bytes(std::span<const std::byte> bytes, const SealKind& kind);

/// The seal of a check that found nothing wrong. Throws InputError with file, fault and remedy.
FileSeal require_sound(const std::filesystem::path& path, SealCheck check);

struct SealedBytes {
  FileSeal seal;
  std::vector<std::byte> bytes;  // of the whole file
};

/// Reads a file once, every byte checked; one whose first bytes are no seal is not read, however
/// large. Throws InputError.
SealedBytes read_sealed(const std::filesystem::path& path, const SealKind& kind);

/// Kind of the seal that a file begins with; empty where it begins with none.
std::string find_seal_kind(const std::filesystem::path& path);

/// False for an HDF5 file without a seal, as earlier versions of strut wrote plans, models,
/// checkpoints and merged files. Throws InputError where the file cannot be read.
bool is_sealed(const std::filesystem::path& path);

/// Throws InputError where an HDF5 file without a seal has a global heap. strut writes one in views
/// over other files alone, and the HDF5 library may crash where a bit of it is flipped.
void refuse_global_heap(const std::filesystem::path& path);

/// Overwrites the first kSealBytes bytes of a file's image. Throws CheckError where the lines
/// do not fit.
void seal_image(const SealLabel& label, std::span<std::byte> image);
/// The same of a file on disk, which messages call `shown`. Throws EnvironmentError.
void seal_file(const SealLabel& label, const std::filesystem::path& path,
               const std::filesystem::path& shown);

}  // namespace strut

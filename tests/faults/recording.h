// The format in which the preloaded library writes down what a program does to the files of one
// folder: a header, the two paths relative to the folder, the data; again and again.
#pragma once

#include <cstdint>

namespace strut::test {

enum class FileCall : std::uint32_t {
  kOpen,      // offset 1: emptied (O_TRUNC); only where it may have created or emptied a file
  kWrite,     // data at offset
  kTruncate,  // to the size offset
  kRename,    // path to other
  kLink,      // path also as other
  kUnlink,
  kSync,
  kSyncFolder,
  kMakeFolder,
};

struct RecordHeader {
  FileCall call;
  std::uint32_t path_size, other_size, data_size;
  std::uint64_t file;  // inode number; tells files apart while both exist
  std::uint64_t offset;
};

}  // namespace strut::test

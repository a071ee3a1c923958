// Damage to files, bit by bit.
#pragma once

#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "base/error/input_error.h"
#include "io/file/file_bytes.h"
#include "tests/support/temporary_folder.h"

namespace strut::test {

/// Flips `count` random bits of `file`, one at a time, and lets `read` meet each; returns how many
/// it did not refuse with an InputError that begins with the file's name and says `remedy`. The
/// file is as before at the end.
inline int count_missed_flips(const std::filesystem::path& file, const std::function<void()>& read,
                              const std::string& remedy, int count = 300) {
  const std::vector<std::byte> good = read_bytes(file);
  read();
  std::mt19937 random(1);
  int missed = 0;
  for (int i = 0; i < count; ++i) {
    std::vector<std::byte> image = good;
    const std::size_t at = random() % image.size();
    image[at] ^= std::byte{1} << (random() % 8);
    write_bytes(file, image);
    try {
      read();
      ++missed;
      UNSCOPED_INFO("byte " << at << " of " << file << ": not found");
    } catch (const InputError& e) {
      const std::string what = e.what();
      if (what.rfind(file.string() + ": ", 0) == 0 && what.find(remedy) != std::string::npos) {
        continue;
      }
      ++missed;
      UNSCOPED_INFO("byte " << at << ": " << what);
    }
  }
  write_bytes(file, good);
  return missed;
}

}  // namespace strut::test

// The data that the worker writes, for the tests to compare with.
#pragma once

#include <string>

#include "io/store/journal.h"

namespace strut::test {

/// `size` bytes without a short period.
inline std::string make_worker_text(std::size_t size) {
  std::string text(size, ' ');
  unsigned state = 12345;
  for (char& c : text) {
    state = state * 1664525U + 1013904223U;
    c = static_cast<char>(state >> 24);
  }
  return text;
}

inline JournalEntry make_worker_entry(int number) {
  JournalEntry entry;
  entry.file = "shards/" + std::to_string(number) + ".h5";
  entry.cases = 512;
  entry.failures = {{"diverged", number}, {"no event, 50 %", 2}};
  entry.bytes = 123456789012345;
  entry.sha256 = std::string(64, 'a');
  entry.digest = "0123:4567 x=y";
  entry.seconds = 0.1 * number;
  entry.time = 1700000000;
  entry.runner = "host.example.org.4711.0123456789abcdef";
  entry.duplicate = number % 2 == 1;
  return entry;
}

inline void append_worker_entry(const std::filesystem::path& journal, int number) {
  append_journal(Folder(journal.parent_path()), journal.filename().string(),
                 make_worker_entry(number));
}

}  // namespace strut::test

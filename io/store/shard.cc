#include "io/store/shard.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace strut {

static_assert(std::endian::native == std::endian::little, "row hashes are of little-endian bytes");

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <class T>
void append_bytes(std::vector<std::byte>& bytes, const T& value) {
  const std::size_t end = bytes.size();
  bytes.resize(end + sizeof value);
  std::memcpy(bytes.data() + end, &value, sizeof value);
}

void append_numbers(std::vector<std::byte>& bytes, const std::vector<double>& values,
                    std::size_t rows, std::size_t row) {
  const std::size_t columns = values.size() / rows;
  for (std::size_t i = row * columns; i < (row + 1) * columns; ++i) {
    append_bytes(bytes, std::isnan(values[i]) ? kNone : values[i]);
  }
}

// Writes the bytes that calc_row_hash hashes to `bytes`.
void render_row(const ShardRows& rows, std::size_t row, std::vector<std::byte>& bytes) {
  bytes.clear();
  append_bytes(bytes, rows.case_id[row]);
  append_numbers(bytes, rows.parameters, rows.size(), row);
  append_numbers(bytes, rows.snapshot, rows.size(), row);
  append_bytes(bytes, rows.layer[row]);
  append_bytes(bytes, rows.status[row]);
  append_bytes(bytes, rows.attempt[row]);
  append_numbers(bytes, rows.event_time, rows.size(), row);
  append_numbers(bytes, rows.failure_time, rows.size(), row);
  for (const auto& channel : rows.history) append_numbers(bytes, channel, rows.size(), row);
}

void copy_row(std::vector<double>& to, std::size_t to_row, std::size_t to_rows,
              const std::vector<double>& from, std::size_t from_row) {
  const std::size_t columns = to.size() / to_rows;
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(from_row * columns);
  std::copy_n(begin, columns, to.begin() + static_cast<std::ptrdiff_t>(to_row * columns));
}

}  // namespace

ShardRows ShardRows::make(const ShardSchema& schema, std::size_t count) {
  ShardRows rows;
  rows.case_id.assign(count, 0);
  rows.parameters.assign(count * schema.parameters.size(), kNone);
  rows.snapshot.assign(count * schema.snapshot.size(), kNone);
  rows.layer.assign(count, 0);
  rows.status.assign(count, 0);
  rows.attempt.assign(count, 0);
  rows.event_time.assign(count, kNone);
  rows.failure_time.assign(count, kNone);
  rows.reason.resize(count);
  rows.history.assign(schema.history.size(),
                      std::vector<double>(count * schema.history_samples, kNone));
  return rows;
}

void ShardRows::set_row(std::size_t to, const ShardRows& other, std::size_t from) {
  const std::size_t n = size();
  case_id[to] = other.case_id[from];
  copy_row(parameters, to, n, other.parameters, from);
  copy_row(snapshot, to, n, other.snapshot, from);
  layer[to] = other.layer[from];
  status[to] = other.status[from];
  attempt[to] = other.attempt[from];
  event_time[to] = other.event_time[from];
  failure_time[to] = other.failure_time[from];
  reason[to] = other.reason[from];
  for (std::size_t c = 0; c < history.size(); ++c) {
    copy_row(history[c], to, n, other.history[c], from);
  }
}

Hash calc_row_hash(const ShardRows& rows, std::size_t row) {
  std::vector<std::byte> bytes;
  render_row(rows, row, bytes);
  return calc_sha256(bytes);
}

DataDigest calc_rows_digest(const ShardRows& rows) {
  DataDigest digest;
  Sha256 hash;
  std::vector<std::byte> bytes;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    render_row(rows, row, bytes);
    hash.update(bytes);
    digest.add(hash.finish());
  }
  return digest;
}

}  // namespace strut

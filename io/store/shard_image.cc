// Converts rows to the bytes of a shard's file: compression, then HDF5.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <type_traits>

#include "base/error/check.h"
#include "io/file/compress.h"
#include "io/store/shard_layout.h"

namespace strut {
namespace {

// Compresses chunks of whole rows; the last is padded with zeros.
std::vector<std::vector<std::byte>> compress_rows(std::span<const std::byte> bytes,
                                                  std::size_t chunk_bytes,
                                                  std::size_t element_size) {
  std::vector<std::vector<std::byte>> chunks;
  chunks.reserve(bytes.size() / chunk_bytes + 1);
  for (; bytes.size() >= chunk_bytes; bytes = bytes.subspan(chunk_bytes)) {
    chunks.push_back(compress_chunk(bytes.first(chunk_bytes), element_size));
  }
  if (!bytes.empty()) {
    std::vector<std::byte> last(bytes.begin(), bytes.end());
    last.resize(chunk_bytes);
    chunks.push_back(compress_chunk(last, element_size));
  }
  return chunks;
}

Hdf5Chunks make_chunks(const ShardColumn& column, std::size_t rows, Hdf5Type type,
                       std::size_t text_length, std::span<const std::byte> bytes) {
  const std::size_t element = get_element_size(type, text_length);
  const std::size_t row_bytes = std::max<std::size_t>(column.columns, 1) * element;
  STRUT_CHECK(bytes.size() == rows * row_bytes,
              fmt::format("shard: {} does not match its schema", column.name));
  Hdf5Chunks chunks{.name = column.name,
                    .type = type,
                    .shape = {rows},
                    .chunk_rows = calc_chunk_rows(rows, row_bytes),
                    .chunks = {},
                    .text_length = text_length,
                    .label = column.label};
  if (column.columns > 0) chunks.shape.push_back(column.columns);
  chunks.chunks = compress_rows(bytes, chunks.chunk_rows * row_bytes, element);
  return chunks;
}

}  // namespace

CompressedShard compress_shard(const ShardSchema& schema, const ShardRows& rows) {
  STRUT_CHECK(rows.history.size() == schema.history.size(),
              "shard: histories do not match their schema");
  CompressedShard shard;
  visit_shard_columns(schema, rows, [&](const ShardColumn& column, const auto& values) {
    using Values = std::decay_t<decltype(values)>;
    if constexpr (std::is_same_v<Values, std::vector<std::string>>) {
      const PackedTexts texts = pack_texts(values);
      shard.datasets.push_back(
          make_chunks(column, rows.size(), Hdf5Type::kText, texts.length, texts.bytes));
    } else {
      shard.datasets.push_back(make_chunks(column, rows.size(),
                                           hdf5_type<typename Values::value_type>, 0,
                                           std::as_bytes(std::span(values))));
    }
  });
  shard.digest = calc_rows_digest(rows);
  shard.cases = rows.size();
  shard.history_names = list_names(schema.history);
  shard.history_interval = schema.history.empty() ? 0.0 : schema.history_interval;
  shard.status_meaning = schema.status_meaning;
  return shard;
}

std::vector<std::byte> make_shard_image(const CompressedShard& shard,
                                        const ShardProvenance& provenance) {
  Hdf5Writer file(Hdf5InMemory{fmt::format("shard {}", provenance.shard)},
                  {.seal = make_shard_label(provenance.plan_hash, provenance.shard)});
  for (const Hdf5Chunks& dataset : shard.datasets) file.write_chunks(dataset);
  write_shard_attributes(file, shard.history_names, shard.history_interval, shard.status_meaning,
                         provenance.plan_hash, shard.digest);
  file.write_attribute("/", kShardKey, provenance.shard);
  for (const auto& [key, text] : provenance.texts) file.write_attribute("/", key, text);
  return file.image();
}

}  // namespace strut

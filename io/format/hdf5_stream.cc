#include "io/format/hdf5_stream.h"

#include <algorithm>

#include "base/error/check.h"
#include "io/file/compress.h"
#include "io/format/hdf5_calls.h"

namespace strut {

namespace fs = std::filesystem;
using hdf5::check;
using hdf5::checked;

Hdf5StreamWriter::Hdf5StreamWriter(const fs::path& path, SealLabel seal)
    : target_(path), seal_(std::move(seal)) {
  hdf5::prepare_library();
  sink_.shown = path;
  const Hdf5Handle access = hdf5::make_file_access(path);
  const Hdf5Handle creation = hdf5::make_file_creation(path, !seal_.kind.is_last);
  sink_.file = checked<EnvironmentError>(
      H5Fcreate(target_.temporary().c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose,
      path, "", kNotWritten);
}

void Hdf5StreamWriter::create(const std::string& name, Hdf5Type type,
                              const std::vector<std::size_t>& shape, const Hdf5Label& label,
                              std::size_t text_length) {
  Stream stream;
  stream.rank = shape.size();
  stream.rows = shape.front();
  stream.element_bytes = get_element_size(type, text_length);
  stream.row_bytes = stream.element_bytes * (shape.size() > 1 ? shape[1] : 1);
  stream.chunk_rows = calc_chunk_rows(stream.rows, stream.row_bytes);
  const Hdf5Handle creation = hdf5::make_dataset_creation(sink_, name, type, text_length);
  hdf5::set_chunks(sink_, name, creation.id(), shape, stream.chunk_rows);
  stream.dataset =
      hdf5::create_dataset(sink_, name, type, text_length, shape, creation.id(), label);
  streams_.emplace(name, std::move(stream));
}

void Hdf5StreamWriter::append(const std::string& name, std::span<const std::byte> bytes) {
  Stream& stream = streams_.at(name);
  const std::size_t chunk_bytes = stream.chunk_rows * stream.row_bytes;
  const std::size_t rows = (stream.pending.size() + bytes.size()) / stream.row_bytes;
  STRUT_CHECK(bytes.size() % stream.row_bytes == 0 && stream.written_rows + rows <= stream.rows,
              name + ": rows do not fit the dataset");
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), chunk_bytes - stream.pending.size());
    const auto part = bytes.first(taken);
    stream.pending.insert(stream.pending.end(), part.begin(), part.end());
    bytes = bytes.subspan(taken);
    if (stream.pending.size() == chunk_bytes) write_chunk(name, stream);
  }
}

void Hdf5StreamWriter::write_chunk(const std::string& name, Stream& stream) {
  const std::size_t rows = stream.pending.size() / stream.row_bytes;
  stream.pending.resize(stream.chunk_rows * stream.row_bytes);
  hdf5::write_chunk(sink_, name, stream.dataset.id(), stream.rank, stream.written_rows,
                    compress_chunk(stream.pending, stream.element_bytes));
  stream.written_rows += rows;
  stream.pending.clear();
}

void Hdf5StreamWriter::write_attribute(const std::string& object, const std::string& key,
                                       const std::string& value) {
  hdf5::write_text_attribute(sink_, object, key, {value}, true);
}

void Hdf5StreamWriter::write_attribute(const std::string& object, const std::string& key,
                                       std::int64_t value) {
  hdf5::write_number_attribute(sink_, object, key, H5T_NATIVE_INT64, &value);
}

void Hdf5StreamWriter::write_attribute(const std::string& object, const std::string& key,
                                       double value) {
  hdf5::write_number_attribute(sink_, object, key, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5StreamWriter::write_attribute_list(const std::string& object, const std::string& key,
                                            const std::vector<std::string>& values) {
  hdf5::write_text_attribute(sink_, object, key, values, false);
}

void Hdf5StreamWriter::write_names(const std::string& name, const std::vector<std::string>& names,
                                   const std::string& description) {
  hdf5::write_variable_texts(sink_, name, names, {"1", description, {}});
}

void Hdf5StreamWriter::create_dimension(const std::string& name, std::size_t size) {
  hdf5::create_dimension(sink_, name, size);
}

void Hdf5StreamWriter::attach_scale(const std::string& scale, unsigned dimension,
                                    const std::vector<std::string>& datasets) {
  hdf5::attach_scale(sink_, scale, dimension, datasets);
}

void Hdf5StreamWriter::commit() {
  for (auto& [name, stream] : streams_) {
    if (!stream.pending.empty()) write_chunk(name, stream);
    STRUT_CHECK(stream.written_rows == stream.rows, name + ": rows are missing");
    hdf5::close_dataset(sink_, name, stream.dataset);
  }
  const bool flushed = H5Fflush(sink_.file.id(), H5F_SCOPE_GLOBAL) >= 0;
  check<EnvironmentError>(flushed, sink_.shown, "", kNotWritten);
  check<EnvironmentError>(sink_.file.reset(), sink_.shown, "", kNotWritten);
  seal_file(seal_, target_.temporary(), sink_.shown);
  target_.commit();
}

}  // namespace strut

// Bytes of MATLAB's level 5 format (MathWorks, "MAT-File Format"), written by its description
// alone: data elements of a tag (type, size) and a body padded to 8 bytes.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace strut::test {

enum MatType : std::uint32_t { kInt8 = 1, kInt32 = 5, kUint32 = 6, kDouble = 9, kMatrix = 14 };
inline constexpr std::uint32_t kCompressed = 15;
enum MatClass : std::uint32_t { kStructClass = 2, kDoubleClass = 6 };

template <class T>
std::string make_element(std::uint32_t type, const std::vector<T>& values) {
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(T));
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &type, 4);
  std::memcpy(bytes.data() + 4, &size, 4);
  bytes.append(reinterpret_cast<const char*>(values.data()), size);
  bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
  return bytes;
}

/// An element of four bytes, stored within its tag.
inline std::string make_small_element(std::uint32_t type, std::int32_t value) {
  const std::uint32_t tag = type | (4U << 16U);
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &tag, 4);
  std::memcpy(bytes.data() + 4, &value, 4);
  return bytes;
}

inline std::string wrap_matrix(const std::string& body) {
  return make_element<char>(kMatrix, {body.begin(), body.end()});
}

inline std::string make_mat_array(const std::string& name, std::int32_t rows, std::int32_t columns,
                                  const std::vector<double>& values) {
  return wrap_matrix(make_element<std::uint32_t>(kUint32, {kDoubleClass, 0}) +
                     make_element<std::int32_t>(kInt32, {rows, columns}) +
                     make_element<char>(kInt8, {name.begin(), name.end()}) +
                     make_element(kDouble, values));
}

inline std::string make_mat_struct(const std::string& name, const std::string& field,
                                   const std::string& value) {
  std::vector<char> names(field.begin(), field.end());
  names.resize(32, '\0');
  return wrap_matrix(make_element<std::uint32_t>(kUint32, {kStructClass, 0}) +
                     make_element<std::int32_t>(kInt32, {1, 1}) +
                     make_element<char>(kInt8, {name.begin(), name.end()}) +
                     make_small_element(kInt32, 32) + make_element(kInt8, names) + value);
}

/// `count` structs whose fields' names, `each` bytes long, are in `names`; without the fields.
inline std::string make_mat_struct_array(const std::string& name, std::int32_t count,
                                         std::int32_t each, const std::string& names) {
  return wrap_matrix(make_element<std::uint32_t>(kUint32, {kStructClass, 0}) +
                     make_element<std::int32_t>(kInt32, {1, count}) +
                     make_element<char>(kInt8, {name.begin(), name.end()}) +
                     make_small_element(kInt32, each) +
                     make_element<char>(kInt8, {names.begin(), names.end()}));
}

/// A compressed element.
inline std::string pack_mat_element(const std::string& element) {
  std::vector<char> packed(compressBound(element.size()));
  uLongf size = packed.size();
  const int status = compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                              reinterpret_cast<const Bytef*>(element.data()), element.size());
  if (status != Z_OK) throw std::runtime_error("zlib: out of memory");
  const auto length = static_cast<std::uint32_t>(size);
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &kCompressed, 4);
  std::memcpy(bytes.data() + 4, &length, 4);
  return bytes.append(packed.data(), size);  // not padded
}

inline std::string make_mat_file(const std::string& elements) {
  std::string header = "MATLAB 5.0 MAT-file, made by a test";
  header.resize(124, ' ');
  header += std::string{'\0', '\1', 'I', 'M'};  // version 1, little endian
  return header + elements;
}

}  // namespace strut::test

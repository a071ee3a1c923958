// Writes messages of Protocol Buffers (https://protobuf.dev/programming-guides/encoding): the part
// of the format that an ONNX model needs.
#pragma once

#include <cstdint>
#include <string>

namespace strut {

class ProtobufMessage {
 public:
  ProtobufMessage& add(int field, std::int64_t value) {
    add_tag(field, kVarint);
    add_varint(static_cast<std::uint64_t>(value));
    return *this;
  }
  /// Adds a text, bytes or a message.
  ProtobufMessage& add(int field, const std::string& bytes) {
    add_tag(field, kLengthDelimited);
    add_varint(bytes.size());
    bytes_ += bytes;
    return *this;
  }
  ProtobufMessage& add(int field, const ProtobufMessage& message) {
    return add(field, message.bytes_);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::uint64_t kVarint = 0, kLengthDelimited = 2;

  void add_tag(int field, std::uint64_t wire_type) {
    add_varint(static_cast<std::uint64_t>(field) << 3 | wire_type);
  }
  void add_varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>((value & 0x7f) | 0x80);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace strut

// JSON text: written strictly (RFC 8259), members in the order in which they are set.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace strut {

class Json {
 public:
  Json() = default;  // null
  Json(double
           value);  // NOLINT: what a member is set to; not finite: null, as JSON has no such number
  Json(long value) : Json(std::to_string(value), Kind::kLiteral) {}     // NOLINT
  Json(int value) : Json(static_cast<long>(value)) {}                   // NOLINT
  Json(bool value) : Json(value ? "true" : "false", Kind::kLiteral) {}  // NOLINT
  Json(const char* value) : Json(std::string(value)) {}                 // NOLINT
  Json(const std::string& value) : Json(value, Kind::kText) {}          // NOLINT

  static Json object() { return Json("", Kind::kObject); }
  static Json array() { return Json("", Kind::kArray); }
  static Json texts(const std::vector<std::string>& values);

  /// Appends a member to an object; returns the object.
  Json& set(const std::string& key, Json value);
  /// Appends an element to an array.
  Json& push(Json value);

  /// Indented by two blanks a level; arrays and objects without nested ones stand on one line.
  std::string dump() const;

 private:
  enum class Kind { kLiteral, kText, kArray, kObject };
  Json(std::string text, Kind kind) : kind_(kind), text_(std::move(text)) {}
  bool is_flat() const;
  void append(int level, std::string& out) const;

  Kind kind_ = Kind::kLiteral;
  std::string text_ = "null";
  std::vector<std::pair<std::string, Json>> members_;
};

}  // namespace strut

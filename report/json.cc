#include "report/json.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/text/format_number.h"
#include "base/text/utf8.h"

namespace strut {
namespace {

std::string quote(const std::string& text) {
  static constexpr char kHex[] = "0123456789abcdef";
  const std::string valid = make_valid_utf8(text);
  std::string quoted = "\"";
  for (std::string_view left = valid; !left.empty();) {
    std::string_view rest = left;
    const char32_t code = take_character(rest);
    if (is_control(code)) {
      quoted += "\\u";
      for (const unsigned shift : {12U, 8U, 4U, 0U}) quoted += kHex[code >> shift & 0xfU];
    } else {
      if (code == '"' || code == '\\') quoted += '\\';
      quoted += left.substr(0, left.size() - rest.size());
    }
    left = rest;
  }
  return quoted + "\"";
}

}  // namespace

Json::Json(double value) : text_(std::isfinite(value) ? format_number(value) : "null") {}

Json Json::texts(const std::vector<std::string>& values) {
  Json list = array();
  for (const std::string& value : values) list.push(value);
  return list;
}

Json& Json::set(const std::string& key, Json value) {
  members_.emplace_back(key, std::move(value));
  return *this;
}

Json& Json::push(Json value) { return set("", std::move(value)); }

bool Json::is_flat() const {
  return std::all_of(members_.begin(), members_.end(), [](const auto& member) {
    return member.second.kind_ == Kind::kLiteral || member.second.kind_ == Kind::kText;
  });
}

void Json::append(int level, std::string& out) const {
  if (kind_ == Kind::kLiteral) out += text_;
  if (kind_ == Kind::kText) out += quote(text_);
  if (kind_ == Kind::kLiteral || kind_ == Kind::kText) return;
  const bool is_object = kind_ == Kind::kObject, flat = is_flat();
  const std::string indent(static_cast<std::size_t>(2 * level), ' ');
  out += is_object ? '{' : '[';
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (i > 0) out += flat ? ", " : ",";
    if (!flat) out += "\n" + indent + "  ";
    if (is_object) out += quote(members_[i].first) + ": ";
    members_[i].second.append(level + 1, out);
  }
  if (!flat) out += "\n" + indent;
  out += is_object ? '}' : ']';
}

std::string Json::dump() const {
  std::string out;
  append(0, out);
  return out;
}

}  // namespace strut

// Encodings of text files other than UTF-8.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <string_view>

namespace strut {

/// Whether a stream begins with the byte order mark of UTF-16; its position stays at the start.
bool starts_as_utf16(std::istream& stream);

/// Converts UTF-16 with a byte order mark to UTF-8, without the mark. Throws InputError for half of
/// a character.
std::string convert_utf16(const std::filesystem::path& path, std::string_view bytes);

/// Converts a text that is not valid UTF-8 from Latin-1; valid UTF-8 stays as it is.
std::string convert_latin1(std::string_view text);

}  // namespace strut

// A model file's text without its tables of one name.
#pragma once

#include <string>

namespace strut {

/// `text` without its table [name] or its tables [[name]] and the blank lines before them; all else
/// as it stands. Throws InputError where the text writes them as an array in one line.
std::string drop_tables(const std::string& text, const std::string& name);

}  // namespace strut

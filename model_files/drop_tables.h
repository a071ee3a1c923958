// Removal of tables from the text of a model file.
#pragma once

#include <string>

namespace strut {

/// Removes the table [name] or the tables [[name]] and the blank lines before them; the other text
/// is unchanged. Throws InputError where the text writes them as an array in one line.
std::string drop_tables(const std::string& text, const std::string& name);

}  // namespace strut

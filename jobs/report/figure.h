// Figures, drawn by gnuplot from a script that carries its own data.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace strut {

struct Figure {
  std::string name;               // of its files
  int width = 900, height = 560;  // px
  /// gnuplot's; terminal and palette are set, data come as make_data names them.
  std::string commands;
};

/// Colors that the color-blind can tell apart (M. Okabe, K. Ito, 2008): line types 1 to 6 of every
/// figure.
inline constexpr const char* kFigureColors[] = {"#0072B2", "#D55E00", "#009E73",
                                                "#CC79A7", "#E69F00", "#56B4E9"};

/// A block of data for a script, `$name`: lines of numbers; not finite ones as NaN, which gnuplot
/// leaves out.
std::string make_data(const std::string& name, const std::vector<std::vector<double>>& rows);
/// A text for a script, in quotes.
std::string quote_figure_text(const std::string& text);

/// A name as people write it: "body_position_z" -> "body position z"
std::string make_words(std::string name);

/// Whether a program gnuplot can be started.
bool has_gnuplot();

/// Writes FOLDER/NAME.gp. Throws EnvironmentError.
void write_figure_script(const std::filesystem::path& folder, const Figure& figure);

/// Draws FOLDER/NAME.svg by FOLDER/NAME.gp; `gnuplot NAME.gp > NAME.svg` does the same. Throws
/// EnvironmentError where gnuplot is missing or fails; it says what gnuplot said.
void draw_figure(const std::filesystem::path& folder, const std::string& name);

}  // namespace strut

// Charts as pictures: scripts for gnuplot that carry their own data.
#pragma once

#include <filesystem>
#include <string>

#include "jobs/report/chart.h"

namespace strut {

/// The script; `gnuplot NAME.gp > NAME.svg` draws it.
std::string make_gnuplot(const Chart& chart);

/// Whether a program gnuplot can be started.
bool has_gnuplot();

/// Draws FOLDER/NAME.svg by FOLDER/NAME.gp. Throws EnvironmentError where gnuplot is missing or
/// fails; it says what gnuplot said.
void draw_picture(const std::filesystem::path& folder, const std::string& name);

}  // namespace strut

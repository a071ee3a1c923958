// Charts as pictures: scripts for gnuplot that carry their own data.
#pragma once

#include <string>

#include "report/chart.h"

namespace strut {

/// The script; `gnuplot NAME.gp > NAME.svg` draws it.
std::string make_gnuplot(const Chart& chart);

/// Whether a program gnuplot can be started.
bool has_gnuplot();

/// The picture NAME, an SVG file's text, by a script of make_gnuplot; never by one that lies in a
/// folder, since gnuplot's language can run programs. Throws EnvironmentError with gnuplot's
/// message where it is missing or fails.
std::string draw_picture(const std::string& name, const std::string& script);

}  // namespace strut

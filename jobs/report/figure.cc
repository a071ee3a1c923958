#include "jobs/report/figure.h"

#include <algorithm>
#include <cmath>

#include "io/atomic_file.h"
#include "io/config.h"
#include "jobs/run_child.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMissing =
    "gnuplot: cannot be started; figures need it (Debian: apt install gnuplot-nox)";

std::string make_script(const Figure& figure) {
  std::string text = "set terminal svg size " + std::to_string(figure.width) + "," +
                     std::to_string(figure.height) +
                     " font \"Arial,14\" background \"white\"\nset encoding utf8\n";
  int type = 0;
  for (const char* color : kFigureColors) {
    text += "set linetype " + std::to_string(++type) + " linecolor rgb \"" + color +
            "\" linewidth 1.5\n";
  }
  return text + "set border linewidth 0.8\nset tics nomirror\n" + figure.commands;
}

/// A file that vanishes with this object.
class ScratchFile {
 public:
  explicit ScratchFile(fs::path path) : path_(std::move(path)) {}
  ~ScratchFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

std::string make_data(const std::string& name, const std::vector<std::vector<double>>& rows) {
  std::string text = "$" + name + " << END\n";
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      text += (c == 0 ? "" : " ") + (std::isfinite(row[c]) ? format_number(row[c]) : "NaN");
    }
    text += "\n";
  }
  return text + "END\n";
}

std::string quote_figure_text(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "' noenhanced";
}

std::string make_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

bool has_gnuplot() { return run_child({"gnuplot", "--version"}, {"/dev/null", "/dev/null"}) == 0; }

void write_figure_script(const fs::path& folder, const Figure& figure) {
  write_text_file(folder / (figure.name + ".gp"), make_script(figure));
}

void draw_figure(const fs::path& folder, const std::string& name) {
  const fs::path script = folder / (name + ".gp");
  AtomicFile svg(folder / (name + ".svg"));
  const ScratchFile messages(svg.temporary().string() + ".messages");
  const int code = run_child({"gnuplot", script.string()}, {svg.temporary(), messages.path()});
  if (code < 0) throw EnvironmentError(kMissing);
  const std::string said = fs::exists(messages.path()) ? read_text_file(messages.path()) : "";
  if (code != 0 || fs::file_size(svg.temporary()) == 0) {
    throw EnvironmentError(script.string() + ": gnuplot failed: " + said);
  }
  svg.commit();
}

}  // namespace strut

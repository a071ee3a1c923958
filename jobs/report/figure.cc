#include "jobs/report/figure.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>

#include "io/atomic_file.h"
#include "io/config.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMissing =
    "gnuplot: cannot be started; figures need it (Debian: apt install gnuplot-nox)";

/// Where a child's output goes.
struct ChildFiles {
  fs::path output, messages;
};

/// Runs gnuplot with one argument and waits. Returns its exit code, -1 where it cannot be started.
/// No shell; signals as at the program's start, whatever this thread holds back.
int run_gnuplot(const std::string& argument, const ChildFiles& files) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, files.output.c_str(), kFlags, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, files.messages.c_str(), kFlags, 0600);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  std::string name = "gnuplot", word = argument;
  std::array<char*, 3> words = {name.data(), word.data(), nullptr};
  pid_t child = 0;
  const int failure =
      posix_spawnp(&child, name.c_str(), &actions, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

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

bool has_gnuplot() { return run_gnuplot("--version", {"/dev/null", "/dev/null"}) == 0; }

void write_figure_script(const fs::path& folder, const Figure& figure) {
  write_text_file(folder / (figure.name + ".gp"), make_script(figure));
}

void draw_figure(const fs::path& folder, const std::string& name) {
  const fs::path script = folder / (name + ".gp");
  AtomicFile svg(folder / (name + ".svg"));
  const ScratchFile messages(svg.temporary().string() + ".messages");
  const int code = run_gnuplot(script.string(), {svg.temporary(), messages.path()});
  if (code < 0) throw EnvironmentError(kMissing);
  const std::string said = fs::exists(messages.path()) ? read_text_file(messages.path()) : "";
  if (code != 0 || fs::file_size(svg.temporary()) == 0) {
    throw EnvironmentError(script.string() + ": gnuplot failed: " + said);
  }
  svg.commit();
}

}  // namespace strut

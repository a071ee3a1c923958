#include "study/folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "estimate/design.h"
#include "io/file/atomic_file.h"
#include "io/file/read_text_file.h"
#include "io/format/toml_text.h"
#include "sweep/choose_settings.h"
#include "sweep/facts.h"
#include "sweep/folder.h"
#include "sweep/freeze_inputs.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

constexpr char kSweepKey[] = "sweep", kPublishedKey[] = "published",
               kWindowKey[] = "noise.window_sweep";

void add_sweep_facts(const std::string& key, const fs::path& sweep, Facts& facts) {
  for (const auto& [name, value] : list_facts(read_request(sweep))) {
    facts.emplace_back(key + "." + name, value);
  }
}

/// The facts that identify a study; names of files do not.
Facts list_study_facts(const StudyRequest& request) {
  Facts facts;
  for (const auto& [key, value] : flatten_toml(request.path)) {
    if (key != kSweepKey && key != kPublishedKey && key != kWindowKey) {
      facts.emplace_back(key, value);
    }
  }
  add_sweep_facts(kSweepKey, request.sweep, facts);
  if (request.noise) add_sweep_facts(kWindowKey, request.noise->sweep, facts);
  if (request.published_path.empty()) return facts;
  for (const auto& [key, value] : flatten_toml(request.published_path)) {
    facts.emplace_back(std::string(kPublishedKey) + "." + key, value);
  }
  return facts;
}

/// Trainings replace models and bounds by path, so none of them may be a link.
void check_files(const Folder& folder) {
  for (const std::string& name : folder.list()) {
    check_regular(folder.descriptor(), name, folder.path_of(name));
  }
}

/// Refuses a folder that holds anything but the files of an interrupted start.
void check_free(const StudyFolder& folder) {
  if (!fs::exists(folder.root)) return;
  if (!fs::is_directory(folder.root)) {
    throw InputError(
        fmt::format("{}: a file; must be a new or empty folder", folder.root.string()));
  }
  for (const auto& entry : fs::directory_iterator(folder.root)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours = name == folder.base().root.filename() ||
                         name == folder.window_base().root.filename() ||
                         name.starts_with(folder.published().filename().string()) ||
                         name.starts_with(folder.study().filename().string());
    if (is_ours) continue;
    throw InputError(fmt::format(
        "{}: not a study (no study.toml), but it holds '{}'; must be a new or empty folder",
        folder.root.string(), name));
  }
}

void check_same(const StudyFolder& folder, const StudyRequest& request) {
  const StudyRequest there = open_study_folder(folder);
  const auto changes = compare_facts(list_study_facts(there), list_study_facts(request));
  if (changes.empty()) return;
  std::string text = fmt::format(
      "{}: already holds a different study than {}; use another folder, or undo the changes:",
      folder.root.string(), request.path.string());
  for (const std::string& line : changes) text += "\n  " + line;
  throw InputError(text);
}

/// Copies a sweep and every file it names, replacing those of an interrupted start. Returns the
/// path of the copied request from the study's folder.
std::string freeze_sweep(const StudyFolder& folder, const fs::path& sweep, const SweepFolder& to) {
  Folder(folder.root)
      .make_folder(to.root.filename().string())
      .make_folder(to.inputs().filename().string());
  freeze_inputs(read_request(sweep), to);
  return to.request().lexically_relative(folder.root).generic_string();
}

/// Copies every file that the study names, so that later reports and runs need no file outside.
void freeze(const StudyFolder& folder, const StudyRequest& request) {
  TomlValues files = {{kSweepKey, freeze_sweep(folder, request.sweep, folder.base())}};
  if (request.noise) {
    files.emplace_back(kWindowKey,
                       freeze_sweep(folder, request.noise->sweep, folder.window_base()));
  }
  if (!request.published_path.empty()) {
    write_text_file_inside(folder.root, folder.published(), read_text_file(request.published_path));
    files.emplace_back(kPublishedKey, folder.published().filename().string());
  }
  write_text_file_inside(folder.root, folder.study(), replace_toml_texts(request.path, files));
}

/// A TOML literal of plain text.
std::string quote(const std::string& text) { return fmt::format("\"{}\"", text); }

/// Writes a base sweep's vehicle with another preload. Returns its path from the sweep's request.
std::string make_vehicle(const SweepFolder& base, const std::string& preload) {
  const fs::path vehicle = read_request(base.request()).vehicle;
  const fs::path made =
      vehicle.parent_path() / fmt::format("{}_{}.toml", vehicle.stem().string(), preload);
  write_text_file_inside(base.root, made,
                         set_toml_values(vehicle, {{"spring.preload", quote(preload)}}));
  return made.lexically_relative(base.root).generic_string();
}

/// Offset [m] of the most informative instant: the one with the smallest mean square Cramer-Rao
/// bound.
double find_best_offset(const SweepRequest& request) {
  SensitivityOptions options;
  options.integrate = make_accurate(request.integrate);
  const Sensitivity s = calc_sensitivity(make_base_point(request.base, request.grid, {}, {}),
                                         request.grid.axes(), request.snapshot.offset, options);
  const Design design = calc_design(s, request.snapshot.channels, make_default_noise());
  return s.instants[design.best.front().instants.front()].offset;
}

/// Writes the request of a cell's sweep beside that of the base sweep.
fs::path make_request(const StudyFolder& folder, const StudyRequest& request,
                      const StudyCell& cell) {
  const StudyPreload& preload = request.preloads[cell.preload];
  const fs::path base = folder.base().request();
  fs::path made = base.parent_path() / (make_sweep_name(request, cell) + ".toml");
  TomlValues values = {{"vehicle", quote(make_vehicle(folder.base(), preload.name))},
                       {"sample.count", std::to_string(request.samples[cell.samples])}};
  write_text_file_inside(folder.base().root, made, set_toml_values(base, values));
  if (!cell.best_instant) return made;
  const double offset =
      preload.best_offset ? *preload.best_offset : find_best_offset(read_request(made));
  values.emplace_back("record.snapshot.offset", format_number(offset));
  write_text_file_inside(folder.base().root, made, set_toml_values(base, values));
  return made;
}

fs::path make_window_request(const StudyFolder& folder, const StudyRequest& request) {
  const SweepFolder base = folder.window_base();
  const std::string vehicle = quote(make_vehicle(base, request.preloads.back().name));
  fs::path made =
      base.root / (get_window_sweep(folder, request).root.filename().string() + ".toml");
  write_text_file_inside(base.root, made, set_toml_values(base.request(), {{"vehicle", vehicle}}));
  return made;
}

/// Opens the plan of `sweep`; if there is none, makes it from the request that `make` writes.
/// Throws InputError where the sweep's folder in the study is a link.
template <class Make>
Plan plan_once(const StudyFolder& folder, const SweepFolder& sweep, const Make& make) {
  Folder(folder.root)
      .make_folder(folder.sweeps().filename().string())
      .make_folder(sweep.root.filename().string());
  if (!fs::exists(sweep.plan())) make_sweep_folder(sweep.root, make_plan(make()));
  return open_sweep_folder(sweep);
}

}  // namespace

StudyFolder make_study_folder(const fs::path& root, const StudyRequest& request) {
  StudyFolder folder{root.lexically_normal()};
  if (fs::exists(folder.study())) {
    check_same(folder, request);
  } else {
    check_free(folder);
    make_folder(folder.root);
    freeze(folder, request);
  }
  const Folder opened(folder.root);
  opened.make_folder(folder.sweeps().filename().string());
  opened.make_folder(folder.figures().filename().string());
  check_files(opened.make_folder(folder.models().filename().string()));
  if (request.noise) check_files(opened.make_folder(folder.noise().filename().string()));
  return folder;
}

StudyRequest open_study_folder(const StudyFolder& folder) {
  if (!fs::exists(folder.study())) {
    throw InputError(
        fmt::format("{}: not a study: no study.toml; `strut study STUDY.toml -o DIR` makes one",
                    folder.root.string()));
  }
  return read_study(folder.study());
}

Plan plan_study_sweep(const StudyFolder& folder, const StudyRequest& request,
                      const StudyCell& cell) {
  return plan_once(folder, folder.sweep(make_sweep_name(request, cell)),
                   [&] { return make_request(folder, request, cell); });
}

SweepFolder get_window_sweep(const StudyFolder& folder, const StudyRequest& request) {
  return folder.sweep(request.preloads.back().name + "_window");
}

Plan plan_window_sweep(const StudyFolder& folder, const StudyRequest& request) {
  return plan_once(folder, get_window_sweep(folder, request),
                   [&] { return make_window_request(folder, request); });
}

std::vector<std::pair<std::string, StudyCell>> list_study_sweeps(const StudyRequest& request) {
  std::vector<std::pair<std::string, StudyCell>> sweeps;
  for (const StudyCell& cell : list_cells(request)) {
    const std::string name = make_sweep_name(request, cell);
    const bool known = std::any_of(sweeps.begin(), sweeps.end(),
                                   [&](const auto& sweep) { return sweep.first == name; });
    if (!known) sweeps.emplace_back(name, cell);
  }
  return sweeps;
}

}  // namespace strut

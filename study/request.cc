#include "study/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error/input_error.h"
#include "base/text/nearest_name.h"
#include "base/text/range.h"
#include "io/format/toml_document.h"
#include "model_files/file_kind.h"
#include "model_files/read_vehicle.h"
#include "sweep/plan.h"
#include "train/network/network.h"
#include "train/train_network.h"

namespace strut {
namespace {

constexpr int kMaxInt = std::numeric_limits<int>::max();
constexpr int kMaxSeeds = 1000;
constexpr double kMaxWhole = 9e15;  // a double holds every whole number up to here
constexpr double kMinR2 = -1e6;     // worse than any published fit

template <class T>
void check_different(const Table& table, const std::string& key, std::vector<T> values) {
  if (values.empty()) throw table.error(key, "must name at least one");
  std::sort(values.begin(), values.end());
  if (std::adjacent_find(values.begin(), values.end()) == values.end()) return;
  throw table.error(key, "holds a value twice; allowed: different values");
}

std::vector<std::int64_t> read_whole_numbers(const Table& table, const std::string& key,
                                             double max) {
  std::vector<std::int64_t> values;
  for (const double value : table.numbers(key, between(1.0, max))) {
    if (value != std::floor(value)) throw table.error(key, "must be whole numbers");
    values.push_back(static_cast<std::int64_t>(value));
  }
  return values;
}

/// The name becomes part of names of files and of columns.
void check_name(const Table& table, const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  });
  if (!plain || name.empty()) throw table.error(name, "must be a name of letters and digits");
}

std::vector<StudyNetwork> read_networks(const Table& table) {
  std::vector<StudyNetwork> networks;
  for (const std::string& name : table.keys()) {
    check_name(table, name);
    StudyNetwork network{name, {}};
    for (const std::int64_t size : read_whole_numbers(table, name, NetworkShape::kLargestSize)) {
      network.hidden.push_back(static_cast<int>(size));
    }
    networks.push_back(network);
  }
  if (networks.empty()) throw table.error("names no network; for example DNN3 = [27, 19, 11]");
  return networks;
}

std::vector<StudyInputs> read_inputs(const Table& table, const SweepRequest& sweep) {
  const std::vector<std::string> known = list_snapshot_channels(sweep);
  std::vector<StudyInputs> inputs;
  for (const std::string& name : table.keys()) {
    check_name(table, name);
    inputs.push_back({name, table.texts(name)});
    check_different(table, name, inputs.back().channels);
    for (const std::string& channel : inputs.back().channels) {
      if (std::find(known.begin(), known.end(), channel) != known.end()) continue;
      throw table.error(name,
                        fmt::format("'{}': not in the sweep's snapshot{}; allowed: {}", channel,
                                    suggest_name(channel, known), join_names(known)));
    }
  }
  if (inputs.empty())
    throw table.error("names no inputs; for example four = [\"body_position_z\", ...]");
  return inputs;
}

std::vector<StudyPreload> read_preloads(const Table& root) {
  std::vector<StudyPreload> preloads;
  const std::vector<std::string>& known = list_preloads();
  const std::vector<std::string> names = root.texts("preload");
  check_different(root, "preload", names);
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw root.error("preload", fmt::format("'{}'{}; allowed: {}", name,
                                              suggest_name(name, known), join_names(known)));
    }
    preloads.push_back({name, false, {}});
  }
  return preloads;
}

void read_best_instant(const Table& table, std::vector<StudyPreload>& preloads) {
  for (StudyPreload& preload : preloads) {
    if (!table.has(preload.name)) continue;
    preload.has_best = true;
    if (table.is_text(preload.name)) {
      table.choice(preload.name, {"design"});
    } else {
      preload.best_offset = table.number(preload.name, between(-1000.0, 1000.0, "m"));
    }
  }
}

template <class Item>
std::vector<std::string> list_names_of(const std::vector<Item>& items) {
  std::vector<std::string> names;
  names.reserve(items.size());
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

void read_main(const Table& table, StudyRequest& request) {
  request.main_network =
      static_cast<std::size_t>(table.choice_or("network", 0, list_names_of(request.networks)));
  request.main_inputs =
      static_cast<std::size_t>(table.choice_or("inputs", 0, list_names_of(request.inputs)));
  const std::int64_t wanted = table.integer_or("samples", request.samples.front(), 1,
                                               std::numeric_limits<std::int64_t>::max());
  const auto found = std::find(request.samples.begin(), request.samples.end(), wanted);
  if (found == request.samples.end())
    throw table.error("samples", "must be one of the study's samples");
  request.main_samples = static_cast<std::size_t>(found - request.samples.begin());
}

void read_training(const Table& table, StudyRequest& request) {
  LevenbergMarquardtOptions& o = request.options;
  o.rule = static_cast<DampingRule>(table.choice_or("rule", 0, kDampingRules));
  o.epochs = static_cast<int>(table.integer_or("epochs", o.epochs, 1, kMaxInt));
  o.max_failures = static_cast<int>(table.integer_or("max_failures", o.max_failures, 1, kMaxInt));
  o.goal = table.number_or("goal", o.goal, at_least(0.0));
  SplitChoice& split = request.split;
  split.train = table.number_or("train", split.train, between(0.01, 0.98));
  split.validate = table.number_or("validate", split.validate, between(0.01, 0.98));
  if (split.train + split.validate < 1.0) return;
  throw table.error("train", "train + validate must be below 1, so that cases remain to test");
}

/// Makes the checks of the plans and splits before a folder is made, so that the same folder can be
/// used after a correction of the file.
void check_samples(const Table& root, const StudyRequest& request, SweepRequest sweep) {
  check_different(root, "samples", request.samples);
  for (const std::int64_t samples : request.samples) {
    sweep.sample.count = samples;
    try {
      const Plan plan(sweep);
      make_split(samples, request.split);
    } catch (const InputError& e) {
      throw root.error("samples", fmt::format("{}: {}", samples, e.what()));
    }
  }
}

PublishedCell read_published_cell(const Table& table) {
  PublishedCell cell;
  cell.table = table.text_or("table", "");
  for (const std::string& parameter : table.keys()) {
    if (parameter == "table") continue;
    const Table values = table.table(parameter);
    for (std::size_t m = 0; m < kMetrics.size(); ++m) {
      const char* name = kMetrics[m].name;
      if (!values.has(name)) continue;
      cell.parameters[parameter][name] =
          values.number(name, m == kR2 ? between(kMinR2, 1.0) : above(0.0));
    }
  }
  return cell;
}

PublishedNumbers read_published(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = document.root();
  PublishedNumbers numbers;
  numbers.source = root.text("source");
  if (root.has("remarks")) numbers.remarks = root.texts("remarks");
  const Table cells = root.table("cells");
  for (const std::string& key : cells.keys()) {
    numbers.cells[key] = read_published_cell(cells.table(key));
  }
  document.check_all_read();
  return numbers;
}

/// Refuses numbers of a cell or parameter that the study does not have; they would be ignored.
void check_published(const StudyRequest& request, const std::vector<std::string>& parameters) {
  const auto require = [&](const std::string& at, const std::string& name, const char* kind,
                           const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    throw InputError(fmt::format("{}: cells.{}: not a {} of the study{}; it has {}",
                                 request.published_path.string(), at, kind,
                                 suggest_name(name, known), join_names(known)));
  };
  std::vector<std::string> keys;
  for (const StudyCell& cell : list_cells(request)) keys.push_back(make_key(request, cell));
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (const auto& [key, cell] : request.published.cells) {
    require(key, key, "cell", keys);
    for (const auto& [name, values] : cell.parameters) {
      require(key + "." + name, name, "parameter", parameters);
    }
  }
}

}  // namespace

StudyRequest read_study(const std::filesystem::path& path) {
  const Document document(path);
  const Table root = open_root(document, kStudyFile);
  StudyRequest request;
  request.path = path;
  request.title = root.text_or("title", path.stem().string());
  if (root.has("notes")) request.notes = root.texts("notes");
  request.sweep = root.file("sweep");
  const SweepRequest sweep = read_request(request.sweep);
  request.preloads = read_preloads(root);
  request.samples = read_whole_numbers(root, "samples", kMaxWhole);
  request.seeds = static_cast<int>(root.integer_or("seeds", request.seeds, 1, kMaxSeeds));
  request.networks = read_networks(root.table("networks"));
  request.inputs = read_inputs(root.table("inputs"), sweep);
  if (const auto best = root.find_table("best_instant")) read_best_instant(*best, request.preloads);
  if (const auto main = root.find_table("main")) read_main(*main, request);
  if (const auto training = root.find_table("training")) read_training(*training, request);
  check_samples(root, request, sweep);
  if (const auto noise = root.find_table("noise")) {
    request.noise =
        read_noise_request(*noise, {sweep, request.inputs[request.main_inputs].channels,
                                    list_names_of(request.networks), request.main_network});
  }
  if (root.has("published")) {
    request.published_path = root.file("published");
    request.published = read_published(request.published_path);
  }
  document.check_all_read();
  check_published(request, list_axes(sweep));
  return request;
}

std::vector<StudyCell> list_cells(const StudyRequest& request) {
  std::vector<StudyCell> cells;
  const std::size_t networks = request.networks.size(), inputs = request.inputs.size();
  cells.reserve(request.preloads.size() * (request.samples.size() * networks + 2 * inputs));
  for (std::size_t p = 0; p < request.preloads.size(); ++p) {
    for (std::size_t s = 0; s < request.samples.size(); ++s) {
      for (std::size_t n = 0; n < networks; ++n) cells.push_back({p, s, n, request.main_inputs});
    }
    const StudyCell main{p, request.main_samples, request.main_network, request.main_inputs};
    for (std::size_t i = 0; i < inputs; ++i) {
      if (i == main.inputs) continue;
      cells.push_back({p, main.samples, main.network, i});
    }
    if (!request.preloads[p].has_best) continue;
    for (std::size_t i = 0; i < inputs; ++i) {
      cells.push_back({p, main.samples, main.network, i, true});
    }
  }
  return cells;
}

bool is_main(const StudyRequest& request, const StudyCell& cell) {
  return cell.samples == request.main_samples && cell.network == request.main_network &&
         cell.inputs == request.main_inputs && !cell.best_instant;
}

std::string make_key(const StudyRequest& request, const StudyCell& cell) {
  return fmt::format("{}_{}_{}", request.networks[cell.network].name, request.samples[cell.samples],
                     request.inputs[cell.inputs].name);
}

std::string make_sweep_name(const StudyRequest& request, const StudyCell& cell) {
  return fmt::format("{}_{}{}", request.preloads[cell.preload].name, request.samples[cell.samples],
                     cell.best_instant ? "_best" : "");
}

std::string make_model_name(const StudyRequest& request, const StudyCell& cell, int seed) {
  return fmt::format("{}_{}{}_seed{}", request.preloads[cell.preload].name, make_key(request, cell),
                     cell.best_instant ? "_best" : "", seed);
}

}  // namespace strut

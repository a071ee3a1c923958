// Files in HDF5: shards, merged files, plans, networks, measurements.
#include <span>

#include "io/store/dataset.h"
#include "io/store/measurement.h"
#include "io/store/shard_layout.h"
#include "sweep/folder.h"
#include "tests/fuzz/format.h"
#include "train/data/dataset_source.h"
#include "train/model/checkpoint.h"
#include "train/model/identifier.h"
#include "train/model/model_file.h"

namespace strut::fuzz {
namespace {

namespace fs = std::filesystem;

void read_dataset(const fs::path& path) {
  for (const bool histories : {false, true}) {
    Dataset data({path}, {.partial = true, .histories = histories});
    for (std::size_t piece = 0; piece < data.piece_count(); ++piece) data.read_piece(piece);
    data.read(0, data.row_count());
  }
  Dataset data({path});
  read_usable_rows(data, {.inputs = list_names(data.schema().snapshot), .targets = {}});
}

void read_network(const fs::path& path) {
  const TrainedModel model = read_trained_model(path);
  const Identifier identifier(model);
  const std::vector<double> inputs(model.inputs.size(), 0.5);
  std::vector<double> values(model.targets.size());
  identifier.identify(inputs.data(), values.data());
  identifier.calc_jacobian(inputs.data());
}

/// Reads everything in a file with every reader.
void read_any_hdf5(const Hdf5Reader& file, const std::string& group) {
  const auto ignore = [](const auto& read) {
    try {
      read();
    } catch (const InputError&) {
    }
  };
  ignore([&] {
    for (const std::string& key : file.list_attributes(group)) {
      ignore([&] { file.read_attribute(group, key); });
      ignore([&] { file.read_integer_attribute(group, key); });
      ignore([&] { file.read_number_attribute(group, key); });
    }
  });
  for (const std::string& child : file.list(group)) {
    const std::string name = (group == "/" ? "" : group) + "/" + child;
    ignore([&] { file.read_label(name); });
    ignore([&] { file.read_chunk_rows(name); });
    ignore([&] { file.read_texts(name); });
    ignore([&] { file.read_integers(name); });
    ignore([&] { file.read(name); });
    ignore([&] { read_any_hdf5(file, name); });
  }
}

}  // namespace

std::vector<Format> list_hdf5_formats() {
  const Dictionary binary = {
      false,
      {"OHDR", "FRHP", "FHDB", "BTHD", "BTLF", "TREE", "OCHK", std::string(8, '\0'),
       std::string(8, '\xff'), "\x89HDF\r\n\x1a\n", "strut shard seal 1\n"},
      {}};
  std::vector<Format> formats = {
      {"shard",
       "input.h5",
       {"sweep/shards/000000.h5", "sweep/shards/000001.h5"},
       binary,
       [](const fs::path& path) {
         read_shard(path);
         read_dataset(path);
       }},
      {"merged", "input.h5", {"merged.h5"}, binary, read_dataset},
      {"model", "input.h5", {"model.h5", "noisy.h5", "window.h5"}, binary, read_network},
      {"checkpoint",
       "input.h5",
       {"checkpoint.h5"},
       binary,
       [](const fs::path& path) { read_checkpoint(path); }},
      {"plan",
       "sweep/plan.h5",
       {"sweep/plan.h5.seed"},
       binary,
       [](const fs::path& path) { open_sweep_folder(SweepFolder{path.parent_path()}); }},
      {"measurement",
       "input.h5",
       {"sweep/shards/000000.h5", "merged.h5"},
       binary,
       [](const fs::path& path) {
         for (const MeasuredPart part : {MeasuredPart::kSnapshot, MeasuredPart::kHistory}) {
           read_measurement(path, {.required = {"pitch_rate"},
                                   .optional = {"time"},
                                   .part = part,
                                   .missing = MissingCells::kNan});
         }
       }},
      // Damaged metadata with a valid seal, to test the library itself.
      {"hdf5_library",
       "input.h5",
       {"merged.h5", "model.h5", "sweep/plan.h5.seed"},
       binary,
       [](const fs::path& path) { read_any_hdf5(Hdf5Reader(path), "/"); }},
  };
  for (Format& format : formats) {
    format.changes = Changes::kBytesAndContent;
    // Written by other tools: only the library checks them.
    if (format.name == "measurement") format.changes = Changes::kContent;
    if (format.name != "hdf5_library") continue;
    format.changes = Changes::kSealedBytes;
    format.only_by_name = true;
  }
  return formats;
}

}  // namespace strut::fuzz

// Which columns of measured files hold which channels, in which units: the table [columns] of a
// campaign.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/format/toml_document.h"
#include "io/store/measurement.h"
#include "io/table/units.h"

namespace strut {

/// value = sign * (scale * SI(column)) + offset, in the channel's SI unit.
struct MappedColumn {
  std::string channel, column;
  std::string unit;  // of the column; "": what the file says, or SI
  std::string si;    // SI unit of the channel
  double sign = 1.0, scale = 1.0, offset = 0.0;
  bool has_sign = false;   // `sign` is given
  bool has_scale = false;  // `scale` is given: without a unit, it includes that
};

/// Reads the entry of a channel with SI unit `si`. Throws InputError with file, key and the allowed
/// values.
MappedColumn read_mapped_column(const Table& columns, const std::string& channel,
                                const std::string& si);

/// The conversion of a column in a file that says `stated` of its unit. Adds a note where the map
/// says otherwise. Throws InputError where the unit does not convert to that of the channel.
ColumnConversion find_conversion(const std::filesystem::path& file, const std::string& stated,
                                 const MappedColumn& mapped, std::vector<std::string>& notes);

/// The map of channels to columns, and windows of files; channels that are not in it stand in
/// columns of their own name.
struct ColumnMap {
  std::vector<MappedColumn> columns;
  /// By canonical path [s]; a file with several runs may have several.
  std::map<std::filesystem::path, std::vector<std::pair<double, double>>> windows;

  MappedColumn find(const ColumnInfo& channel) const;
};

/// Reads the entries of `channels` in the table [columns] of a campaign, and the windows of its
/// runs. `known`: the names that an entry may have. Throws InputError as read_mapped_column, for a
/// campaign without [columns], for an unknown name, and for a channel with a clock of its own.
ColumnMap read_column_map(const std::filesystem::path& campaign,
                          const std::vector<ColumnInfo>& channels,
                          const std::vector<std::string>& known);

/// Reads channels in SI; the result's columns have the channels' names. Of a history (`part`) with
/// one window, only its rows, which a note says. `channels`: required; `optional`: read if the file
/// has them. Throws InputError as read_measurement and find_conversion.
Measurement read_channels(const std::filesystem::path& file, MeasuredPart part,
                          const std::vector<ColumnInfo>& channels,
                          const std::vector<ColumnInfo>& optional, const ColumnMap& map);

}  // namespace strut

// A measured file as a campaign maps it: channels in SI over the file's own clock, missing samples
// marked, everything implausible told.
#pragma once

#include <string>
#include <vector>

#include "diagnose/campaign/campaign.h"

namespace strut {

struct MeasuredColumn {
  std::size_t at = 0;          // of the campaign's columns
  std::vector<double> values;  // SI; NaN: missing
  std::size_t missing = 0;
};

struct MeasuredTable {
  std::string name;           // of the file, for messages
  std::vector<double> times;  // s, ascending
  std::vector<MeasuredColumn> columns;
  std::vector<std::string> notes;  // for the user

  /// nullptr where the file does not have it.
  const MeasuredColumn* find(const std::vector<CampaignColumn>& columns,
                             const std::string& channel) const;
  double rate() const;  // 1/s, of the median interval
};

/// Reads a run's CSV or HDF5 file. A clock whose printed digits are coarser than its jitter is set
/// even (even_clock). Throws InputError with file and line or row: a column that is missing (with
/// all there are), a clock that runs backwards or stands still, a channel that is constant or
/// empty, a window without samples.
MeasuredTable read_measured_table(const Campaign& campaign, const CampaignRun& run);

/// Times printed with few digits (0.0033, 0.0067, 0.0100) as the even clock they are rounded from:
/// t_i = a + b i, where that is within `resolution` / 2 of all of them. Returns whether it is so.
/// Such rounding would else jitter every derivative by resolution / interval.
bool even_clock(std::vector<double>& times);

}  // namespace strut

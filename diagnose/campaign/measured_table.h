// A measured file as a campaign maps it: channels in SI over the file's own clock, with missing
// samples as NaN.
#pragma once

#include <string>
#include <vector>

#include "diagnose/campaign/campaign.h"

namespace strut {

struct MeasuredColumn {
  std::size_t at = 0;          // index in Campaign::columns
  std::vector<double> values;  // SI; NaN: missing
  std::size_t missing = 0;
  ColumnReading reading{};
};

struct MeasuredTable {
  std::string name;           // the file's, for messages
  std::vector<double> times;  // s, ascending
  std::vector<MeasuredColumn> columns;
  std::vector<std::string> notes;  // for the user

  /// nullptr where the file does not have it.
  const MeasuredColumn* find(const std::vector<CampaignColumn>& columns,
                             const std::string& channel) const;
  double rate() const;  // inverse of the median interval [1/s]
};

/// Reads a run's CSV or HDF5 file. A clock whose printed digits are coarser than its jitter is made
/// even (even_clock). Throws InputError with file and line or row for a missing column (with those
/// that exist), a clock that runs backwards or stands still, a constant or empty channel, and a
/// window without samples.
MeasuredTable read_measured_table(const Campaign& campaign, const CampaignRun& run);

/// Replaces times printed with few digits (0.0033, 0.0067, 0.0100) by the even clock
/// t_i = a + b i that they were rounded from, if it is within 0.75 of their resolution of each of
/// them; returns whether it is. Without this, rounding jitters every derivative by resolution /
/// interval.
bool even_clock(std::vector<double>& times);

}  // namespace strut

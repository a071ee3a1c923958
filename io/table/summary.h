// What a file of measured data holds: its columns with their statistics, and the clocks among them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/table/table_file.h"

namespace strut {

/// Of a column whose values ascend: the times of the others.
struct ClockSummary {
  double first = 0.0, last = 0.0;  // s
  double interval = 0.0;           // median [s]
  double jitter = 0.0;             // standard deviation of the intervals without gaps [s]
  std::size_t gaps = 0;            // intervals of 1.5 medians or more, beyond the jitter
  std::size_t dropped = 0;         // samples that these would have had
  double first_gap = 0.0;          // time before the first of them [s]
};

struct ColumnSummary {
  std::string name, header;
  std::string unit;          // of the file; "": none
  std::string guessed_unit;  // by the name (guess_name_unit)
  std::string fault;         // "": all values are numbers or missing
  std::size_t count = 0;     // values, missing ones included
  std::size_t missing = 0;
  double min = 0.0, max = 0.0, mean = 0.0, spread = 0.0;
  bool is_clock = false;
  int clock = -1;                    // index of the column with its times; -1: none
  ClockSummary times;                // of a clock
  std::vector<std::string> remarks;  // what is odd: "constant", "7 samples in a row at its maximum"
};

struct TableSummary {
  std::string format;
  std::vector<ColumnSummary> columns;
  std::vector<std::string> notes;
};

/// Summarizes every column. Clocks are columns of an ascending time: named so ("time", "t",
/// "Zeit"), or with a unit of time; without any of these, the first column that ascends, unless
/// another that does not is named as a time. Each other column belongs to the last clock before it
/// in its group ("group/name"), or else to the first.
TableSummary summarize_table(const TableFile& file);

/// The intervals of a clock [s]; `times` ascends and has two values or more.
ClockSummary summarize_clock(const std::vector<double>& times);

/// Whether a name says time: "t", "time", "Time (2)", "t_s", "timestamp", "Zeit", in any case.
bool is_time_name(std::string_view name);

}  // namespace strut

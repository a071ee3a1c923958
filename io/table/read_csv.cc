#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <string_view>

#include "base/text/shorten.h"
#include "io/file/file_sync.h"
#include "io/file/read_text_file.h"
#include "io/format/text_line.h"
#include "io/table/csv.h"
#include "io/table/csv_cell.h"
#include "io/table/csv_columns.h"
#include "io/table/csv_layout.h"
#include "io/table/text_encoding.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Bounds on what is read, far above any real table: the file may be something else, given by
/// mistake.
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxColumns = 16384;
/// The layout is found from the first lines, at most so many and about so many bytes.
constexpr std::size_t kHeadLines = 1000, kHeadBytes = std::size_t{1} << 22U;

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

/// kAny: the first cell decides whether the column holds numbers or clock times; kCompactClock:
/// clock times without colons.
enum class CellKind { kAny, kCompactClock };

/// Makes times since 1970, which may count milliseconds to nanoseconds, seconds since the first
/// row. A recording in seconds begins before the year 5138.
void convert_epoch(CsvColumn& column, std::vector<std::string>& notes) {
  if (!column.unit.empty() || column.values.empty()) return;
  std::string name = column.name;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.find("time") == std::string::npos) return;
  struct Unit {
    double begin, factor;
    const char* name;
  };
  constexpr Unit kUnits[] = {
      {1e17, 1e-9, "nanoseconds"}, {1e14, 1e-6, "microseconds"}, {1e11, 1e-3, "milliseconds"}};
  const double first = column.values.front();
  for (const Unit& unit : kUnits) {
    if (!(first > unit.begin)) continue;
    for (double& value : column.values) value = (value - first) * unit.factor;
    column.unit = "s";
    notes.push_back(fmt::format("{}: {} since 1970, read as seconds since the first row",
                                column.name, unit.name));
    return;
  }
}

/// Converts the cells of one column; the first cell that is a clock time makes it a clock.
class CellReader {
 public:
  CellReader(char decimal, MissingCells missing, CellKind kind)
      : decimal_(decimal), missing_(missing), kind_(kind) {}

  void add(const TextLine& line, std::string_view cell, CsvColumn& column) {
    if (!column.fault.empty()) return;
    const std::optional<double> value = read(cell);
    if (value) {
      column.values.push_back(*value);
      is_empty_ = false;
    } else if (is_missing_cell(cell)) {
      column.values.push_back(std::numeric_limits<double>::quiet_NaN());
      if (missing_ == MissingCells::kRefused && first_missing_.empty()) {
        first_missing_ = describe_fault(line, cell, column);
      }
    } else {
      column.fault = describe_fault(line, cell, column);
    }
  }

  /// Makes clock times relative to the first, and missing cells a fault where they are refused.
  void finish(CsvColumn& column) const {
    if (column.fault.empty()) column.fault = first_missing_;
    if (is_clock_) column.unit = "s";
    if (!column.fault.empty()) column.values.clear();
  }

  /// Whether no cell had a value.
  bool is_empty() const { return is_empty_; }

 private:
  static std::string describe_fault(const TextLine& line, std::string_view cell,
                                    const CsvColumn& column) {
    return line_error(line, fmt::format("{} = '{}': must be a finite number", shorten(column.name),
                                        shorten(convert_latin1(cell))))
        .what();
  }

  std::optional<double> read(std::string_view cell) {
    if (kind_ == CellKind::kCompactClock) return advance(parse_compact_clock(cell));
    if (!is_clock_) {
      if (const auto number = parse_cell_number(cell, decimal_)) return number;
      if (!is_empty_) return std::nullopt;
    }
    return advance(parse_cell_clock(cell));
  }

  std::optional<double> advance(const std::optional<CellClock>& clock) {
    if (!clock) return std::nullopt;
    is_clock_ = true;
    return clock_.advance(*clock);
  }

  char decimal_;
  MissingCells missing_;
  CellKind kind_;
  std::string first_missing_;
  bool is_clock_ = false, is_empty_ = true;
  RunningClock clock_;
};

/// Whether lines end with carriage returns alone, as far as the begin of the file shows.
bool has_old_line_ends(std::istream& stream) {
  std::string begin(std::size_t{1} << 16U, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  stream.clear();
  stream.seekg(0);
  return begin.find('\n') == std::string::npos && begin.find('\r') != std::string::npos;
}

class TableReader {
 public:
  TableReader(const fs::path& path, MissingCells missing) : missing_(missing) {
    table_.path = path;
  }

  void read(std::istream& stream) {
    std::vector<char> buffer(kMaxLineBytes + 1);
    TextLine line{table_.path};
    while (stream.getline(buffer.data(), std::ssize(buffer)) || stream.gcount() > 0) {
      ++line.number;
      if (stream.fail()) {
        throw line_error(line, fmt::format("more than {} bytes in one line; not a table of numbers",
                                           kMaxLineBytes));
      }
      is_last_whole_ = !stream.eof();
      const std::streamsize length = stream.gcount() - (stream.eof() ? 0 : 1);  // the line end
      line.text = {buffer.data(), static_cast<std::size_t>(length)};
      add_line(line);
    }
  }

  CsvTable finish() {
    if (!is_begun_) begin();
    if (table_.columns.empty()) {
      throw line_error(table_.path, 1, "no line of column names; the first line must hold them");
    }
    add_pending(is_last_whole_);
    set_comment_units();
    drop_empty_columns();
    for (std::size_t c = 0; c < table_.columns.size(); ++c) {
      readers_[c].finish(table_.columns[c]);
      convert_epoch(table_.columns[c], table_.notes);
    }
    table_.format = layout_.describe();
    return std::move(table_);
  }

 private:
  void add_line(TextLine line) {
    if (line.number == 1 && line.text.starts_with(kByteOrderMark)) {
      line.text.remove_prefix(kByteOrderMark.size());
    }
    if (line.text.find('\0') != std::string_view::npos) {
      throw line_error(line, "binary data; not a table of numbers");
    }
    while (line.text.ends_with('\r')) line.text.remove_suffix(1);
    const std::string_view text = trim(line.text, " \t");
    if (text.find_first_not_of(",;|\t ") == std::string_view::npos) return;
    if (text.starts_with(kCsvUnitsMark)) {
      units_ = {line.number, std::string(text.substr(kCsvUnitsMark.size()))};
    } else if (is_comment(text)) {
      if (!is_begun_ && head_.empty()) comment_ = text;
    } else if (is_begun_) {
      // The last line may be cut off, so each waits for the next.
      add_pending(true);
      pending_ = {line.number, std::string(line.text)};
    } else {
      head_.push_back({line.number, std::string(line.text)});
      head_bytes_ += line.text.size();
      if (head_.size() == kHeadLines || head_bytes_ > kHeadBytes) begin();
    }
  }

  /// Finds the layout and reads the lines so far.
  void begin() {
    is_begun_ = true;
    layout_ = find_csv_layout(head_);
    table_.columns = make_csv_columns(head_, layout_, comment_);
    if (table_.columns.size() > kMaxColumns) {
      throw line_error(
          table_.path, head_.front().number,
          fmt::format("{} columns; at most {} are allowed", table_.columns.size(), kMaxColumns));
    }
    for (const CsvColumn& column : table_.columns) {
      const bool is_compact = layout_.is_vbox && column.name == "time";
      readers_.emplace_back(layout_.decimal, missing_,
                            is_compact ? CellKind::kCompactClock : CellKind::kAny);
    }
    for (std::size_t i = layout_.first_row; i < head_.size(); ++i) {
      add_pending(true);
      pending_ = head_[i];
    }
  }

  void add_pending(bool is_whole) {
    if (pending_.number == 0) return;
    const TextLine line{table_.path, pending_.number, pending_.text};
    pending_.number = 0;
    std::vector<std::string_view> cells = split_cells(line.text, layout_.separator);
    const std::size_t count = table_.columns.size();
    while (cells.size() > count && cells.back().empty()) cells.pop_back();
    if (!is_whole && is_cut_off(cells)) {
      table_.notes.push_back(fmt::format("{}:{}: the last line is cut off and was left out",
                                         table_.path.string(), line.number));
      return;
    }
    if (cells.size() != count) {
      throw line_error(line,
                       fmt::format("{} cells; must be {}, one per column", cells.size(), count));
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      readers_[c].add(line, cells[c], table_.columns[c]);
    }
    shortest_last_cell_ = std::min(shortest_last_cell_, cells.back().size());
    table_.lines.push_back(line.number);
  }

  /// Whether the last line, which no line end follows, lacks cells, or has a last one that is
  /// shorter than those of all other rows of a recording.
  bool is_cut_off(const std::vector<std::string_view>& cells) const {
    constexpr std::size_t kMinRows = 20;
    const std::size_t rows = table_.row_count();
    if (cells.size() < table_.columns.size()) return rows > 0;
    return rows >= kMinRows && cells.back().size() < shortest_last_cell_;
  }

  void set_comment_units() {
    if (units_.number == 0) return;
    const auto units = split_cells(units_.text, ',');
    if (!has_names() || units.size() != table_.columns.size()) {
      throw line_error(table_.path, units_.number,
                       "the line of units must follow the names and have one unit per column");
    }
    for (std::size_t c = 0; c < units.size(); ++c) table_.columns[c].unit = std::string(units[c]);
  }

  bool has_names() const {
    return std::any_of(table_.columns.begin(), table_.columns.end(),
                       [](const CsvColumn& column) { return !column.header.empty(); });
  }

  /// Columns without a name and a value: separators at the end of every line.
  void drop_empty_columns() {
    std::vector<CsvColumn>& columns = table_.columns;
    while (has_names() && columns.back().header.empty() && columns.back().fault.empty() &&
           readers_[columns.size() - 1].is_empty()) {
      columns.pop_back();
    }
  }

  CsvTable table_;
  MissingCells missing_;
  std::vector<NumberedLine> head_;
  std::size_t head_bytes_ = 0;
  std::size_t shortest_last_cell_ = std::numeric_limits<std::size_t>::max();
  NumberedLine pending_, units_;
  std::string comment_;  // the last before the first line of another kind
  bool is_begun_ = false, is_last_whole_ = true;
  CsvLayout layout_;
  std::vector<CellReader> readers_;
};

}  // namespace

CsvTable read_csv(const fs::path& path, MissingCells missing) {
  open_regular_file(path);  // a stream would wait for the other end of a pipe
  std::unique_ptr<std::istream> stream = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*stream) throw EnvironmentError(fmt::format("{}: {}", path.string(), kNotRead));
  if (starts_as_utf16(*stream)) {
    stream = std::make_unique<std::istringstream>(convert_utf16(path, read_text_file(path)));
  } else if (has_old_line_ends(*stream)) {
    std::string text = read_text_file(path);
    std::replace(text.begin(), text.end(), '\r', '\n');
    stream = std::make_unique<std::istringstream>(std::move(text));
  }
  TableReader reader(path, missing);
  reader.read(*stream);
  if (stream->bad()) {
    throw EnvironmentError(fmt::format("{}: {} to its end", path.string(), kNotRead));
  }
  return reader.finish();
}

}  // namespace strut

#include "study/noise/limits_file.h"

#include <fmt/format.h>

#include "base/error/input_error.h"
#include "base/text/format_number.h"
#include "base/text/range.h"
#include "io/table/csv.h"
#include "model_files/parameters.h"

namespace strut {
namespace {

constexpr char kCase[] = "case", kBound[] = "_bound", kFit[] = "_fit";
constexpr char kChi2[] = "chi2_per_degree", kConverged[] = "converged", kSeconds[] = "seconds";

/// Columns of a table of `rows` rows.
class Columns {
 public:
  explicit Columns(std::size_t rows) : rows_(rows) {}

  template <class Get>
  void add(const std::string& name, const std::string& unit, const Get& get) {
    CsvColumn column{name, unit, {}};
    column.values.reserve(rows_);
    for (std::size_t i = 0; i < rows_; ++i) column.values.push_back(get(i));
    columns.push_back(std::move(column));
  }

  std::vector<CsvColumn> columns;

 private:
  std::size_t rows_;
};

/// The columns of the bounds; `get(i)` is the BoundedCase of row i.
template <class Get>
Columns make_columns(const std::vector<std::string>& parameters, std::size_t rows, const Get& get) {
  Columns made(rows);
  made.add(kCase, "", [&](std::size_t i) { return static_cast<double>(get(i).number); });
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const std::string& unit = find_parameter(parameters[p]).unit;
    made.add(parameters[p], unit, [&](std::size_t i) { return get(i).parameters[p].truth; });
    made.add(parameters[p] + kBound, unit,
             [&](std::size_t i) { return get(i).parameters[p].bound; });
  }
  return made;
}

CsvTable read_table(const std::filesystem::path& file) {
  CsvTable table = read_csv(file);
  if (table.row_count() > 0) return table;
  throw InputError(
      fmt::format("{}: no rows; remove it, and `strut study` recomputes it", file.string()));
}

BoundedCase read_case(const CsvTable& table, const std::vector<std::string>& parameters,
                      std::size_t row) {
  BoundedCase read;
  read.number = static_cast<std::int64_t>(table.column(kCase).values[row]);
  read.parameters.reserve(parameters.size());
  for (const std::string& name : parameters) {
    const double bound = table.column(name + kBound).values[row];
    if (bound > 0.0) {
      read.parameters.push_back({table.column(name).values[row], bound});
      continue;
    }
    throw InputError(fmt::format("{}:{}: {}{} = {}: must be above 0", table.path.string(),
                                 table.lines[row], name, kBound, format_number(bound)));
  }
  return read;
}

}  // namespace

std::filesystem::path find_bounds_file(const std::filesystem::path& folder,
                                       const NoiseSnapshots& snapshots) {
  return folder / fmt::format("bounds_{}.csv", snapshots.preload);
}

std::filesystem::path find_fits_file(const std::filesystem::path& folder, double scale) {
  return folder / fmt::format("fits_{}.csv", format_number(scale));
}

void write_bounds(const std::filesystem::path& file, const std::vector<std::string>& parameters,
                  const std::vector<BoundedCase>& cases) {
  const auto get = [&](std::size_t i) -> const BoundedCase& { return cases[i]; };
  write_csv(file, make_columns(parameters, cases.size(), get).columns);
}

void write_fits(const std::filesystem::path& file, const std::vector<std::string>& parameters,
                const std::vector<FittedCase>& fits) {
  const auto get = [&](std::size_t i) -> const BoundedCase& { return fits[i].bounds; };
  Columns made = make_columns(parameters, fits.size(), get);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    made.add(parameters[p] + kFit, find_parameter(parameters[p]).unit,
             [&](std::size_t i) { return fits[i].estimates[p]; });
  }
  made.add(kChi2, "", [&](std::size_t i) { return fits[i].chi2_per_degree; });
  made.add(kConverged, "", [&](std::size_t i) { return fits[i].converged ? 1.0 : 0.0; });
  made.add(kSeconds, "s", [&](std::size_t i) { return fits[i].seconds; });
  write_csv(file, made.columns);
}

std::vector<BoundedCase> read_bounds(const std::filesystem::path& file,
                                     const std::vector<std::string>& parameters) {
  const CsvTable table = read_table(file);
  std::vector<BoundedCase> cases;
  cases.reserve(table.row_count());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    cases.push_back(read_case(table, parameters, row));
  }
  return cases;
}

std::vector<FittedCase> read_fits(const std::filesystem::path& file,
                                  const std::vector<std::string>& parameters) {
  const CsvTable table = read_table(file);
  std::vector<FittedCase> fits;
  fits.reserve(table.row_count());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    FittedCase fit;
    fit.bounds = read_case(table, parameters, row);
    for (const std::string& name : parameters) {
      fit.estimates.push_back(table.column(name + kFit).values[row]);
    }
    fit.chi2_per_degree = table.column(kChi2).values[row];
    fit.converged = table.column(kConverged).values[row] != 0.0;
    fit.seconds = table.column(kSeconds).values[row];
    fits.push_back(std::move(fit));
  }
  return fits;
}

}  // namespace strut

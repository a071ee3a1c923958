#include "python/core/dataset_arrays.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>

#include "io/store/dataset.h"
#include "python/core/background.h"

namespace py = pybind11;

namespace strut {
namespace {

py::list describe(const std::vector<ColumnInfo>& columns) {
  py::list list;
  for (const ColumnInfo& c : columns) list.append(py::make_tuple(c.name, c.unit, c.description));
  return list;
}

/// Rows in ascending order of their cases.
std::vector<std::size_t> sort_rows(const std::vector<std::int64_t>& case_id) {
  std::vector<std::size_t> order(case_id.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return case_id[a] < case_id[b]; });
  return order;
}

/// A copy of rows of `width` numbers each, in another order.
template <class Number>
py::array take(const std::vector<Number>& values, std::size_t width,
               const std::vector<std::size_t>& order, bool is_table) {
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(order.size())};
  if (is_table) shape.push_back(static_cast<py::ssize_t>(width));
  py::array_t<Number> taken(shape);
  Number* to = taken.mutable_data();
  for (const std::size_t row : order) {
    to = std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * width), width, to);
  }
  return taken;
}

}  // namespace

py::dict read_dataset(const std::vector<std::filesystem::path>& paths, bool partial,
                      bool histories) {
  ShardSchema schema;
  ShardRows rows;
  std::string plan_hash;
  run_in_background([&](std::atomic<bool>&) {
    Dataset dataset(paths, {partial, histories});
    schema = dataset.schema();
    plan_hash = dataset.plan_hash();
    rows = dataset.read(0, dataset.row_count());
  });
  const std::vector<std::size_t> order = sort_rows(rows.case_id);
  py::dict all;
  all["case"] = take(rows.case_id, 1, order, false);
  all["parameters"] = take(rows.parameters, schema.parameters.size(), order, true);
  all["snapshot"] = take(rows.snapshot, schema.snapshot.size(), order, true);
  all["stratum"] = take(rows.layer, 1, order, false);
  all["status"] = take(rows.status, 1, order, false);
  all["attempt"] = take(rows.attempt, 1, order, false);
  all["event_time"] = take(rows.event_time, 1, order, false);
  all["failure_time"] = take(rows.failure_time, 1, order, false);
  py::list reasons;
  for (const std::size_t row : order) reasons.append(rows.reason[row]);
  all["reason"] = reasons;
  py::list history;
  for (const std::vector<double>& channel : rows.history) {
    history.append(take(channel, schema.history_samples, order, true));
  }
  all["history"] = history;
  all["parameter_columns"] = describe(schema.parameters);
  all["snapshot_columns"] = describe(schema.snapshot);
  all["history_columns"] = describe(schema.history);
  all["history_interval"] = schema.history_interval;
  all["plan_hash"] = plan_hash;
  return all;
}

}  // namespace strut

#include "model_files/read_force_curve.h"

#include "model/error/model_error.h"

namespace strut {
namespace {

ForceCurveSpec read_curve(const Table& table, const std::string& key, const std::string& rate_key,
                          const char* columns, void (*validate)(const ForceCurveSpec&)) {
  ForceCurveSpec curve;
  if (!table.has(key)) return curve;
  if (table.has(rate_key)) {
    throw table.error(key, "stands beside " + rate_key + "; must be one of the two");
  }
  for (const std::vector<double>& row : table.rows(key)) {
    if (row.size() != 2) {
      throw table.error(key, std::string("must be rows of two numbers, ") + columns);
    }
    curve.x.push_back(row[0]);
    curve.force.push_back(row[1]);
  }
  try {
    validate(curve);
  } catch (const ModelError& e) {
    throw table.error(key, e.what());
  }
  return curve;
}

}  // namespace

ForceCurveSpec read_damper_curve(const Table& table, const std::string& key,
                                 const std::string& rate_key) {
  return read_curve(table, key, rate_key, "[m/s, N]", validate_damper_curve);
}

ForceCurveSpec read_tire_curve(const Table& table, const std::string& key,
                               const std::string& rate_key) {
  return read_curve(table, key, rate_key, "[m, N]", validate_tire_curve);
}

}  // namespace strut

#include "model_files/read_damper_curve.h"

#include "model/error/model_error.h"

namespace strut {

DamperCurveSpec read_damper_curve(const Table& table, const std::string& key,
                                  const std::string& rate_key) {
  DamperCurveSpec curve;
  if (!table.has(key)) return curve;
  if (table.has(rate_key)) {
    throw table.error(key, "stands beside " + rate_key + "; must be one of the two");
  }
  for (const std::vector<double>& row : table.rows(key)) {
    if (row.size() != 2) throw table.error(key, "must be rows of two numbers, [m/s, N]");
    curve.speed.push_back(row[0]);
    curve.force.push_back(row[1]);
  }
  try {
    validate(curve);
  } catch (const ModelError& e) {
    throw table.error(key, e.what());
  }
  return curve;
}

}  // namespace strut

#include "jobs/case/design_report.h"

namespace strut {

std::vector<std::string> list_not_identifiable(const Sensitivity& s, const Bounds& bounds) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    if (!(bounds.bound[p] <= kIdentifiable)) names.push_back(s.parameters[p].name);
  }
  return names;
}

}  // namespace strut

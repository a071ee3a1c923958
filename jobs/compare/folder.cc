#include "jobs/compare/folder.h"

#include "jobs/output_file.h"

namespace strut {

CompareFolder find_compare_folder(const Arguments& arguments) {
  return {{find_output_folder(arguments, "compare.json", "comparison")}};
}

}  // namespace strut

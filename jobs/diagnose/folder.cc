#include "jobs/diagnose/folder.h"

#include "jobs/output_file.h"

namespace strut {

DiagnoseFolder find_diagnose_folder(const Arguments& arguments) {
  return {{find_output_folder(arguments, "verdict.json", "diagnosis")}};
}

}  // namespace strut

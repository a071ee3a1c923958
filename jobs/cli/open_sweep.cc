#include "jobs/cli/open_sweep.h"

#include <omp.h>

#include "jobs/cli/unsealed.h"

namespace strut {

OpenSweep open_sweep(const Arguments& arguments) {
  SweepFolder folder{
      arguments.only_operand(", a folder created by `strut plan SWEEP.toml -o DIR`")};
  Plan plan = open_sweep_folder(folder);
  note_unsealed(folder.plan(), kPlanSeal);
  return {std::move(folder), std::move(plan)};
}

ArgumentValue isa_value() {
  std::vector<std::string> names;
  names.reserve(list_kernels().size());
  for (const Kernel& kernel : list_kernels()) names.emplace_back(kernel.isa);
  return ArgumentValue::one_of("NAME", names);
}

const Kernel& find_kernel(const Arguments& arguments) {
  return list_kernels()[static_cast<std::size_t>(arguments.choice_or("isa", 0))];
}

int find_threads(const Arguments& arguments) {
  constexpr int kMaxThreads = 4096;
  return static_cast<int>(arguments.integer_or("threads", omp_get_num_procs(), 1, kMaxThreads));
}

}  // namespace strut

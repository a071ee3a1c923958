#include "jobs/bench.h"
namespace strut{int run_bench(const std::vector<std::string>&){return 0;}}

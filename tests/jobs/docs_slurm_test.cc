// Documents show what a cluster says. Not by itself: ctest runs it for them (tests/CMakeLists.txt).
#include <catch2/catch.hpp>
#include <cstdlib>

#include "tests/jobs/slurm_cluster.h"

namespace strut {
namespace {

TEST_CASE("The command in STRUT_SLURM_COMMAND succeeds beside a Slurm of two nodes", "[.]") {
  const char* command = std::getenv("STRUT_SLURM_COMMAND");
  REQUIRE(command != nullptr);
  const test::SlurmCluster cluster(2);
  const test::Outcome outcome = test::run_shell(command);
  INFO(outcome.out << outcome.messages);
  CHECK(outcome.code == 0);
}

}  // namespace
}  // namespace strut

#include "jobs/cli/provenance.h"

#include <unistd.h>

#include <array>

#include "base/text/build_info.h"

namespace strut {

NamedTexts make_provenance() {
  const BuildInfo& build = get_build_info();
  return {{"strut_version", build.version}, {"commit", build.commit}};
}

NamedTexts make_run_provenance() {
  const BuildInfo& build = get_build_info();
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return {{"strut_version", build.version},
          {"commit", build.commit},
          {"compiler", build.compiler},
          {"host", host.data()}};
}

}  // namespace strut

#include "jobs/cli/provenance.h"

#include "base/text/build_info.h"

namespace strut {

NamedTexts make_provenance() {
  const BuildInfo& build = get_build_info();
  return {{"strut_version", build.version}, {"commit", build.commit}};
}

}  // namespace strut

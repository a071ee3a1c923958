#include "jobs/simulate/options.h"

#include <cmath>

#include "io/config.h"

namespace strut {
namespace {

constexpr double kMaxSamples = 2e6;  // one gigabyte of history

}  // namespace

void check_rate(double rate, double duration) {
  if (duration * rate <= kMaxSamples) return;
  throw InputError("--rate = " + format_number(rate) + " Hz: must be at most " +
                   format_number(std::floor(kMaxSamples / duration)) + " Hz for " +
                   format_number(duration) + " s");
}

}  // namespace strut

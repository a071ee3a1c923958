// The options of `strut train` for noise and windows.
#pragma once

#include "io/store/shard.h"
#include "jobs/cli/arguments.h"
#include "train/train_network.h"

namespace strut {

/// --window, --align, --components, --noise, --bias, --hit-time-sigma, --copies
void add_noise_options(Arguments& arguments);

/// Sets window and noise of a request as the options say, for data of this schema; with a window
/// and no --inputs, all channels of the histories are its inputs. Noise that no option gives is
/// that of estimate/sensor_noise.h, a window's bias too; a snapshot has no bias by default. Throws
/// InputError that names the option.
void read_noise_options(const Arguments& arguments, const ShardSchema& schema,
                        TrainingRequest& request);

}  // namespace strut

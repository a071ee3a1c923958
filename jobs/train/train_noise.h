// Options of `strut train` for noise and windows.
#pragma once

#include "io/store/shard.h"
#include "jobs/cli/arguments.h"
#include "train/train_network.h"

namespace strut {

/// --window, --align, --components, --noise, --bias, --hit-time-sigma, --copies
void add_noise_options(Arguments& arguments);

/// Sets window and noise of a request from the options, for data of this schema. With a window and
/// no --inputs, all channels of the histories are inputs. Defaults of the noise, and of a window's
/// biases, are those of estimate/sensor_noise.h; snapshots have no biases by default. Throws
/// InputError that names the option.
void read_noise_options(const Arguments& arguments, const ShardSchema& schema,
                        TrainingRequest& request);

}  // namespace strut

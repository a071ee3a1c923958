// The full vehicle as a kind of model.
#pragma once

#include "model/info/model_info.h"

namespace strut {

const ModelInfo& get_car_info();

}  // namespace strut

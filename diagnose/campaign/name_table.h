// Names the table of a campaign's file in messages.
#pragma once

#include <fmt/format.h>

#include <string>

#include "base/error/input_error.h"
#include "diagnose/campaign/campaign.h"

namespace strut {

/// Calls `function` and adds the campaign's table to its InputErrors.
template <class Function>
auto name_table(const Campaign& campaign, const std::string& table, const Function& function) {
  try {
    return function();
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}: {}", campaign.path.string(), table, e.what()));
  }
}

}  // namespace strut

// The scores as a person reads them, and as a script does.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/hidden/score.h"

namespace strut::hidden {

/// "hits/total share [low, high]" with the 95 % Wilson interval; "-" for no trial.
std::string print_cell(const Cell& cell);

/// In Markdown: every gate and quantity with its target, of all trials and beside it kit by kit,
/// every count by grade, pooled and kit by kit, and the trials not answered right with the
/// runners-up. `passed`, of all trials: no gate's whole interval on the wrong side, no quantity, no
/// verdict missing.
std::string make_report(const std::vector<TrueTrial>& trials,
                        const std::map<std::string, Verdict>& verdicts, bool& passed);

/// {"cells": {METRIC: {GRADE: [hits, total]}}, "quantities": {NAME: [value, count]}, "missing": n}
std::string make_score_json(const Score& score);

}  // namespace strut::hidden

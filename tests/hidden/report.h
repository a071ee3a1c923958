// Scores as a Markdown report and as JSON.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/hidden/score.h"

namespace strut::hidden {

/// "hits/total fraction [low, high]" with the 95 % Wilson interval; "-" for no trial.
std::string print_cell(const Cell& cell);

/// In Markdown: every gate and quantity with its target, for all trials and by kit; every count by
/// grade, pooled and by kit; and the wrongly answered trials with the runners-up. `passed`, over
/// all trials: no gate has its whole interval on the wrong side, no quantity misses its target, no
/// verdict is missing.
std::string make_report(const std::vector<TrueTrial>& trials,
                        const std::map<std::string, Verdict>& verdicts, bool& passed);

/// {"cells": {METRIC: {GRADE: [hits, total]}}, "quantities": {NAME: [value, count]}, "missing": n}
std::string make_score_json(const Score& score);

}  // namespace strut::hidden

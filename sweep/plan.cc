#include "sweep/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/error/input_error.h"
#include "base/math/strata.h"
#include "model_files/parameters.h"
#include "sweep/case_order.h"
#include "sweep/random_streams.h"
#include "sweep/simulate_cases.h"

namespace strut {
namespace {

/// The ids of drawn cases are kept in memory and in the plan's file.
constexpr std::int64_t kMaxDrawn = 10'000'000;
/// Each shard is a file in one folder, a claim and a line of the journal; their list is kept in
/// memory.
constexpr std::int64_t kMaxShards = 10'000'000;

InputError count_error(const SweepRequest& request, const std::string& what) {
  return InputError(
      fmt::format("{}: sample.count = {}: {}", request.path.string(), request.sample.count, what));
}

void check_count(const SweepRequest& request) {
  const std::int64_t count = request.sample.count;
  if (count < 0) return;
  const bool levels = request.sample.method == SampleMethod::kGrid;
  if (levels && count > request.grid.size()) {
    throw count_error(request,
                      fmt::format("more than the grid has; must lie in [1, {}] or be \"all\"",
                                  request.grid.size()));
  }
  if (count > kMaxDrawn) {
    throw count_error(
        request, fmt::format("must lie in [1, {}]{}", kMaxDrawn, levels ? " or be \"all\"" : ""));
  }
}

void check_shards(const SweepRequest& request, std::int64_t cases) {
  const std::int64_t shards = (cases - 1) / request.shard_cases + 1;
  if (shards <= kMaxShards) return;
  throw InputError(fmt::format(
      "{}: {} cases in shards of {} make {} shards; at most {} are allowed, each a file in one "
      "folder: reduce sample.count or the levels in [grid], or raise shards.cases",
      request.path.string(), cases, request.shard_cases, shards, kMaxShards));
}

/// Number of cases to draw from each stratum.
std::vector<std::int64_t> allocate(const SweepRequest& request,
                                   const std::vector<Stratum>& strata) {
  std::vector<std::int64_t> populations;
  populations.reserve(strata.size());
  for (const Stratum& stratum : strata) populations.push_back(stratum.population);
  std::vector<std::int64_t> quotas = allocate_proportionally(request.sample.count, populations);
  const auto empty = std::find(quotas.begin(), quotas.end(), 0);
  if (empty == quotas.end()) return quotas;
  // The smallest count whose proportional allocation gives every stratum at least one case.
  const std::int64_t smallest = *std::min_element(populations.begin(), populations.end());
  const std::int64_t enough = (request.grid.size() + smallest - 1) / smallest;
  throw count_error(
      request, fmt::format("leaves stratum {} of {} empty; allowed: at least {}, or fewer strata",
                           empty - quotas.begin() + 1, strata.size(), enough));
}

/// Sets the number of drawn cases of each stratum; returns their ids, or nothing if all run.
std::optional<std::vector<std::int64_t>> draw_cases(const SweepRequest& request,
                                                    const CasePoints& points, Strata& strata) {
  const bool all = points.method() != SampleMethod::kGrid || request.sample.count < 0;
  if (all) {
    for (Stratum& stratum : strata.list) stratum.drawn = stratum.population;
    return std::nullopt;
  }
  const std::vector<std::int64_t> quotas = allocate(request, strata.list);
  for (std::size_t i = 0; i < quotas.size(); ++i) strata.list[i].drawn = quotas[i];
  const Permutation order(points.size(), request.sample.seed, get_stream(RandomStream::kDraw));
  return draw_stratified(quotas, order,
                         [&](std::int64_t id) { return calc_stratum(strata, points, id); });
}

ColumnInfo describe(const ParameterInfo& p) { return {p.name, p.unit, p.description}; }

std::vector<ColumnInfo> describe(const std::vector<int>& channels) {
  std::vector<ColumnInfo> columns;
  columns.reserve(channels.size());
  for (const int channel : channels) {
    const ChannelInfo& info = list_car_channels()[static_cast<std::size_t>(channel)];
    columns.push_back({info.name, info.unit, info.description});
  }
  return columns;
}

}  // namespace

struct Plan::State {
  explicit State(const SweepRequest& asked)
      : request(asked),
        points(request),
        strata(make_strata(request, points)),
        order(request, points, draw_cases(request, points, strata)) {
    check_shards(request, order.size());
    facts = list_facts(request);
    hash = calc_hash(facts);
    for (const Axis& axis : request.grid.axes()) parameters.push_back(&find_parameter(axis.name));
  }

  const SweepRequest request;
  const CasePoints points;
  Strata strata;
  const CaseOrder order;
  Facts facts;
  std::string hash;
  std::vector<const ParameterInfo*> parameters;  // one per axis
};

Plan::Plan(const SweepRequest& request) {
  check_count(request);
  state_ = std::make_unique<State>(request);
}

Plan::~Plan() = default;
Plan::Plan(Plan&&) noexcept = default;
Plan& Plan::operator=(Plan&&) noexcept = default;

const SweepRequest& Plan::request() const { return state_->request; }
const std::string& Plan::hash() const { return state_->hash; }
const Facts& Plan::facts() const { return state_->facts; }
const std::vector<Stratum>& Plan::strata() const { return state_->strata.list; }
std::int64_t Plan::point_count() const { return state_->points.size(); }
std::int64_t Plan::case_count() const { return state_->order.size(); }

std::int64_t Plan::shard_count() const {
  const std::int64_t cases = request().shard_cases;
  return case_count() / cases + (case_count() % cases != 0 ? 1 : 0);
}

std::pair<std::int64_t, std::int64_t> Plan::shard_range(std::int64_t shard) const {
  const std::int64_t first = shard * request().shard_cases;
  return {first, std::min(first + request().shard_cases, case_count())};
}

std::int64_t Plan::shard_size(std::int64_t shard) const {
  const auto [first, last] = shard_range(shard);
  return last - first;
}

std::vector<std::int64_t> Plan::list_drawn() const { return state_->order.list_drawn(); }

std::int64_t Plan::calc_case_id(std::int64_t position) const {
  return state_->order.calc_case_id(position);
}

std::int64_t Plan::find_position(std::int64_t case_id) const {
  return state_->order.find_position(case_id);
}

void Plan::calc_parameters(std::int64_t case_id, std::span<double> values) const {
  state_->points.calc_values(case_id, values);
}

int Plan::calc_stratum(std::int64_t case_id) const {
  return strut::calc_stratum(state_->strata, state_->points, case_id);
}

Case Plan::make_case(std::int64_t case_id) const {
  Case c = request().base;
  std::vector<double> values(state_->parameters.size());
  calc_parameters(case_id, values);
  // Not checked against the range: the last level may exceed its bound by rounding.
  for (std::size_t a = 0; a < values.size(); ++a) state_->parameters[a]->set(c, values[a]);
  return c;
}

SweepExtent Plan::make_extent() const {
  return {hash(), point_count(), case_count(), request().shard_cases, list_drawn()};
}

ShardSchema Plan::make_schema() const {
  ShardSchema schema;
  schema.parameters.reserve(state_->parameters.size());
  for (const ParameterInfo* p : state_->parameters) schema.parameters.push_back(describe(*p));
  if (request().snapshot.on) schema.snapshot = describe(request().snapshot.channels);
  if (request().history.rate > 0.0) {
    const SamplePlan samples = make_sample_plan(request());
    schema.history = describe(request().history.channels);
    schema.history_samples = static_cast<std::size_t>(count_samples(samples));
    schema.history_interval = samples.interval;
  }
  schema.status_meaning = describe_case_status();
  return schema;
}

}  // namespace strut

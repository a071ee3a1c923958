#include "sweep/plan.h"

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

/// Numbers of drawn cases are kept in memory and in the plan's file.
constexpr std::int64_t kMostDrawn = 10'000'000;
/// Each is a file in one folder, a claim and a line of the journal; a list of them is kept in
/// memory.
constexpr std::int64_t kMaxShards = 10'000'000;

InputError count_error(const SweepRequest& request, const std::string& what) {
  return InputError(request.path.string() +
                    ": sample.count = " + std::to_string(request.sample.count) + ": " + what);
}

void check_count(const SweepRequest& request) {
  const std::int64_t count = request.sample.count;
  if (count < 0) return;
  const bool levels = request.sample.method == SampleMethod::kGrid;
  if (levels && count > request.grid.size()) {
    throw count_error(request, "more than the grid has; must lie in [1, " +
                                   std::to_string(request.grid.size()) + "] or be \"all\"");
  }
  if (count > kMostDrawn) {
    throw count_error(request, "must lie in [1, " + std::to_string(kMostDrawn) + "]" +
                                   (levels ? " or be \"all\"" : ""));
  }
}

void check_shards(const SweepRequest& request, std::int64_t cases) {
  const std::int64_t shards = (cases - 1) / request.shard_cases + 1;
  if (shards <= kMaxShards) return;
  throw InputError(request.path.string() + ": " + std::to_string(cases) + " cases in shards of " +
                   std::to_string(request.shard_cases) + " make " + std::to_string(shards) +
                   " shards; at most " + std::to_string(kMaxShards) +
                   " can be run, each a file in one folder: allow fewer by sample.count, fewer "
                   "levels in [grid] or more cases a shard in [shards]");
}

std::vector<std::int64_t> allocate(const SweepRequest& request, const std::vector<Layer>& layers) {
  std::vector<std::int64_t> populations;
  populations.reserve(layers.size());
  for (const Layer& layer : layers) populations.push_back(layer.population);
  std::vector<std::int64_t> quotas = allocate_proportionally(request.sample.count, populations);
  const auto empty = std::find(quotas.begin(), quotas.end(), 0);
  if (empty == quotas.end()) return quotas;
  // Each layer's share of this many is at least one.
  const std::int64_t least = *std::min_element(populations.begin(), populations.end());
  const std::int64_t enough = (request.grid.size() + least - 1) / least;
  throw count_error(request, "leaves layer " + std::to_string(empty - quotas.begin() + 1) + " of " +
                                 std::to_string(layers.size()) + " empty; allowed: at least " +
                                 std::to_string(enough) + ", or fewer strata");
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
      : request(asked), points(request), rule(request, points), layers(rule.layers()) {
    order.emplace(request, points, draw());
    check_shards(request, order->size());
    facts = list_facts(request);
    hash = calc_hash(facts);
    for (const Axis& axis : request.grid.axes()) parameters.push_back(&find_parameter(axis.name));
  }

  /// Sets how many each layer gives; nothing where all run.
  std::optional<std::vector<std::int64_t>> draw() {
    const bool all = points.method() != SampleMethod::kGrid || request.sample.count < 0;
    if (all) {
      for (Layer& layer : layers) layer.drawn = layer.population;
      return std::nullopt;
    }
    const std::vector<std::int64_t> quotas = allocate(request, layers);
    for (std::size_t i = 0; i < layers.size(); ++i) layers[i].drawn = quotas[i];
    const Permutation walk(points.size(), request.sample.seed, get_stream(RandomStream::kDraw));
    return draw_stratified(quotas, walk, [this](std::int64_t id) { return rule.calc_layer(id); });
  }

  const SweepRequest request;
  const CasePoints points;
  const LayerRule rule;
  std::vector<Layer> layers;
  std::optional<CaseOrder> order;
  Facts facts;
  std::string hash;
  std::vector<const ParameterInfo*> parameters;  // of each axis
};

Plan::Plan(const SweepRequest& request) {
  check_count(request);
  state_ = std::make_unique<State>(request);
}

Plan::~Plan() = default;
Plan::Plan(Plan&&) noexcept = default;

const SweepRequest& Plan::request() const { return state_->request; }
const std::string& Plan::hash() const { return state_->hash; }
const Facts& Plan::facts() const { return state_->facts; }
const std::vector<Layer>& Plan::layers() const { return state_->layers; }
std::int64_t Plan::point_count() const { return state_->points.size(); }
std::int64_t Plan::case_count() const { return state_->order->size(); }

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

std::vector<std::int64_t> Plan::list_drawn() const { return state_->order->list_drawn(); }

std::int64_t Plan::calc_case_id(std::int64_t position) const {
  return state_->order->calc_case_id(position);
}

std::int64_t Plan::find_position(std::int64_t case_id) const {
  return state_->order->find_position(case_id);
}

void Plan::calc_parameters(std::int64_t case_id, std::span<double> values) const {
  state_->points.calc_values(case_id, values);
}

int Plan::calc_layer(std::int64_t case_id) const { return state_->rule.calc_layer(case_id); }

Case Plan::make_case(std::int64_t case_id) const {
  Case c = request().base;
  std::vector<double> values(state_->parameters.size());
  calc_parameters(case_id, values);
  // No check of the range here: the last level may be a rounding beyond the bound it stands for.
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

#include "estimate/reading_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "estimate/sensor_error.h"

namespace strut {

std::vector<double> set_variant(std::vector<double> values, const RunVariant& variant) {
  if (variant.unknown != kNoUnknown) values[variant.unknown] = variant.value;
  return values;
}

std::vector<RunVariant> list_variants(const std::vector<Unknown>& unknowns, std::size_t run_count,
                                      const std::vector<double>& values, double relative_step) {
  std::vector<RunVariant> variants;
  variants.reserve(run_count * (1 + 2 * unknowns.size()));
  for (std::size_t run = 0; run < run_count; ++run) {
    variants.push_back({run, kNoUnknown, 0.0});
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      if (!is_simulated(unknowns[i]) || !belongs(unknowns[i], run)) continue;
      const auto [upper, lower] = calc_sides(unknowns[i], values[i], relative_step);
      variants.push_back({run, i, upper});
      variants.push_back({run, i, lower});
    }
  }
  return variants;
}

std::pair<double, double> calc_sides(const Unknown& u, double value, double relative_step) {
  const double h = relative_step * u.scale;
  const double center = std::max(u.low + h, std::min(u.high - h, value));
  return {center + h, center - h};
}

ReadingModel::ReadingModel(std::vector<MeasuredRun> runs, std::vector<Unknown> unknowns)
    : runs_(std::move(runs)), unknowns_(std::move(unknowns)) {
  if (runs_.empty()) throw InputError("fit: no measurement");
  check_unknowns(unknowns_, runs_.size());
  for (const MeasuredRun& run : runs_) {
    check_measured_run(run);
    channels_.emplace_back();
    for (const MeasuredChannel& c : run.channels) channels_.back().push_back(c.channel);
  }
}

void ReadingModel::add_reading_rows(std::size_t run, std::size_t time) {
  const std::vector<MeasuredChannel>& channels = runs_[run].channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (std::isfinite(channels[c].values[time])) readings_.push_back({run, time, c});
  }
}

void ReadingModel::finish() {
  prior_count_ = static_cast<std::size_t>(std::count_if(
      unknowns_.begin(), unknowns_.end(), [](const Unknown& u) { return u.prior.informs(); }));
  if (reading_count() + prior_count_ >= unknowns_.size()) return;
  throw InputError(
      fmt::format("{}: {} readings within the simulated time are too few for {} unknowns",
                  runs_.front().name, reading_count(), unknowns_.size()));
}

std::string ReadingModel::linearize_road(const std::vector<double>& /*values*/, std::size_t /*run*/,
                                         const TakeColumns& /*take*/) {
  return "";
}

Linearization ReadingModel::make_linearization(std::string failure) const {
  if (!failure.empty()) return {std::move(failure), {}, {}};
  return {"", Eigen::VectorXd::Zero(row_count()),
          Eigen::MatrixXd::Zero(row_count(), static_cast<Eigen::Index>(unknowns_.size()))};
}

ReadingModel::ChannelReadings ReadingModel::collect_channel(
    std::size_t run, std::size_t channel, const std::vector<double>& simulated) const {
  ChannelReadings collected;
  for (std::size_t k = begin_row(run); k < begin_row(run + 1); ++k) {
    if (readings_[k].channel != channel) continue;
    collected.rows.push_back(k);
    collected.times.push_back(runs_[run].times[readings_[k].time]);
    collected.values.push_back(simulated[k - begin_row(run)]);
  }
  return collected;
}

void ReadingModel::fill_residual(std::size_t run, const std::vector<double>& values,
                                 const std::vector<double>& simulated,
                                 Eigen::VectorXd& residual) const {
  for (std::size_t channel = 0; channel < runs_[run].channels.size(); ++channel) {
    const MeasuredChannel& c = runs_[run].channels[channel];
    ChannelReadings at = collect_channel(run, channel, simulated);
    add_sensor_error(collect_sensor_error(unknowns_, values, run, c.channel), at.times, at.values);
    for (std::size_t i = 0; i < at.rows.size(); ++i) {
      const double measured = c.values[readings_[at.rows[i]].time];
      residual(static_cast<Eigen::Index>(at.rows[i])) = (at.values[i] - measured) / c.sigma;
    }
  }
}

void ReadingModel::fill_sensor_columns(std::size_t run, const std::vector<double>& simulated,
                                       Linearization& out) const {
  for (std::size_t channel = 0; channel < runs_[run].channels.size(); ++channel) {
    const MeasuredChannel& c = runs_[run].channels[channel];
    const ChannelReadings at = collect_channel(run, channel, simulated);
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const Unknown& u = unknowns_[i];
      if (!is_sensor_error(u) || u.channel != c.channel || !belongs(u, run)) continue;
      const std::vector<double> slopes = calc_error_slopes(u.kind, at.times, at.values);
      for (std::size_t k = 0; k < at.rows.size(); ++k) {
        out.jacobian(static_cast<Eigen::Index>(at.rows[k]), static_cast<Eigen::Index>(i)) =
            slopes[k] * u.scale / c.sigma;
      }
    }
  }
}

void ReadingModel::fill_prior_residuals(const std::vector<double>& values,
                                        Eigen::VectorXd& residual) const {
  auto row = static_cast<Eigen::Index>(reading_count());
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Prior& prior = unknowns_[i].prior;
    if (prior.informs()) residual(row++) = (values[i] - prior.mean) / prior.sigma;
  }
}

void ReadingModel::fill_priors(const std::vector<double>& values, Linearization& out) const {
  fill_prior_residuals(values, out.residual);
  auto row = static_cast<Eigen::Index>(reading_count());
  for (std::size_t i = 0; i < unknowns_.size(); ++i) {
    const Unknown& u = unknowns_[i];
    if (!u.prior.informs()) continue;
    out.jacobian(row++, static_cast<Eigen::Index>(i)) = u.scale / u.prior.sigma;
  }
}

std::vector<RunBlock> list_blocks(const ReadingModel& model) {
  std::vector<RunBlock> blocks;
  const std::vector<ReadingPlace>& readings = model.readings();
  for (std::size_t k = 0; k < readings.size();) {
    RunBlock block;
    const std::size_t run = readings[k].run;
    block.begin = static_cast<Eigen::Index>(k);
    while (k < readings.size() && readings[k].run == run) ++k;
    block.count = static_cast<Eigen::Index>(k) - block.begin;
    for (std::size_t i = 0; i < model.unknowns().size(); ++i) {
      if (belongs(model.unknowns()[i], run)) {
        block.unknowns.push_back(static_cast<Eigen::Index>(i));
      }
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

Eigen::MatrixXd get_block(const Eigen::MatrixXd& jacobian, const RunBlock& block) {
  Eigen::MatrixXd part(block.count, static_cast<Eigen::Index>(block.unknowns.size()));
  for (Eigen::Index i = 0; i < part.cols(); ++i) {
    part.col(i) =
        jacobian.col(block.unknowns[static_cast<std::size_t>(i)]).segment(block.begin, block.count);
  }
  return part;
}

NormalEquations calc_normal_equations(const ReadingModel& model, const Linearization& at) {
  const auto readings = static_cast<Eigen::Index>(model.reading_count());
  const auto priors = at.jacobian.bottomRows(at.jacobian.rows() - readings);
  NormalEquations normal;
  normal.of_priors = priors.transpose() * priors;
  normal.information = normal.of_priors;
  normal.gradient = priors.transpose() * at.residual.tail(priors.rows());
  for (const RunBlock& block : list_blocks(model)) {
    const Eigen::MatrixXd part = get_block(at.jacobian, block);
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(part.cols(), part.cols());
    products.selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    products = Eigen::MatrixXd(products.selfadjointView<Eigen::Lower>());
    normal.information(block.unknowns, block.unknowns) += products;
    normal.gradient(block.unknowns) +=
        part.transpose() * at.residual.segment(block.begin, block.count);
  }
  return normal;
}

}  // namespace strut

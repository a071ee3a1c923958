#include "estimate/instants.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace strut {
namespace {

/// The instant, none of `taken`, whose information added to `sum` minimizes the criterion.
std::size_t find_best(const std::vector<Eigen::MatrixXd>& informations, const Eigen::MatrixXd& sum,
                      const std::vector<std::size_t>& taken, SpreadCriterion& criterion) {
  std::size_t best = 0;
  double min_value = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd trial(sum.rows(), sum.cols());
  for (std::size_t i = 0; i < informations.size(); ++i) {
    if (std::find(taken.begin(), taken.end(), i) != taken.end()) continue;
    trial = sum + informations[i];
    const double value = criterion.calc(trial);
    if (value < min_value) {
      min_value = value;
      best = i;
    }
  }
  return best;
}

/// Exchanges one instant of a choice for a better one, if any; returns whether it did.
bool exchange(const std::vector<Eigen::MatrixXd>& informations, std::size_t slot,
              SpreadCriterion& criterion, InstantChoice& choice) {
  constexpr double kMaxRatio = 1.0 - 1e-9;  // above, improvements are rounding and could cycle
  std::vector<std::size_t> others = choice.instants;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(slot));
  Eigen::MatrixXd rest =
      Eigen::MatrixXd::Zero(choice.information.rows(), choice.information.cols());
  for (const std::size_t i : others) rest += informations[i];
  const std::size_t best = find_best(informations, rest, others, criterion);
  const Eigen::MatrixXd sum = rest + informations[best];
  if (!(criterion.calc(sum) < kMaxRatio * criterion.calc(choice.information))) return false;
  choice.instants[slot] = best;
  choice.information = sum;
  return true;
}

/// Adds instants greedily to `first`, then exchanges until no exchange helps.
InstantChoice search_from(const std::vector<Eigen::MatrixXd>& informations, std::size_t first,
                          std::size_t count, SpreadCriterion& criterion) {
  InstantChoice choice{{first}, informations[first]};
  while (choice.instants.size() < count) {
    choice.instants.push_back(
        find_best(informations, choice.information, choice.instants, criterion));
    choice.information += informations[choice.instants.back()];
  }
  std::size_t unchanged = 0;
  for (std::size_t slot = 0; unchanged < count; slot = (slot + 1) % count) {
    unchanged = exchange(informations, slot, criterion, choice) ? 0 : unchanged + 1;
  }
  std::sort(choice.instants.begin(), choice.instants.end());
  return choice;
}

}  // namespace

Eigen::MatrixXd calc_information(const Sensitivity& s, const Instant& instant,
                                 const std::vector<int>& channels, const SensorNoise& noise) {
  const auto n = static_cast<Eigen::Index>(s.parameters.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd row(n);
  for (const int channel : channels) {
    const double sigma = noise[static_cast<std::size_t>(channel)];
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto parameter = static_cast<std::size_t>(p);
      const double percent = 0.01 * s.parameters[parameter].scale;
      row(p) = s.get(instant, channel, parameter) * percent / sigma;
    }
    information.noalias() += row * row.transpose();
  }
  return information;
}

std::vector<Eigen::MatrixXd> calc_informations(const Sensitivity& s,
                                               const std::vector<int>& channels,
                                               const SensorNoise& noise) {
  std::vector<Eigen::MatrixXd> informations;
  informations.reserve(s.instants.size());
  for (const Instant& instant : s.instants) {
    informations.push_back(calc_information(s, instant, channels, noise));
  }
  return informations;
}

Eigen::MatrixXd sum_informations(const std::vector<Eigen::MatrixXd>& informations) {
  Eigen::MatrixXd sum = informations.front();
  for (std::size_t i = 1; i < informations.size(); ++i) sum += informations[i];
  return sum;
}

InstantChoice choose_instants(const std::vector<Eigen::MatrixXd>& informations, int count) {
  constexpr std::size_t kStarts = 6;
  const auto size = static_cast<std::size_t>(count);
  SpreadCriterion criterion(informations.front().rows());
  const Eigen::MatrixXd none = 0.0 * informations.front();
  const std::size_t alone = find_best(informations, none, {}, criterion);
  InstantChoice best = search_from(informations, alone, size, criterion);
  if (count == 1) return best;
  for (std::size_t start = 0; start < kStarts; ++start) {
    const std::size_t first = (2 * start + 1) * informations.size() / (2 * kStarts);
    InstantChoice other = search_from(informations, first, size, criterion);
    if (criterion.calc(other.information) < criterion.calc(best.information)) {
      best = std::move(other);
    }
  }
  return best;
}

int choose_sensor(const Sensitivity& s, const Instant& instant, const std::vector<int>& channels,
                  const std::vector<int>& candidates, const SensorNoise& noise) {
  const Eigen::MatrixXd present = calc_information(s, instant, channels, noise);
  SpreadCriterion criterion(present.rows());
  int best = -1;
  double min_value = std::numeric_limits<double>::infinity();
  for (const int candidate : candidates) {
    if (std::find(channels.begin(), channels.end(), candidate) != channels.end()) continue;
    const double value = criterion.calc(present + calc_information(s, instant, {candidate}, noise));
    if (value < min_value) {
      min_value = value;
      best = candidate;
    }
  }
  return best;
}

}  // namespace strut

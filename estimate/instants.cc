#include "estimate/instants.h"

#include <algorithm>
#include <limits>

namespace strut {
namespace {

/// Searches sets of instants; keeps the sum of the information of the set in hand.
class InstantSearch {
 public:
  explicit InstantSearch(const std::vector<Eigen::MatrixXd>& informations)
      : informations_(informations),
        criterion_(informations.front().rows()),
        trial_(informations.front()) {}

  /// The instant that adds most to `sum`, none of `taken`.
  std::size_t find_best(const Eigen::MatrixXd& sum, const std::vector<std::size_t>& taken) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < informations_.size(); ++i) {
      if (std::find(taken.begin(), taken.end(), i) != taken.end()) continue;
      trial_ = sum + informations_[i];
      const double value = criterion_.calc(trial_);
      if (value < least) {
        least = value;
        best = i;
      }
    }
    return best;
  }

  /// Greedy from `first`, then exchanges until none helps.
  InstantChoice improve(std::size_t first, std::size_t count) {
    InstantChoice choice{{first}, informations_[first]};
    while (choice.instants.size() < count) {
      choice.instants.push_back(find_best(choice.information, choice.instants));
      choice.information += informations_[choice.instants.back()];
    }
    std::size_t unchanged = 0;
    for (std::size_t slot = 0; unchanged < count; slot = (slot + 1) % count) {
      unchanged = exchange(choice, slot) ? 0 : unchanged + 1;
    }
    std::sort(choice.instants.begin(), choice.instants.end());
    return choice;
  }

  double calc_criterion(const InstantChoice& choice) { return criterion_.calc(choice.information); }

 private:
  bool exchange(InstantChoice& choice, std::size_t slot) {
    constexpr double kGain = 1.0 - 1e-9;  // less would be rounding, and might go round in circles
    std::vector<std::size_t> others = choice.instants;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(slot));
    Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(trial_.rows(), trial_.cols());
    for (const std::size_t i : others) rest += informations_[i];
    const std::size_t best = find_best(rest, others);
    const Eigen::MatrixXd sum = rest + informations_[best];
    if (!(criterion_.calc(sum) < kGain * criterion_.calc(choice.information))) return false;
    choice.instants[slot] = best;
    choice.information = sum;
    return true;
  }

  const std::vector<Eigen::MatrixXd>& informations_;
  SpreadCriterion criterion_;
  Eigen::MatrixXd trial_;
};

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
  InstantSearch search(informations);
  const Eigen::MatrixXd none = 0.0 * informations.front();
  InstantChoice best = search.improve(search.find_best(none, {}), static_cast<std::size_t>(count));
  if (count == 1) return best;
  for (std::size_t start = 0; start < kStarts; ++start) {
    const std::size_t first = (2 * start + 1) * informations.size() / (2 * kStarts);
    InstantChoice other = search.improve(first, static_cast<std::size_t>(count));
    if (search.calc_criterion(other) < search.calc_criterion(best)) best = std::move(other);
  }
  return best;
}

int choose_sensor(const Sensitivity& s, const Instant& instant, const std::vector<int>& channels,
                  const std::vector<int>& candidates, const SensorNoise& noise) {
  const Eigen::MatrixXd present = calc_information(s, instant, channels, noise);
  SpreadCriterion criterion(present.rows());
  int best = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const int candidate : candidates) {
    if (std::find(channels.begin(), channels.end(), candidate) != channels.end()) continue;
    const double value = criterion.calc(present + calc_information(s, instant, {candidate}, noise));
    if (value < least) {
      least = value;
      best = candidate;
    }
  }
  return best;
}

}  // namespace strut

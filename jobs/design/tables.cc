#include "jobs/design/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/text/format_number.h"
#include "base/text/range.h"

namespace strut {
namespace {

constexpr double kMaxPercent = 1e4;  // larger bounds are shown as "free"
constexpr std::size_t kSlices = 12;  // rows of the table along the way
constexpr int kLabelWidth = 26;

/// Three digits of a bound; "free" where `percent`, the bound in per cent, is too large.
std::string format_bound(double value, double percent) {
  return percent <= kMaxPercent ? fmt::format("{:.3g}", value) : "free";
}

std::string format_percent_bound(double percent) { return format_bound(percent, percent); }

void print_head(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  std::cout << "base point:";
  for (const SensitivityParameter& p : s.parameters) {
    std::cout << fmt::format("  {} {} {}", p.name, format_number(p.base), p.unit);
  }
  std::cout << "\nchannels, 1 sigma of their noise:";
  for (const int channel : report.channels) {
    const ChannelInfo& info = get_channel(channel);
    const double sigma = report.noise[static_cast<std::size_t>(channel)];
    std::cout << fmt::format("\n  {:<{}}{} {}", info.name, kLabelWidth, format_number(sigma),
                             info.unit);
  }
  const WorstCurve worst = find_worst_curve(s, report.channels);
  std::cout << fmt::format("\ndifferences: half-step error at most {:.1e} ({} by {})\n",
                           worst.error, get_channel(worst.channel).name,
                           s.parameters[worst.parameter].name);
}

void print_columns(const std::vector<SensitivityParameter>& parameters, const char* first) {
  std::cout << fmt::format("\n{:<{}}  time s  offset m  condition   rms %", first, kLabelWidth);
  for (const SensitivityParameter& p : parameters) std::cout << fmt::format("  {:>20}", p.name);
  std::cout << fmt::format("\n{:{}}", "", kLabelWidth + 37);
  for (const SensitivityParameter& p : parameters) {
    std::cout << fmt::format("  {:>12}       %", p.unit);
  }
  std::cout << "\n";
}

void print_bounds(const Sensitivity& s, const std::string& label, const std::string& position,
                  const Bounds& bounds) {
  const std::string condition =
      std::isfinite(bounds.condition) ? fmt::format("{:.2g}", bounds.condition) : "singular";
  std::cout << fmt::format("{:<{}}{:<18}  {:>9}  {:>6}", label, kLabelWidth, position, condition,
                           format_percent_bound(bounds.rms));
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    const double bound = bounds.bound[p];
    std::cout << fmt::format("  {:>12}  {:>6}",
                             format_bound(to_unit(s.parameters[p], bound), bound),
                             format_percent_bound(bound));
  }
  std::cout << "\n";
}

std::string format_position(const Instant& instant) {
  return fmt::format("{:8.4f}  {:8.3f}", instant.time, instant.offset);
}

void print_instants(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  const Design& design = report.design;
  print_columns(s.parameters, "bounds, 1 sigma");
  print_bounds(s, "the sweep's instant", format_position(s.snapshot), design.snapshot);
  for (const DesignChoice& choice : design.best) {
    const std::size_t count = choice.instants.size();
    const std::string label = count == 1 ? "best instant" : fmt::format("best {} instants", count);
    print_bounds(s, label, format_position(s.instants[choice.instants[0]]), choice.bounds);
    for (std::size_t i = 1; i < count; ++i) {
      std::cout << fmt::format("{:<{}}{}\n", "  and", kLabelWidth,
                               format_position(s.instants[choice.instants[i]]));
    }
  }
  print_bounds(s, fmt::format("all {} instants", s.instants.size()), "", design.window);
  std::cout << fmt::format(
      "(noise independent per sample at {} Hz; bounds of all instants fall with "
      "the square root of the rate)\n",
      format_number(s.rate));
}

/// Prints the best instant in each of kSlices equal parts of the way.
void print_way(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  const auto& scan = report.design.scan;
  print_columns(s.parameters, "along the way, best of");
  for (std::size_t slice = 0; slice < kSlices; ++slice) {
    const std::size_t begin = slice * scan.size() / kSlices;
    const std::size_t end = (slice + 1) * scan.size() / kSlices;
    if (begin == end) continue;
    std::size_t best = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (scan[i].rms < scan[best].rms) best = i;
    }
    const std::string label =
        fmt::format("  {:.3f} to {:.3f} s", s.instants[begin].time, s.instants[end - 1].time);
    print_bounds(s, label, format_position(s.instants[best]), scan[best]);
  }
}

void print_sensors(const DesignReport& report) {
  constexpr int kWidth = 46;
  std::cout << fmt::format("\n{:<{}}  sweep's instant   best instant  (offset m)   all instants\n",
                           "sensors: rms of the bounds, %", kWidth);
  for (const SensorSet& set : report.design.sensors) {
    const Instant& best = report.sensitivity.instants[set.best.instants[0]];
    std::cout << fmt::format("{:<{}}  {:>15}   {:>12}  {:10.3f}   {:>12}\n", set.label, kWidth,
                             format_percent_bound(set.snapshot.rms),
                             format_percent_bound(set.best.bounds.rms), best.offset,
                             format_percent_bound(set.window.rms));
  }
}

std::string describe_combination(const Sensitivity& s, const Bounds& bounds) {
  constexpr double kMinPart = 0.05;
  std::string text;
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    const double part = bounds.weakest[p];
    if (std::abs(part) < kMinPart) continue;
    text += text.empty() ? (part < 0.0 ? "-" : "") : (part < 0.0 ? " - " : " + ");
    text += fmt::format("{:.2f} {}", std::abs(part), s.parameters[p].name);
  }
  return text + " (per cent each)";
}

void print_weakness(const DesignReport& report, const char* where, const Bounds& bounds) {
  const Sensitivity& s = report.sensitivity;
  const std::string bound = std::isfinite(bounds.weakest_bound)
                                ? fmt::format("{:.3g} %", bounds.weakest_bound)
                                : "unknown: F is singular";
  std::cout << fmt::format("least known {}: {}, {}\n", where, describe_combination(s, bounds),
                           bound);
  for (const std::string& name : list_not_identifiable(s, bounds)) {
    std::cout << fmt::format("not identifiable {}: {} (1 sigma above 100 %)\n", where, name);
  }
}

void print_proposal(const DesignReport& report) {
  const Design& design = report.design;
  const Bounds& best = design.best[0].bounds;
  const Sensitivity& s = report.sensitivity;
  const Instant& instant = s.instants[design.best[0].instants[0]];
  const auto range = find_good_range(design);
  std::cout << "\n";
  print_weakness(report, "at the sweep's instant", design.snapshot);
  print_weakness(report, "by all instants", design.window);
  if (!(best.rms < design.snapshot.rms)) {
    std::cout << "the sweep's instant is the best one\n";
    return;
  }
  std::cout << fmt::format(
      "best instant: offset = {0:.3f} m; put `offset = {0:.3f}` into [record] snapshot: rms of the "
      "bounds {1} -> {2} %,\nless than 10 % more from {3:.3f} to {4:.3f} m\n",
      instant.offset, format_percent_bound(design.snapshot.rms), format_percent_bound(best.rms),
      s.instants[range.first].offset, s.instants[range.second].offset);
}

}  // namespace

void print_design(const DesignReport& report) {
  print_head(report);
  print_instants(report);
  print_way(report);
  print_sensors(report);
  print_proposal(report);
}

}  // namespace strut

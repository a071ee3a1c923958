#include "jobs/design/design_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "base/text/format_number.h"
#include "base/text/range.h"

namespace strut {
namespace {

constexpr double kMostPercent = 1e4;  // beyond, a bound is shown as "free"
constexpr std::size_t kSlices = 12;   // rows of the table along the way

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::size_t get_label_width() { return 26; }

std::string pad(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 0, ' ');
}

/// Per cent, short; a word where there is no bound to speak of.
std::string format_bound(double value) {
  return value <= kMostPercent ? format("%.3g", value) : "free";
}

void print_head(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  std::cout << "base point:";
  for (const SensitivityParameter& p : s.parameters) {
    std::cout << "  " << p.name << " " << format_number(p.base) << " " << p.unit;
  }
  std::cout << "\nchannels, 1 sigma of their noise:";
  for (const int channel : report.channels) {
    const ChannelInfo& info = get_channel(channel);
    const double sigma = report.noise[static_cast<std::size_t>(channel)];
    std::cout << "\n  " << pad(info.name, get_label_width()) << format_number(sigma) << " "
              << info.unit;
  }
  const WorstCurve worst = find_worst_curve(s, report.channels);
  std::cout << "\ndifferences: half-step error at most " << format("%.1e", worst.error) << " ("
            << get_channel(worst.channel).name << " by " << s.parameters[worst.parameter].name
            << ")\n";
}

void print_columns(const std::vector<SensitivityParameter>& parameters, const char* first) {
  std::cout << "\n" << pad(first, get_label_width()) << "  time s  offset m  condition   rms %";
  for (const SensitivityParameter& p : parameters) {
    std::cout << format("  %20s", p.name.c_str());
  }
  std::cout << "\n" << std::string(get_label_width() + 37, ' ');
  for (const SensitivityParameter& p : parameters) {
    std::cout << format("  %12s       %%", p.unit.c_str());
  }
  std::cout << "\n";
}

void print_bounds(const Sensitivity& s, const std::string& label, const std::string& place,
                  const Bounds& bounds) {
  std::cout << pad(label, get_label_width()) << pad(place, 18)
            << format("  %9s  %6s",
                      std::isfinite(bounds.condition) ? format("%.2g", bounds.condition).c_str()
                                                      : "singular",
                      format_bound(bounds.rms).c_str());
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    const double bound = bounds.bound[p];
    const std::string value =
        bound <= kMostPercent ? format("%.3g", to_unit(s.parameters[p], bound)) : "free";
    std::cout << format("  %12s  %6s", value.c_str(), format_bound(bound).c_str());
  }
  std::cout << "\n";
}

std::string format_place(const Instant& instant) {
  return format("%8.4f  %8.3f", instant.time, instant.offset);
}

void print_instants(const DesignReport& report) {
  const Sensitivity& s = report.sensitivity;
  const Design& design = report.design;
  print_columns(s.parameters, "bounds, 1 sigma");
  print_bounds(s, "the sweep's instant", format_place(s.snapshot), design.snapshot);
  for (const DesignChoice& choice : design.best) {
    const std::size_t count = choice.instants.size();
    const std::string label =
        count == 1 ? "best instant" : "best " + std::to_string(count) + " instants";
    print_bounds(s, label, format_place(s.instants[choice.instants[0]]), choice.bounds);
    for (std::size_t i = 1; i < count; ++i) {
      std::cout << pad("  and", get_label_width()) << format_place(s.instants[choice.instants[i]])
                << "\n";
    }
  }
  print_bounds(s, "all " + std::to_string(s.instants.size()) + " instants", "", design.window);
  std::cout << "(noise independent per sample at " << format_number(s.rate)
            << " Hz; bounds of all instants fall with the root of the rate)\n";
}

/// The best instant in each of some equal parts of the way.
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
        format("  %.3f to %.3f s", s.instants[begin].time, s.instants[end - 1].time);
    print_bounds(s, label, format_place(s.instants[best]), scan[best]);
  }
}

void print_sensors(const DesignReport& report) {
  constexpr std::size_t kWidth = 46;
  std::cout << "\n"
            << pad("sensors: rms of the bounds, %", kWidth)
            << "  sweep's instant   best instant  (offset m)   all instants\n";
  for (const SensorSet& set : report.design.sensors) {
    const Instant& best = report.sensitivity.instants[set.best.instants[0]];
    std::cout << pad(set.label, kWidth)
              << format("  %15s   %12s  %10.3f   %12s\n", format_bound(set.snapshot.rms).c_str(),
                        format_bound(set.best.bounds.rms).c_str(), best.offset,
                        format_bound(set.window.rms).c_str());
  }
}

std::string describe_combination(const Sensitivity& s, const Bounds& bounds) {
  constexpr double kPart = 0.05;
  std::string text;
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    const double part = bounds.weakest[p];
    if (std::abs(part) < kPart) continue;
    text += (text.empty() ? (part < 0.0 ? "-" : "") : (part < 0.0 ? " - " : " + ")) +
            format("%.2f ", std::abs(part)) + s.parameters[p].name;
  }
  return text + " (per cent each)";
}

void print_weakness(const DesignReport& report, const char* where, const Bounds& bounds) {
  const Sensitivity& s = report.sensitivity;
  std::cout << "known worst " << where << ": " << describe_combination(s, bounds) << ", "
            << (std::isfinite(bounds.weakest_bound) ? format("%.3g %%", bounds.weakest_bound)
                                                    : "not at all: F is singular")
            << "\n";
  for (const std::string& name : list_free(s, bounds)) {
    std::cout << "not identifiable " << where << ": " << name << " (1 sigma above 100 %)\n";
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
  std::cout << "best instant: offset = " << format("%.3f", instant.offset)
            << " m; put `offset = " << format("%.3f", instant.offset)
            << "` into [record] snapshot: rms of the bounds " << format_bound(design.snapshot.rms)
            << " -> " << format_bound(best.rms) << " %,\nless than a tenth more from "
            << format("%.3f to %.3f m\n", s.instants[range.first].offset,
                      s.instants[range.second].offset);
}

}  // namespace

std::vector<std::string> list_free(const Sensitivity& s, const Bounds& bounds) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    if (!(bounds.bound[p] <= kIdentifiable)) names.push_back(s.parameters[p].name);
  }
  return names;
}

void print_design(const DesignReport& report) {
  print_head(report);
  print_instants(report);
  print_way(report);
  print_sensors(report);
  print_proposal(report);
}

}  // namespace strut

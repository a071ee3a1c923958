// Study files: their cells and names, and what they are refused for.
#include <catch2/catch.hpp>
#include <fstream>

#include "base/error/input_error.h"
#include "study/request.h"
#include "tests/support/study_files.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::NoiseStudyFiles;
using test::StudyFiles;

/// Refused by an InputError with this text.
void check_refused(const std::string& study, const std::string& said) {
  try {
    read_study(study);
    FAIL_CHECK("accepted: " << said);
  } catch (const InputError& e) {
    CHECK_THAT(e.what(), Contains(said));
  }
}

TEST_CASE("Wrong words and numbers of a study file are refused by name", "[io]") {
  const StudyFiles files;
  std::string damping = test::kSweep;
  const std::size_t rear = damping.find("rear_stiffness");
  damping.replace(rear, damping.find('\n', rear) - rear,
                  "rear_damping = { from = 1980, to = 1800, step = -20 }");
  files.write_sweep("other.toml", damping);
  struct Fault {
    const char *from, *to, *said;
  };
  const Fault faults[] = {
      {"seeds   = 2", "seads = 2", "did you mean 'seeds'"},
      {"seeds   = 2", "seeds = 0", "seeds = 0"},
      {"\"trimmed\"]", "\"trimed\"]", "did you mean 'trimmed'"},
      {"[90, 70]", "[90, 101]", "sample.count = 101: more than the grid has; must lie in [1, 100]"},
      {"[90, 70]", "[90, 90]", "twice"},
      {"[90, 70]", "[90.5]", "whole numbers"},
      {"[4]", "[0]", "networks.small"},
      {"\"pitch_angle\"]\n[best", "\"pitch_angel\"]\n[best", "did you mean 'pitch_angle'"},
      {"[training]", "[main]\nnetwork = \"smal\"\n[training]", "did you mean 'small'"},
      {"[training]", "[main]\nsamples = 80\n[training]", "main.samples"},
      {"epochs = 12", "epoch = 12", "did you mean 'epochs'"},
      {"trimmed = -0.5", "trimmed = \"best\"", "design"},
      {"small = [4]", "little = [4]", "cells.small_90_four: not a cell of the study"},
      {"sweep.toml", "other.toml",
       "cells.small_90_two.rear_stiffness: not a parameter of the study"},
  };
  for (const Fault& fault : faults) {
    INFO(fault.to);
    check_refused(files.change(fault.from, fault.to), fault.said);
  }
}

TEST_CASE("Wrong words and numbers of a noise section are refused by name", "[io]") {
  const NoiseStudyFiles files;
  files.write_sweep("more.toml", [] {
    std::string text = test::kWindows;
    return text.replace(text.find("speed "), 6, "front_damping ");
  }());
  files.write_sweep("less.toml", [] {
    std::string text = test::kWindows;
    return text.replace(text.find("rear_stiffness"), 14, "rear_damping");
  }());
  files.write_sweep("deaf.toml", [] {
    std::string text = test::kWindows;
    return text.replace(text.find("imu_rate_y"), 10, "front_left_tire_deflection");
  }());
  struct Fault {
    const char *from, *to, *said;
  };
  const Fault faults[] = {
      {"\"windows.toml\"", "\"none.toml\"", "none.toml"},
      {"\"windows.toml\"", "\"sweep.toml\"", "records no histories"},
      {"\"windows.toml\"", "\"less.toml\"", "rear_stiffness"},
      {"\"windows.toml\"", "\"deaf.toml\"", "front_left_tire_deflection"},
      {"window_sweep = \"windows.toml\"", "", "window_sweep"},
      {"[0.3, 1.3]", "[0.3]", "two times"},
      {"[0.3, 1.3]", "[1.3, 0.3]", "must begin before it ends"},
      {"[0.3, 1.3]", "[0.3, 3.0]", "must begin before it ends"},
      {"[0.3, 1.3]", "[0.0, 1.3]", "must begin before it ends"},
      {"[0.1, 1]", "[1, 0.1]", "ascending"},
      {"[0.1, 1]", "[1, 1]", "ascending"},
      {"[0.1, 1]", "[]", "scales"},
      {"[0.1, 1]", "[0, 1]", "scales"},
      {"copies = 3", "copies = 0", "noise.copies = 0"},
      {"fits   = 12", "fits = 0", "noise.fits = 0"},
      {"fits   = 12", "fits = 2.5", "noise.fits"},
      {"fits   = 12", "fit = 12", "did you mean 'fits'"},
      {"fits   = 12", "hit_time = 0", "noise.hit_time = 0"},
      {"fits   = 12", "network = \"smal\"", "did you mean 'small'"},
      {"[training]", "[main]\ninputs = \"one\"\n[training]", "as many main inputs"},
  };
  for (const Fault& fault : faults) {
    std::string study = files.change(fault.from, fault.to);
    if (std::string(fault.said) == "as many main inputs") {
      std::ofstream(study) << [&] {
        std::string text = std::string(test::kStudy) + test::kNoise;
        text.replace(text.find("[best_instant]"), 14, "one = [\"pitch_angle\"]\n[best_instant]");
        return text.replace(text.find("[training]"), 10, fault.to);
      }();
    }
    INFO(fault.to);
    check_refused(study, fault.said);
  }
}

TEST_CASE("Cells are the networks with the main inputs, the other inputs, then the best instant",
          "[unit]") {
  const StudyFiles files;
  const StudyRequest request = read_study(files / "study.toml");
  std::vector<std::string> names;
  for (const StudyCell& cell : list_cells(request))
    names.push_back(make_model_name(request, cell, 1));
  CHECK(names == std::vector<std::string>{
                     "free_length_small_90_four_seed1", "free_length_wide_90_four_seed1",
                     "free_length_small_70_four_seed1", "free_length_wide_70_four_seed1",
                     "free_length_small_90_two_seed1", "trimmed_small_90_four_seed1",
                     "trimmed_wide_90_four_seed1", "trimmed_small_70_four_seed1",
                     "trimmed_wide_70_four_seed1", "trimmed_small_90_two_seed1",
                     "trimmed_small_90_four_best_seed1", "trimmed_small_90_two_best_seed1"});
}

}  // namespace
}  // namespace strut

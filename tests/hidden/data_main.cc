// strut_hidden_data: measured data with a hidden effect. Knows nothing of the program it tests.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/hidden/ablation.h"
#include "tests/hidden/campaign_files.h"

namespace strut::hidden {

constexpr char kUsage[] =
    "Usage: strut_hidden_data KIT SEEDS DIR [THREADS [ABLATION [REGIME]]]\n\n"
    "Writes the trials of the seeds into DIR/trials and their truths into DIR/truths; those that\n"
    "are there already stay. KIT: car, car_disc (on another contact), quarter_car or dyno.\n"
    "SEEDS: FROM:TO, TO not included, or such ranges and single seeds with commas between;\n"
    "nulls:SEEDS keeps those that hide nothing. ABLATION: none, no_roughness, no_deflection,\n"
    "body_only or one_crossing. REGIME:\n"
    "exact, sensors (with small errors within data sheets) or machine (these, realistic sizes\n"
    "and small misfits). The files depend on seeds, ablation and regime alone.\n\n"
    "Example: strut_hidden_data quarter_car 0:39 hidden 2\n";

namespace {

struct Request {
  Kit kit;
  std::vector<std::uint64_t> seeds;
  std::filesystem::path folder;
  unsigned threads = 1;
  Ablation ablation = Ablation::kNone;
};

/// "3", "1:4", "1:4,9" or "nulls:1:4"
std::vector<std::uint64_t> parse_seeds(const std::string& text) {
  constexpr std::string_view kNulls = "nulls:";
  std::vector<std::uint64_t> seeds;
  if (text.starts_with(kNulls)) {
    seeds = parse_seeds(text.substr(kNulls.size()));
    std::erase_if(seeds, [](std::uint64_t s) { return draw_category(s) != Category::kNone; });
    return seeds;
  }
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string part = text.substr(at, end - at);
    const std::size_t colon = part.find(':');
    const std::uint64_t from = std::stoull(part.substr(0, colon));
    const std::uint64_t to =
        colon == std::string::npos ? from + 1 : std::stoull(part.substr(colon + 1));
    for (std::uint64_t seed = from; seed < to; ++seed) seeds.push_back(seed);
    at = end + 1;
  }
  return seeds;
}

Request parse(const std::vector<std::string>& words) {
  if (words.size() < 3 || words.size() > 6) throw std::invalid_argument("three to six arguments");
  Request request;
  request.kit = make_kit(words[0], make_regime(words.size() > 5 ? words[5] : "exact"));
  request.seeds = parse_seeds(words[1]);
  request.folder = words[2];
  if (words.size() > 3) request.threads = static_cast<unsigned>(std::stoul(words[3]));
  if (words.size() > 4) request.ablation = make_ablation(words[4]);
  return request;
}

void write_one(const Request& request, std::uint64_t seed) {
  if (std::filesystem::exists(find_truth(request.folder, seed))) return;
  Kit kit = request.kit;
  Trial trial = draw_trial(kit, seed);
  ablate(request.ablation, kit, trial);
  write_trial(kit, trial, request.folder);
}

void write_trials(const Request& request) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex guard;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < request.seeds.size(); i = next++) {
        write_one(request, request.seeds[i]);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(guard);
      failure = std::current_exception();
      next = request.seeds.size();
    }
  };
  std::vector<std::thread> team;
  for (unsigned i = 0; i < std::max(request.threads, 1U); ++i) team.emplace_back(work);
  for (std::thread& t : team) t.join();
  if (failure) std::rethrow_exception(failure);
  seal_truths(request.folder);
}

}  // namespace

int run(const std::vector<std::string>& words) {
  write_trials(parse(words));
  return 0;
}

}  // namespace strut::hidden

int main(int count, char** words) {
  try {
    return strut::hidden::run({words + 1, words + count});
  } catch (const std::invalid_argument& e) {
    std::cerr << "strut_hidden_data: " << e.what() << "\n\n" << strut::hidden::kUsage;
    return 2;
  } catch (const std::exception& e) {
    std::cerr << "strut_hidden_data: " << e.what() << "\n";
    return 3;
  }
}

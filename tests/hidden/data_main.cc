// strut_hidden_data: measured data with a hidden effect. Knows nothing of the program it tests.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/hidden/campaign_files.h"

namespace strut::hidden {

constexpr char kUsage[] =
    "Usage: strut_hidden_data KIT FROM:TO DIR [THREADS]\n\n"
    "Writes the trials of the seeds FROM to TO, TO not included, into DIR/trials and their truths\n"
    "into DIR/truths. KIT: car, quarter_car or dyno. The files depend on the seeds alone.\n\n"
    "Example: strut_hidden_data quarter_car 0:39 hidden 2\n";

namespace {

struct Request {
  Kit kit;
  std::uint64_t from = 0, to = 0;
  std::filesystem::path folder;
  unsigned threads = 1;
};

Request parse(const std::vector<std::string>& words) {
  if (words.size() < 3 || words.size() > 4) throw std::invalid_argument("three or four arguments");
  Request request;
  request.kit = make_kit(words[0]);
  const std::size_t colon = words[1].find(':');
  if (colon == std::string::npos) throw std::invalid_argument("seeds: FROM:TO");
  request.from = std::stoull(words[1].substr(0, colon));
  request.to = std::stoull(words[1].substr(colon + 1));
  request.folder = words[2];
  if (words.size() > 3) request.threads = static_cast<unsigned>(std::stoul(words[3]));
  return request;
}

void write_trials(const Request& request) {
  const Sampler sampler(request.kit);
  std::atomic<std::uint64_t> next = request.from;
  std::exception_ptr failure;
  std::mutex guard;
  const auto work = [&] {
    try {
      for (std::uint64_t seed = next++; seed < request.to; seed = next++) {
        write_trial(request.kit, sampler.draw(seed), request.folder);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(guard);
      failure = std::current_exception();
      next = request.to;
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

#include "cluster/dispatcher.h"

#include <fmt/format.h>

#include <map>

#include "cluster/local.h"
#include "cluster/slurm.h"
#include "io/file/sha256.h"

namespace strut {
namespace {

template <class T>
std::unique_ptr<Dispatcher> make() {
  return std::make_unique<T>();
}

using Maker = std::unique_ptr<Dispatcher> (*)();

const std::map<std::string, Maker>& get_makers() {
  static const std::map<std::string, Maker> makers = {
      {LocalDispatcher::kName, &make<LocalDispatcher>},
      {SlurmDispatcher::kName, &make<SlurmDispatcher>}};
  return makers;
}

}  // namespace

std::string make_job_mark(const std::filesystem::path& sweep, const std::string& job_name) {
  constexpr std::size_t kDigits = 32;
  const std::string text =
      fmt::format("{}:{}", std::filesystem::canonical(sweep).string(), job_name);
  return to_hex(calc_sha256(text)).substr(0, kDigits);
}

std::string describe_foreign(const std::string& job, const std::string& name) {
  return fmt::format(
      "{} runs, but cannot be proved to be job {} of this folder: the folder was copied, renamed "
      "or "
      "reached by another path, or the job belongs to an earlier build",
      job, name);
}

std::vector<std::string> list_dispatchers() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : get_makers()) names.push_back(name);
  return names;
}

std::string find_dispatcher() {
  return SlurmDispatcher::find_fault().empty() ? SlurmDispatcher::kName : LocalDispatcher::kName;
}

std::unique_ptr<Dispatcher> make_dispatcher(const std::string& name) {
  return get_makers().at(name)();
}

}  // namespace strut

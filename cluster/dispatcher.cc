#include "cluster/dispatcher.h"

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
  static const std::map<std::string, Maker> makers = {{"local", &make<LocalDispatcher>},
                                                      {"slurm", &make<SlurmDispatcher>}};
  return makers;
}

}  // namespace

std::string make_job_mark(const std::filesystem::path& sweep, const std::string& job_name) {
  constexpr std::size_t kDigits = 32;
  const std::string text = std::filesystem::canonical(sweep).string() + ":" + job_name;
  return to_hex(calc_sha256(text)).substr(0, kDigits);
}

std::string describe_foreign(const std::string& job, const std::string& name) {
  return job + " runs, but is not proved to be job " + name +
         " of this folder: the folder was copied, renamed or is seen by another path, or the job "
         "is "
         "of an earlier build";
}

std::vector<std::string> list_dispatchers() {
  std::vector<std::string> names;
  for (const auto& [name, maker] : get_makers()) names.push_back(name);
  return names;
}

std::string find_dispatcher() { return SlurmDispatcher::is_there() ? "slurm" : "local"; }

std::unique_ptr<Dispatcher> make_dispatcher(const std::string& name) {
  return get_makers().at(name)();
}

}  // namespace strut

#include "sweep/freeze_inputs.h"

#include <map>

#include "io/file/atomic_file.h"
#include "io/file/read_text_file.h"
#include "io/format/toml_text.h"
#include "model_files/named_files.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Names in the folder of copies, one a file, though two may be called the same.
class Copies {
 public:
  explicit Copies(const Folder& folder) : folder_(folder) {}

  /// Copies a file and, first, those it names; returns the copy's name.
  std::string copy(const fs::path& source) {
    std::string name = choose_name(source);
    if (source.extension() != ".toml") {
      write_text_file(folder_, name, read_text_file(source));
      return name;
    }
    TomlValues changes;
    for (const NamedFile& named : list_named_files(source)) {
      changes.emplace_back(named.key, copy(named.path));
    }
    write_text_file(folder_, name, replace_toml_texts(source, changes));
    return name;
  }

 private:
  std::string choose_name(const fs::path& source) {
    const fs::path path = fs::weakly_canonical(source);
    std::string name = source.filename().string();
    for (int i = 2; names_.count(name) > 0 && names_[name] != path; ++i) {
      name = source.stem().string() + "_" + std::to_string(i) + source.extension().string();
    }
    names_[name] = path;
    return name;
  }

  Folder folder_;
  std::map<std::string, fs::path> names_;
};

}  // namespace

void freeze_inputs(const SweepRequest& request, const SweepFolder& folder) {
  Copies copies(folder.open(folder.inputs()));
  const std::string inside = folder.inputs().filename().string() + "/";
  // Two statements: the order of the copies' names must not be the compiler's.
  const std::string vehicle = inside + copies.copy(request.vehicle);
  const std::string maneuver = inside + copies.copy(request.maneuver);
  write_text_file(Folder(folder.root), folder.request().filename().string(),
                  replace_toml_texts(request.path, {{"vehicle", vehicle}, {"maneuver", maneuver}}));
}

}  // namespace strut

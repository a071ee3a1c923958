#include "sweep/freeze_inputs.h"

#include <fmt/format.h>

#include <map>

#include "io/file/atomic_file.h"
#include "io/file/read_text_file.h"
#include "io/format/toml_text.h"
#include "model_files/named_files.h"

namespace strut {
namespace {

namespace fs = std::filesystem;

/// Name of each copy and the file that it was copied from.
using CopyNames = std::map<std::string, fs::path>;

/// Reserves a name for the copy of `source`; distinct files of the same name are numbered.
std::string choose_name(const fs::path& source, CopyNames& names) {
  const fs::path path = fs::weakly_canonical(source);
  std::string name = source.filename().string();
  for (int i = 2; names.count(name) > 0 && names[name] != path; ++i) {
    name = fmt::format("{}_{}{}", source.stem().string(), i, source.extension().string());
  }
  names[name] = path;
  return name;
}

/// Copies a file and, first, the files that it names; returns the copy's name.
std::string copy_file(const fs::path& source, const Folder& folder, CopyNames& names) {
  std::string name = choose_name(source, names);
  if (source.extension() != ".toml") {
    write_text_file(folder, name, read_text_file(source));
    return name;
  }
  TomlValues changes;
  for (const NamedFile& named : list_named_files(source)) {
    changes.emplace_back(named.key, copy_file(named.path, folder, names));
  }
  write_text_file(folder, name, replace_toml_texts(source, changes));
  return name;
}

}  // namespace

void freeze_inputs(const SweepRequest& request, const SweepFolder& folder) {
  const Folder inputs = folder.open(folder.inputs());
  const std::string inside = folder.inputs().filename().string() + "/";
  CopyNames names;
  // Two statements: the compiler must not choose the order in which names are assigned.
  const std::string vehicle = inside + copy_file(request.vehicle, inputs, names);
  const std::string maneuver = inside + copy_file(request.maneuver, inputs, names);
  write_text_file(Folder(folder.root), folder.request().filename().string(),
                  replace_toml_texts(request.path, {{"vehicle", vehicle}, {"maneuver", maneuver}}));
}

}  // namespace strut

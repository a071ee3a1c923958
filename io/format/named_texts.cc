#include "io/format/named_texts.h"

#include <fmt/format.h>

namespace strut {
namespace {

constexpr char kNames[] = "/name", kTexts[] = "/value";

}  // namespace

std::optional<std::string> find_text(const NamedTexts& list, const std::string& name) {
  for (const auto& [key, text] : list) {
    if (key == name) return text;
  }
  return std::nullopt;
}

void write_named_texts(Hdf5Writer& file, const std::string& group, const NamedTexts& list,
                       const NamedTextsLabel& label) {
  std::vector<std::string> names, texts;
  names.reserve(list.size());
  texts.reserve(list.size());
  for (const auto& [name, text] : list) {
    names.push_back(name);
    texts.push_back(text);
  }
  file.write(group + kNames, names, {"1", label.names, {}});
  file.write(group + kTexts, texts, {"1", label.texts, {}});
}

NamedTexts read_named_texts(const std::filesystem::path& path, const Hdf5Reader& file,
                            const std::string& group) {
  const std::vector<std::string> names = file.read_texts(group + kNames);
  const std::vector<std::string> texts = file.read_texts(group + kTexts);
  if (names.size() != texts.size()) {
    throw InputError(fmt::format("{}: {}: {} values; must be {}", path.string(), group + kTexts,
                                 texts.size(), names.size()));
  }
  NamedTexts list;
  list.reserve(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) list.emplace_back(names[i], texts[i]);
  return list;
}

}  // namespace strut

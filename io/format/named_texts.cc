#include "io/format/named_texts.h"

namespace strut {

void write_named_texts(Hdf5Writer& file, const std::string& group, const NamedTexts& list,
                       const NamedTextsLabel& label) {
  std::vector<std::string> names, texts;
  names.reserve(list.size());
  texts.reserve(list.size());
  for (const auto& [name, text] : list) {
    names.push_back(name);
    texts.push_back(text);
  }
  file.write(group + "/name", names, {"1", label.names, {}});
  file.write(group + "/value", texts, {"1", label.texts, {}});
}

NamedTexts read_named_texts(const std::filesystem::path& path, const Hdf5Reader& file,
                            const std::string& group) {
  const std::vector<std::string> names = file.read_texts(group + "/name");
  const std::vector<std::string> texts = file.read_texts(group + "/value");
  if (names.size() != texts.size()) {
    throw InputError(path.string() + ": " + group + "/value: " + std::to_string(texts.size()) +
                     " values; must be " + std::to_string(names.size()));
  }
  NamedTexts list;
  list.reserve(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) list.emplace_back(names[i], texts[i]);
  return list;
}

}  // namespace strut

#include "tests/fuzz/hdf5_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <utility>
#include <variant>
#include <vector>

#include "io/file/compress.h"
#include "io/file/sha256.h"
#include "io/format/hdf5.h"

namespace strut::fuzz {
namespace {

using Values = std::variant<std::vector<double>, std::vector<std::int64_t>,
                            std::vector<std::int32_t>, std::vector<std::string>>;

struct Node {
  std::vector<std::size_t> shape;
  Values values;
  Hdf5Label label;
};

using Attribute = std::variant<std::int64_t, double, std::string, std::vector<std::string>>;

struct Tree {
  std::map<std::string, Node> datasets;
  std::map<std::pair<std::string, std::string>, Attribute> attributes;  // by object and key
};

constexpr char kShownPath[] = "seed";

/// `read()`, or nothing where that is of another kind.
template <class Read>
auto attempt(const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void read_attributes(const Hdf5Reader& file, const std::string& object, Tree& tree) {
  for (const std::string& key : file.list_attributes(object)) {
    Attribute& value = tree.attributes[{object, key}];
    if (const auto i = attempt([&] { return file.read_integer_attribute(object, key); })) {
      value = *i;
    } else if (const auto x = attempt([&] { return file.read_number_attribute(object, key); })) {
      value = *x;
    } else if (const auto text = attempt([&] { return file.read_attribute(object, key); })) {
      value = *text;
    } else {
      value = file.read_attribute_list(object, key);
    }
  }
}

void read_group(const Hdf5Reader& file, const std::string& group, Tree& tree) {
  read_attributes(file, group, tree);
  for (const std::string& child : file.list(group)) {
    const std::string name = (group == "/" ? "" : group) + "/" + child;
    const auto shape = attempt([&] { return file.read_shape(name); });
    if (!shape) {
      read_group(file, name, tree);
      continue;
    }
    Node& node = tree.datasets[name];
    node.shape = *shape;
    node.label = file.read_label(name);
    if (auto texts = attempt([&] { return file.read_texts(name); })) {
      node.values = std::move(*texts);
    } else if (auto integers = attempt([&] { return file.read_integers(name); })) {
      node.values = std::move(*integers);
    } else if (auto numbers = attempt([&] { return file.read(name).values; })) {
      node.values = std::move(*numbers);
    } else {
      tree.datasets.erase(name);  // texts of variable length, which no reader takes
    }
  }
}

/// Caches the seeds, which are few and read often.
const Tree& read_tree(const std::string& seed) {
  static std::map<std::string, Tree> trees;
  const auto [at, is_new] = trees.try_emplace(seed);
  if (is_new) {
    read_group(Hdf5Reader(kShownPath, std::as_bytes(std::span(seed))), "/", at->second);
  }
  return at->second;
}

double make_number(Random& random) {
  constexpr double kNumbers[] = {0.0,
                                 -0.0,
                                 1.0,
                                 -1.0,
                                 1e308,
                                 -1e308,
                                 1e-320,
                                 1e-300,
                                 1e16,
                                 1e-9,
                                 9.3e18,
                                 4294967296.0,
                                 std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()};
  return kNumbers[random.below(std::size(kNumbers))];
}

std::int64_t make_integer(Random& random) {
  constexpr std::int64_t kIntegers[] = {0,
                                        1,
                                        -1,
                                        2,
                                        100000,
                                        std::numeric_limits<std::int32_t>::max(),
                                        std::numeric_limits<std::int32_t>::min(),
                                        std::int64_t{1} << 32,
                                        (std::int64_t{1} << 32) + 4,
                                        std::int64_t{1} << 53,
                                        std::numeric_limits<std::int64_t>::max(),
                                        std::numeric_limits<std::int64_t>::min()};
  return kIntegers[random.below(std::size(kIntegers))];
}

std::string make_text(Random& random) {
  static const std::vector<std::string> texts = {
      "",         "../../outside", "/etc/passwd", "body_position_z",
      "nan",      "1e999",         "-1",          "\x1b[31m",
      "\xff\xfe", "a\nb",          "%s%n",        "0",
      "strut"};
  if (random.one_in(8)) return std::string(random.log_uniform(4000), 'x');
  return random.pick(texts);
}

double convert(double x, double) { return x; }
std::int64_t convert(double x, std::int64_t) {
  return std::abs(x) < 9e18 ? static_cast<std::int64_t>(x) : 0;
}
std::int32_t convert(double x, std::int32_t) {
  return std::abs(x) < 2e9 ? static_cast<std::int32_t>(x) : 0;
}
std::string convert(double x, const std::string&) { return std::to_string(x); }
template <class T, class To>
To convert(const T& value, const To& to) {
  if constexpr (std::is_same_v<T, std::string>) {
    return convert(static_cast<double>(value.size()), to);
  } else {
    return convert(static_cast<double>(value), to);
  }
}

template <class To>
Values convert_all(const Values& values) {
  return std::visit(
      [](const auto& from) -> Values {
        std::vector<To> to;
        to.reserve(from.size());
        for (const auto& value : from) to.push_back(convert(value, To{}));
        return to;
      },
      values);
}

Values change_type(const Values& values, Random& random) {
  switch (random.below(4)) {
    case 0:
      return convert_all<double>(values);
    case 1:
      return convert_all<std::int64_t>(values);
    case 2:
      return convert_all<std::int32_t>(values);
    default:
      return convert_all<std::string>(values);
  }
}

void change_value(double& value, Random& random) { value = make_number(random); }
void change_value(std::int64_t& value, Random& random) { value = make_integer(random); }
void change_value(std::int32_t& value, Random& random) {
  value = static_cast<std::int32_t>(make_integer(random));
}
void change_value(std::string& value, Random& random) { value = make_text(random); }

void change_values(Values& values, Random& random) {
  std::visit(
      [&](auto& list) {
        if (list.empty()) return;
        const std::size_t count = random.one_in(8) ? list.size() : random.log_uniform(4);
        for (std::size_t i = 0; i < count; ++i)
          change_value(list[random.below(list.size())], random);
      },
      values);
}

std::size_t count_values(const Values& values) {
  return std::visit([](const auto& list) { return list.size(); }, values);
}

void resize_values(Values& values, std::size_t count) {
  std::visit([&](auto& list) { list.resize(count); }, values);
}

void change_shape(Node& node, Random& random) {
  std::size_t& size = node.shape[random.below(node.shape.size())];
  switch (random.below(6)) {
    case 0:
      size += 1;
      break;
    case 1:
      if (size > 0) --size;
      break;
    case 2:
      size = 0;
      break;
    case 3:
      size = random.log_uniform(2000);
      break;
    case 4:  // one dimension for two
      node.shape = {count_values(node.values)};
      break;
    default:
      std::reverse(node.shape.begin(), node.shape.end());
  }
  std::size_t count = 1;
  for (const std::size_t s : node.shape) count *= s;
  resize_values(node.values, count);
}

void change_list(std::vector<std::string>& list, Random& random) {
  switch (random.below(4)) {
    case 0:
      list.clear();
      break;
    case 1:
      list.push_back(make_text(random));
      break;
    case 2:
      if (!list.empty()) list.pop_back();
      break;
    default:
      if (!list.empty()) list[random.below(list.size())] = make_text(random);
      if (!list.empty()) list[random.below(list.size())] = random.pick(list);
  }
}

void change_label(Hdf5Label& label, Random& random) {
  std::vector<std::string>* const lists[] = {&label.names, &label.units, &label.descriptions};
  if (random.one_in(4)) {
    label.unit = make_text(random);
  } else {
    change_list(*lists[random.below(3)], random);
  }
}

void change_attribute(Attribute& value, Random& random) {
  switch (random.below(8)) {
    case 0:
      value = make_integer(random);
      return;
    case 1:
      value = make_number(random);
      return;
    case 2:
      value = make_text(random);
      return;
    case 3:
      value = std::vector<std::string>{make_text(random), make_text(random)};
      return;
    default:
      break;
  }
  if (auto* const integer = std::get_if<std::int64_t>(&value)) *integer = make_integer(random);
  if (auto* const number = std::get_if<double>(&value)) *number = make_number(random);
  if (auto* const text = std::get_if<std::string>(&value)) *text = make_text(random);
  if (auto* const list = std::get_if<std::vector<std::string>>(&value)) change_list(*list, random);
}

template <class Map>
auto pick_from(Map& map, Random& random) {
  auto at = map.begin();
  std::advance(at, static_cast<std::ptrdiff_t>(random.below(map.size())));
  return at;
}

void change_tree(Tree& tree, Random& random) {
  if (!tree.attributes.empty() && random.one_in(3)) {
    const auto attribute = pick_from(tree.attributes, random);
    if (random.one_in(4)) {
      tree.attributes.erase(attribute);
    } else {
      change_attribute(attribute->second, random);
    }
    return;
  }
  if (tree.datasets.empty()) return;
  const auto dataset = pick_from(tree.datasets, random);
  Node& node = dataset->second;
  switch (random.below(8)) {
    case 0:
      tree.datasets.erase(dataset);
      return;
    case 1: {  // its content under another name
      const auto other = pick_from(tree.datasets, random);
      other->second = Node(node);
      return;
    }
    case 2:
      node.values = change_type(node.values, random);
      return;
    case 3:
    case 4:
      return change_shape(node, random);
    case 5:
      return change_label(node.label, random);
    default:
      return change_values(node.values, random);
  }
}

std::vector<std::byte> get_bytes(const Values& values, std::size_t& text_length) {
  return std::visit(
      [&](const auto& list) {
        using Value = typename std::decay_t<decltype(list)>::value_type;
        if constexpr (std::is_same_v<Value, std::string>) {
          PackedTexts packed = pack_texts(list);
          text_length = packed.length;
          return packed.bytes;
        } else {
          const auto bytes = std::as_bytes(std::span(list));
          return std::vector<std::byte>(bytes.begin(), bytes.end());
        }
      },
      values);
}

Hdf5Type get_type(const Values& values) {
  return std::visit(
      [](const auto& list) { return hdf5_type<typename std::decay_t<decltype(list)>::value_type>; },
      values);
}

/// All rows in one chunk, rarely damaged.
void write_node(Hdf5Writer& file, const std::string& name, const Node& node, Random& random) {
  Hdf5Chunks chunks{.name = name,
                    .type = get_type(node.values),
                    .shape = node.shape,
                    .chunk_rows = std::max<std::size_t>(node.shape.front(), 1),
                    .chunks = {},
                    .text_length = 0,
                    .label = node.label};
  const std::vector<std::byte> bytes = get_bytes(node.values, chunks.text_length);
  if (!bytes.empty()) {
    chunks.chunks = {compress_chunk(bytes, get_element_size(chunks.type, chunks.text_length))};
    std::vector<std::byte>& chunk = chunks.chunks.front();
    if (random.one_in(64)) chunk[random.below(chunk.size())] ^= std::byte{1};
    if (random.one_in(64)) chunk.resize(random.below(chunk.size()) + 1);
    if (random.one_in(64)) chunks.chunks.clear();
  }
  file.write_chunks(chunks);
}

void write_tree(Hdf5Writer& file, const Tree& tree, Random& random) {
  for (const auto& [name, node] : tree.datasets) write_node(file, name, node, random);
  for (const auto& [place, attribute] : tree.attributes) {
    std::visit(
        [&, object = place.first, key = place.second](const auto& value) {
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::vector<std::string>>) {
            file.write_attribute_list(object, key, value);
          } else {
            file.write_attribute(object, key, value);
          }
        },
        attribute);
  }
}

/// Returns the seal of a file without its padding; empty if there is none.
std::string get_seal(const std::string& file) {
  const std::string block = file.substr(0, kSealBytes);
  const bool sealed = block.starts_with("strut ") && block.find("\nseal ") != std::string::npos;
  return sealed ? block.substr(0, block.find('\0')) : "";
}

std::string hash_text(const std::string& text) {
  return to_hex(calc_sha256(std::as_bytes(std::span(text))));
}

}  // namespace

std::string seal_again(const std::string& seed, std::string file) {
  const std::string old = get_seal(seed);
  if (old.empty() || file.size() < kSealBytes) return file;
  std::istringstream lines(old);
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const std::string key = line.substr(0, line.find(' '));
    if (key == "size") line = "size " + std::to_string(file.size());
    if (key == "sha256") line = "sha256 " + hash_text(file.substr(kSealBytes));
    if (key == "seal") line = "seal " + hash_text(text);
    text += line + "\n";
  }
  text.resize(kSealBytes, '\0');
  return file.replace(0, kSealBytes, text);
}

std::string rewrite_hdf5(const std::string& seed, Random& random) {
  Tree tree = read_tree(seed);
  const std::size_t changes = random.log_uniform(4);
  for (std::size_t i = 0; i < changes; ++i) change_tree(tree, random);

  Hdf5WriterOptions options;
  if (!get_seal(seed).empty()) options.seal.emplace();  // only reserves space
  Hdf5Writer file(Hdf5InMemory{kShownPath}, options);
  try {
    write_tree(file, tree, random);
  } catch (const EnvironmentError&) {
    return seed;  // more than the library can write
  }
  const std::vector<std::byte> image = file.image();
  return seal_again(seed, {reinterpret_cast<const char*>(image.data()), image.size()});
}

}  // namespace strut::fuzz

// Names of the values of an enumeration, each listed once beside its value.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace strut {

/// One entry of a name table.
template <class Enum>
struct Named {
  Enum value;
  const char* name;
};

/// Whether the table lists every value from 0 to `last` in order; every table asserts this.
template <class Enum, std::size_t N>
constexpr bool names_all(const std::array<Named<Enum>, N>& table, Enum last) {
  for (std::size_t i = 0; i < N; ++i) {
    if (static_cast<std::size_t>(table[i].value) != i) return false;
  }
  return static_cast<std::size_t>(last) + 1 == N;
}

template <class Enum, std::size_t N>
constexpr const char* find_name(const std::array<Named<Enum>, N>& table, Enum value) {
  return table[static_cast<std::size_t>(value)].name;
}

/// The value of this name; null where no entry has it.
template <class Enum, std::size_t N>
constexpr std::optional<Enum> find_value(const std::array<Named<Enum>, N>& table,
                                         std::string_view name) {
  for (const Named<Enum>& entry : table) {
    if (name == entry.name) return entry.value;
  }
  return std::nullopt;
}

/// The names in the order of their values.
template <class Enum, std::size_t N>
std::vector<std::string> list_names(const std::array<Named<Enum>, N>& table) {
  std::vector<std::string> names;
  names.reserve(N);
  for (const Named<Enum>& entry : table) names.emplace_back(entry.name);
  return names;
}

}  // namespace strut

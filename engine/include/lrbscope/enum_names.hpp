#pragma once
/// Names of enumerators. Each enum that is printed, written or parsed has one table beside it, the constexpr
/// function enum_names(Enum). Messages, files, options and the schema tests take the names from this table. A
/// new enumerator needs one line in it.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lrb {

/// One line of an enum's table.
template <class Enum>
struct EnumName {
  Enum value;
  std::string_view name;  ///< a literal, so that data() is NUL-terminated
};

/// Returns the table of an enum. Checks at compile time that it lists the enumerators in order, from 0.
/// (Enumerators without a name must come last in the enum; the table omits them.)
template <class Enum>
consteval auto checked_enum_names() {
  const auto table = enum_names(Enum{});
  for (std::size_t i = 0; i < table.size(); ++i)
    if (static_cast<std::size_t>(table[i].value) != i) throw "the table is not in the order of the enum";
  return table;
}
template <class Enum>
inline constexpr auto kEnumNames = checked_enum_names<Enum>();

/// Returns the name of an enumerator, or "?" if the value has none.
template <class Enum>
constexpr std::string_view name_of(Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < kEnumNames<Enum>.size() ? kEnumNames<Enum>[i].name : "?";
}

/// Returns the enumerator with this name, or nullopt if there is none.
template <class Enum>
constexpr std::optional<Enum> from_name(std::string_view word) {
  for (const EnumName<Enum>& entry : kEnumNames<Enum>)
    if (entry.name == word) return entry.value;
  return std::nullopt;
}

/// Returns "a, b or c"; with other separators for example "a|b|c".
template <class Enum>
std::string all_names(std::string_view between = ", ", std::string_view before_last = " or ") {
  std::string out;
  const std::size_t n = kEnumNames<Enum>.size();
  for (std::size_t i = 0; i < n; ++i)
    out.append(i == 0 ? "" : i + 1 == n ? before_last : between).append(kEnumNames<Enum>[i].name);
  return out;
}

}  // namespace lrb

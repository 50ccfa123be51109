#pragma once
/// Words of enumerators. Beside each enum that is shown, written or read stands one table, the constexpr
/// function words_of(Enum); messages, files, options and the tests of the schemas take the words from it.
/// A new enumerator needs one line there.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lrb {

/// A line of an enum's table.
template <class Enum>
struct EnumWord {
  Enum value;
  std::string_view word;  ///< of literals: data() ends with a NUL
};

/// The table of an enum, checked while compiling: the enumerators in their order, from 0 on. (Enumerators
/// without a word come last in the enum and are left out.)
template <class Enum>
consteval auto checked_words() {
  const auto table = words_of(Enum{});
  for (std::size_t i = 0; i < table.size(); ++i)
    if (static_cast<std::size_t>(table[i].value) != i) throw "the table is not in the order of the enum";
  return table;
}
template <class Enum>
inline constexpr auto kWords = checked_words<Enum>();

/// Returns the word of an enumerator; "?" for a value that is none.
template <class Enum>
constexpr std::string_view name_of(Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < kWords<Enum>.size() ? kWords<Enum>[i].word : "?";
}

template <class Enum>
constexpr std::optional<Enum> from_name(std::string_view word) {
  for (const EnumWord<Enum>& entry : kWords<Enum>)
    if (entry.word == word) return entry.value;
  return std::nullopt;
}

/// Returns "a, b or c", or with other separators "a|b|c".
template <class Enum>
std::string all_names(std::string_view between = ", ", std::string_view before_last = " or ") {
  std::string out;
  const std::size_t n = kWords<Enum>.size();
  for (std::size_t i = 0; i < n; ++i)
    out.append(i == 0 ? "" : i + 1 == n ? before_last : between).append(kWords<Enum>[i].word);
  return out;
}

}  // namespace lrb

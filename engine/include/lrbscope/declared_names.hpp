#pragma once
/// Tables of names (lrbscope/enum_names.hpp) for enums whose names are the enumerators as they are declared.

#include <algorithm>
#include <utility>

#include <lrbscope/enum_names.hpp>

namespace lrb {

/// Returns the name of an enumerator as gcc and clang spell it: "... [with auto kValue = lrb::Side::a; ...]".
template <auto kValue>
consteval std::string_view declared_name() {
  constexpr std::string_view kBefore = "kValue = ";
  std::string_view text = __PRETTY_FUNCTION__;
  text = text.substr(text.find(kBefore) + kBefore.size());
  text = text.substr(0, text.find_first_of(";]"));
  if (text.find(')') != text.npos) throw "a value between the enumerators";
  return text.substr(text.rfind(':') + 1);
}
template <auto kValue>
inline constexpr auto kDeclaredName = [] {
  std::array<char, declared_name<kValue>().size() + 1> out{};  // NUL-terminated
  std::ranges::copy(declared_name<kValue>(), out.begin());
  return out;
}();

/// Returns the table of an enum, from enumerator 0 to its last.
template <auto kLast>
constexpr auto names_as_declared() {
  using Enum = decltype(kLast);
  return []<std::size_t... i>(std::index_sequence<i...>) {
    return std::array{EnumName<Enum>{static_cast<Enum>(i), kDeclaredName<static_cast<Enum>(i)>.data()}...};
  }
  (std::make_index_sequence<static_cast<std::size_t>(kLast) + 1>());
}

}  // namespace lrb

#pragma once
// Included before every file: the parts of C++20 that the engine uses and that libc++ 13 (Debian's
// emscripten 3.1.6) lacks. A newer libc++ has them.
#include <version>
#if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 14000
#include <algorithm>
#include <bit>
#include <charconv>
#include <compare>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string>
#include <system_error>

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  return __builtin_bit_cast(To, from);
}

template <class I, class J>
constexpr auto lexicographical_compare_three_way(I first, I last, J other, J other_last)
    -> decltype(*first <=> *other) {
  for (; first != last && other != other_last; ++first, ++other)
    if (const auto order = *first <=> *other; order != 0) return order;
  return first != last         ? strong_ordering::greater
         : other != other_last ? strong_ordering::less
                               : strong_ordering::equal;
}

namespace ranges {
template <class Range, class Out>
constexpr void copy(const Range& range, Out out) {
  std::copy(std::begin(range), std::end(range), out);
}
template <class Range, class Other>
constexpr bool equal(const Range& x, const Other& y) {
  return std::equal(std::begin(x), std::end(x), std::begin(y), std::end(y));
}
}  // namespace ranges

// Numbers in messages, as printf and strtod convert them.

inline to_chars_result to_chars(char* first, char* last, double x, chars_format format, int digits) {
  const auto room = static_cast<size_t>(last - first);
  const int size = snprintf(first, room, format == chars_format::fixed ? "%.*f" : "%.*g", digits, x);
  if (size < 0 || static_cast<size_t>(size) >= room) return {last, errc::value_too_large};
  return {first + size, errc{}};
}

/// Writes the shortest digits that are read as the same number.
inline to_chars_result to_chars(char* first, char* last, double x) {
  for (int digits = 1; digits < 17; ++digits)
    if (const auto end = to_chars(first, last, x, chars_format::general, digits);
        end.ec == errc{} && strtod(string(first, end.ptr).c_str(), nullptr) == x)
      return end;
  return to_chars(first, last, x, chars_format::general, 17);
}

inline from_chars_result from_chars(const char* first, const char* last, double& x) {
  const string text(first, last);
  char* end = nullptr;
  const double value = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  x = value;
  return {first + (end - text.c_str()), errc{}};
}

}  // namespace std
#endif

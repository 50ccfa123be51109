#include "engine/mesh/io/scan.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <system_error>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

enum class ByteKind : std::uint8_t { other, blank, newline, backslash };

/// The kind of each byte: one look-up per character.
constexpr std::array<ByteKind, 256> kByteKinds = [] {
  std::array<ByteKind, 256> kinds{};
  for (const char c : {' ', '\t', '\v', '\f'}) kinds[static_cast<unsigned char>(c)] = ByteKind::blank;
  for (const char c : {'\n', '\r'}) kinds[static_cast<unsigned char>(c)] = ByteKind::newline;
  kinds[static_cast<unsigned char>('\\')] = ByteKind::backslash;
  return kinds;
}();

ByteKind kind_of_byte(char c) {
  return kByteKinds[static_cast<unsigned char>(c)];
}
bool is_newline(char c) {
  return kind_of_byte(c) == ByteKind::newline;
}

/// Removes a plus sign, which is used in files but rejected by std::from_chars.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') token.remove_prefix(1);
  return token;
}

/// Returns the double for digits that std::from_chars reports as out of range, at either end. Numbers too
/// small are rounded as usual to zero or a subnormal. Numbers too large give infinity.
double round_out_of_range(std::string_view digits) {
  const std::string copy(digits);
  char* stop = nullptr;
  const double value = std::strtod(copy.c_str(), &stop);
  return stop == copy.c_str() + copy.size() ? value : HUGE_VAL;
}

}  // namespace

bool TextCursor::skip_continuation() {
  if (!rules_.continuation || *at_ != '\\' || at_ + 1 == end_ || !is_newline(at_[1])) return false;
  ++at_;
  skip_newline();
  return true;
}

void TextCursor::skip_newline() {
  // CR LF, LF and CR each count as one line end.
  const bool pair = *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n';
  at_ += pair ? 2 : 1;
  ++line_;
}

std::string_view TextCursor::token() {
  // Skip blanks and continuations before the token.
  do {
    while (at_ != end_ && kind_of_byte(*at_) == ByteKind::blank) ++at_;
  } while (at_ != end_ && skip_continuation());
  const char* const start = at_;
  // A comment ends the tokens of this line; the cursor stays at the line end.
  if (rules_.hash_comments && at_ != end_ && *at_ == '#') {
    at_ = std::find_if(at_, end_, is_newline);
    return {};
  }
  // The token ends at a blank, at the line end, or at a continuation directly after it.
  const char* stop = start;
  for (; stop != end_; ++stop) {
    const ByteKind kind = kind_of_byte(*stop);
    if (kind == ByteKind::other) continue;
    if (kind != ByteKind::backslash || (rules_.continuation && stop + 1 != end_ && is_newline(stop[1])))
      break;
  }
  at_ = stop;
  return {start, static_cast<std::size_t>(stop - start)};
}

bool TextCursor::plain_number(double& value) {
  const char* start = at_;
  while (start != end_ && kind_of_byte(*start) == ByteKind::blank) ++start;
  // from_chars does not depend on the locale and rounds to nearest.
  const auto [stop, error] = std::from_chars(start, end_, value);
  if (error != std::errc() || !ends_token(stop) || !std::isfinite(value)) return false;
  at_ = stop;
  return true;
}

bool TextCursor::plain_index(std::int64_t& value) {
  constexpr int kDigits = 9;
  const char* at = at_;
  while (at != end_ && kind_of_byte(*at) == ByteKind::blank) ++at;
  const char* const start = at;
  value = 0;
  for (; at != end_ && *at >= '0' && *at <= '9' && at - start < kDigits; ++at)
    value = 10 * value + (*at - '0');
  if (value == 0 || !ends_token(at)) return false;
  at_ = at;
  return true;
}

/// Returns true if a token that ends here is followed by a blank or ends its line.
bool TextCursor::ends_token(const char* at) const {
  return at == end_ || kind_of_byte(*at) == ByteKind::blank || is_newline(*at);
}

bool TextCursor::next_line() {
  // By tokens rather than characters, so that continuations are followed.
  while (!token().empty()) {
  }
  if (at_ == end_) return false;
  skip_newline();
  return true;
}

std::string_view TextCursor::any_token() {
  do {
    const std::string_view found = token();
    if (!found.empty()) return found;
  } while (next_line());
  return {};
}

double TextCursor::number(std::string_view token, std::string_view what) const {
  const std::string_view digits = without_plus(token);
  double value = 0;
  // from_chars does not depend on the locale and rounds to nearest.
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) value = round_out_of_range(digits);
  // The number must span the entire token.
  if (error == std::errc::invalid_argument || stop != digits.data() + digits.size())
    fail(shown(token), "a number (" + std::string(what) + ")", "correct the line");
  if (!std::isfinite(value))
    fail(shown(token), "a finite number (" + std::string(what) + ")",
         "correct the line or export the mesh again");
  return value;
}

std::int64_t TextCursor::integer(std::string_view token, std::string_view what) const {
  const std::string_view digits = without_plus(token);
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || stop != digits.data() + digits.size())
    fail(shown(token), "an integer (" + std::string(what) + ")", "correct the line");
  if (error == std::errc::result_out_of_range)
    fail(shown(token), "an integer of at most 64 bits (" + std::string(what) + ")", "correct the line");
  return value;
}

void TextCursor::fail_at(std::uint64_t line, std::string_view found, std::string_view expected,
                         std::string_view advice) const {
  std::string message = printable_name(name_) + ":" + std::to_string(line) + ": found ";
  message.append(found).append(", expected ").append(expected).append("; ").append(advice);
  throw InputError(message);
}

std::string TextCursor::shown(std::string_view token) const {
  if (!token.empty()) return in_quotes(token);
  return at_ == end_ ? "the end of the file" : "the end of the line";
}

void reject_nul(std::string_view text, std::string_view name) {
  const std::size_t nul = text.find('\0');
  if (nul == std::string_view::npos) return;
  // The line of the NUL byte, counting only LF.
  const TextCursor start(text, name, {});
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
  start.fail_at(static_cast<std::uint64_t>(line), "a NUL byte (byte " + std::to_string(nul) + " of the file)",
                "text", "the file is damaged or binary: export or copy it again");
}

}  // namespace lrb

#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::io {
namespace {

/// Scans a text known to be valid JSON and records where values begin.
class Walker {
 public:
  Walker(const std::string& text, std::unordered_map<std::string, std::size_t>& offsets,
         std::string& duplicate)
      : text_(text), offsets_(offsets), duplicate_(duplicate) {}

  void document() {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // skips a byte order mark, as the parser does
    value("");
  }

 private:
  void value(const std::string& pointer) {
    skip_space();
    offsets_.emplace(pointer, at_);
    if (text_[at_] == '{')
      object(pointer);
    else if (text_[at_] == '[')
      array(pointer);
    else if (text_[at_] == '"')
      string();
    else
      while (at_ < text_.size() && std::string_view(",]} \t\r\n").find(text_[at_]) == std::string_view::npos)
        ++at_;
  }

  void object(const std::string& pointer) {
    std::set<std::string> keys;
    ++at_;
    for (skip_space(); text_[at_] != '}'; skip_space()) {
      if (text_[at_] == ',') {
        ++at_;
        skip_space();
      }
      const std::size_t key_at = at_;
      const std::string key = string();
      const std::string child = pointer + "/" + pointer_part(key);
      if (!keys.insert(key).second && duplicate_.empty()) {
        duplicate_ = child;
        offsets_[child + "#"] = key_at;
      }
      offsets_.emplace(child + "#", key_at);
      skip_space();
      ++at_;  // the colon
      value(child);
    }
    ++at_;
  }

  void array(const std::string& pointer) {
    std::size_t i = 0;
    ++at_;
    for (skip_space(); text_[at_] != ']'; skip_space()) {
      if (text_[at_] == ',') ++at_;
      value(pointer + "/" + std::to_string(i++));
    }
    ++at_;
  }

  std::string string() {
    const std::size_t begin = at_++;
    while (text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
    ++at_;
    return nlohmann::json::parse(text_.substr(begin, at_ - begin)).get<std::string>();
  }

  void skip_space() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }

  const std::string& text_;
  std::unordered_map<std::string, std::size_t>& offsets_;
  std::string& duplicate_;
  std::size_t at_ = 0;
};

/// Returns nlohmann's message without its exception name, number and position.
std::string plain_reason(const std::string& what) {
  const std::size_t colon = what.find(": ");
  std::string reason = colon == std::string::npos ? what : what.substr(colon + 2);
  for (const char* mark : {"syntax error while parsing ", "parsing "}) {
    const std::size_t at = reason.find(mark);
    if (at == 0) reason.erase(0, std::string_view(mark).size());
  }
  const std::size_t last_read = reason.find("; last token: ");
  if (last_read != std::string::npos) {  // keeps "expected ...", if present
    const std::size_t expected = reason.find("; expected ", last_read);
    reason = reason.substr(0, last_read) + (expected == std::string::npos ? "" : reason.substr(expected));
  }
  return printable_name(reason);  // on one line, even if it quotes other text
}

/// An iterator over a text. The parser reads through a copy of it; `seen` tracks the copy's position.
class Reading {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Reading(const char* at, const char*& seen) : at_(at), seen_(&seen) {}
  reference operator*() const { return *at_; }
  Reading& operator++() {
    *seen_ = ++at_;
    return *this;
  }
  bool operator==(const Reading& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  const char** seen_;
};

std::string place(const std::string& text, const std::string& file, std::size_t offset) {
  const TextPosition p = position_in(text, offset);
  return file + ":" + std::to_string(p.line) + ":" + std::to_string(p.column) + ": ";
}

/// Checks a text before any value of it is stored, so that a rejected text costs no memory.
class Check final : public nlohmann::json_sax<nlohmann::json> {
 public:
  Check(const std::string& text, const std::string& file) : text_(text), file_(file) {
    parse_with(text_, seen_, *this);
  }

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return enter(); }
  bool key(string_t&) override { return true; }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception& error) override {
    fail_json(text_, file_, position, token, error);
  }

 private:
  bool enter() {
    constexpr int kDeepest = 64;  // levels: Walker is recursive, and lrbscope's files need fewer than ten
    if (++depth_ > kDeepest)
      throw InputError(place(text_, file_, static_cast<std::size_t>(seen_ - text_.data()) - 1) +
                       "nested more than 64 levels deep");
    return true;
  }
  bool leave() {
    --depth_;
    return true;
  }

  const std::string &text_, &file_;
  const char* seen_ = text_.data();
  int depth_ = 0;
};

}  // namespace

void advance(TextPosition& p, const std::string& text, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < std::min(to, text.size()); ++i) {
    if (text[i] == '\n') {
      ++p.line;
      p.column = 1;
    } else if ((static_cast<unsigned char>(text[i]) & 0xC0u) != 0x80u) {  // not a continuation byte of UTF-8
      ++p.column;
    }
  }
}

TextPosition position_in(const std::string& text, std::size_t offset) {
  TextPosition p;
  advance(p, text, 0, offset);
  return p;
}

std::string pointer_part(const std::string& key) {
  std::string out;
  for (const char c : key) {
    if (c == '~')
      out += "~0";
    else if (c == '/')
      out += "~1";
    else
      out += c;
  }
  return out;
}

void parse_with(const std::string& text, const char*& seen, nlohmann::json_sax<nlohmann::json>& handler) {
  nlohmann::json::sax_parse(Reading(text.data(), seen), Reading(text.data() + text.size(), seen), &handler);
}

void reject_nul(const std::string& text, const std::string& file) {
  const std::size_t nul = text.find('\0');
  if (nul != std::string::npos)
    throw InputError(place(text, file, nul) + "not JSON: found a NUL byte, expected text (UTF-8)");
}

void fail_json(const std::string& text, const std::string& file, std::size_t position,
               const std::string& token, const nlohmann::json::exception& error) {
  const bool syntax = dynamic_cast<const nlohmann::json::parse_error*>(&error) != nullptr;
  // For a number beyond a double's range, the position is its end.
  const std::size_t back = syntax ? 1 : token.size();
  throw InputError(place(text, file, position - std::min(position, back)) +
                   (syntax ? "not JSON: " : "not valid JSON: ") + plain_reason(error.what()));
}

JsonIndex::JsonIndex(const std::string& text) {
  Walker(text, offsets_, duplicate_).document();
}

std::size_t JsonIndex::offset(const std::string& pointer) const {
  const auto it = offsets_.find(pointer);
  return it == offsets_.end() ? 0 : it->second;
}

JsonText::JsonText(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
  reject_nul(text_, file_);
  const Check check(text_, file_);
  root_ = nlohmann::json::parse(text_);
  index_ = std::make_unique<JsonIndex>(text_);
  if (!index_->duplicate().empty())
    throw InputError(where(index_->duplicate() + "#") + ": the key " + printable_name(index_->duplicate()) +
                     " occurs twice; keep one");
}

std::string JsonText::where(const std::string& pointer) const {
  const std::size_t offset = index_->offset(pointer);
  if (offset < last_offset_) {
    last_ = {};
    last_offset_ = 0;
  }
  advance(last_, text_, last_offset_, offset);
  last_offset_ = offset;
  return file_ + ":" + std::to_string(last_.line) + ":" + std::to_string(last_.column);
}

}  // namespace lrb::io

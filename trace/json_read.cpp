#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "trace/json_sax.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::io {

// The text: positions of values, and messages about errors.

namespace {

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

/// Checks a text before any value of it is stored, so that a rejected text costs no memory; or finds the
/// offsets of a text that was accepted.
class Check final : public nlohmann::json_sax<nlohmann::json> {
 public:
  /// `offsets`: null if only to check.
  Check(const std::string& text, const std::string& file, JsonOffsets* offsets = nullptr)
      : text_(text), file_(file), offsets_(offsets) {
    if (text_.starts_with("\xef\xbb\xbf")) read_ = 3;  // a byte order mark, which the parser skips
    parse_with(text_, seen_, *this);
  }

  /// Returns the pointer of the first duplicate key, or an empty string if all keys are unique.
  const std::string& duplicate() const { return duplicate_; }

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }
  bool start_object(std::size_t) override { return enter(false); }
  bool key(string_t& key) override {
    if (offsets_ == nullptr) return true;
    const std::size_t begin = begin_of_token();
    Level& object = levels_.back();
    object.member = object.pointer + "/" + pointer_part(key);
    offsets_->emplace(object.member + "#", begin);
    if (!object.keys.insert(key).second && duplicate_.empty()) {
      duplicate_ = object.member;
      (*offsets_)[duplicate_ + "#"] = begin;
    }
    return true;
  }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t) override { return enter(true); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception& error) override {
    fail_json(text_, file_, position, token, error);
  }

 private:
  /// An open container.
  struct Level {
    std::string pointer, member;  ///< member: of the current value
    bool is_array = false;
    std::size_t size = 0;
    std::set<std::string> keys = {};
  };

  /// Returns where the token that was just read begins: behind space and punctuation after the one before.
  /// The parser has read one character beyond a number.
  std::size_t begin_of_token() {
    const std::size_t begin = text_.find_first_not_of(" \t\r\n,:]}", read_);
    read_ = static_cast<std::size_t>(seen_ - text_.data());
    return begin;
  }
  bool value() {
    if (offsets_ != nullptr) offsets_->emplace(pointer(), begin_of_token());
    return true;
  }
  std::string pointer() {
    if (levels_.empty()) return "";
    Level& open = levels_.back();
    return open.is_array ? open.pointer + "/" + std::to_string(open.size++) : open.member;
  }
  bool enter(bool is_array) {
    constexpr std::size_t kDeepest = 64;  // levels: lrbscope's files need fewer than ten
    if (levels_.size() == kDeepest)
      throw InputError(place(text_, file_, static_cast<std::size_t>(seen_ - text_.data()) - 1) +
                       "nested more than 64 levels deep");
    Level level;
    if (offsets_ != nullptr) offsets_->emplace(level.pointer = pointer(), begin_of_token());
    level.is_array = is_array;
    levels_.push_back(std::move(level));
    return true;
  }
  bool leave() {
    levels_.pop_back();
    return true;
  }

  const std::string &text_, &file_;
  JsonOffsets* offsets_;
  const char* seen_ = text_.data();
  std::size_t read_ = 0;  ///< end of the last token
  std::vector<Level> levels_;
  std::string duplicate_;
};

}  // namespace

void advance(TextPosition& p, std::string_view text, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < std::min(to, text.size()); ++i) {
    if (text[i] == '\n') {
      ++p.line;
      p.column = 1;
    } else if ((static_cast<unsigned char>(text[i]) & 0xC0u) != 0x80u) {  // not a continuation byte of UTF-8
      ++p.column;
    }
  }
}

TextPosition position_in(std::string_view text, std::size_t offset) {
  TextPosition p;
  advance(p, text, 0, offset);
  return p;
}

std::string plain_reason(const std::string& what) {
  std::string reason = what;
  if (reason.starts_with("[json.")) reason.erase(0, reason.find(' ') + 1);
  if (reason.starts_with("parse error at ")) reason.erase(0, reason.find(": ") + 2);
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

JsonText::JsonText(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
  reject_nul(text_, file_);
  static_cast<void>(Check(text_, file_));
  root_ = std::make_unique<nlohmann::json>(nlohmann::json::parse(text_));
  if (const std::string twice = Check(text_, file_, &offsets_).duplicate(); !twice.empty())
    throw InputError(where(twice + "#") + ": the key " + printable_name(twice) + " occurs twice; keep one");
}

JsonText::~JsonText() = default;

std::string JsonText::where(const std::string& pointer) const {
  const auto found = offsets_.find(pointer);
  const std::size_t offset = found == offsets_.end() ? 0 : found->second;
  if (offset < last_offset_) {
    last_ = {};
    last_offset_ = 0;
  }
  advance(last_, text_, last_offset_, offset);
  last_offset_ = offset;
  return file_ + ":" + std::to_string(last_.line) + ":" + std::to_string(last_.column);
}

// Values.

Pose pose_of(std::span<const double, 12> rows) {
  Pose pose;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) pose.r(r, c) = rows[static_cast<std::size_t>(4 * r + c)];
    pose.t[r] = rows[static_cast<std::size_t>(4 * r + 3)];
  }
  return pose;
}

std::array<double, 12> rows_of(const Pose& pose) {
  std::array<double, 12> out{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(4 * r + c)] = pose.r(r, c);
    out[static_cast<std::size_t>(4 * r + 3)] = pose.t[r];
  }
  return out;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  // Longer words are not typing errors; bounds the quadratic table above.
  constexpr std::size_t kLongestWord = 64;
  if (word.size() > kLongestWord) return {};
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& k : known) {
    const std::size_t distance = edit_distance(word, k);
    if (distance < best_distance) {
      best_distance = distance;
      best = k;
    }
  }
  return best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  std::string out;
  const std::string near = nearest_word(word, known);
  if (!near.empty()) out += "; did you mean \"" + near + "\"?";
  for (std::size_t i = 0; i < known.size(); ++i)
    out += (i == 0 ? (near.empty() ? "; known: " : " known: ") : ", ") + known[i];
  return out;
}

void JsonNode::fail(const std::string& message) const {
  throw InputError(text_->where(pointer_) + ": " +
                   printable_name((pointer_.empty() ? "" : pointer_ + ": ") + message));
}

void JsonNode::fail_key(const std::string& key, const std::string& message) const {
  const std::string member = pointer_ + "/" + pointer_part(key);
  throw InputError(text_->where(member + "#") + ": " + printable_name(member + ": " + message));
}

void JsonNode::fail_type(const char* expected) const {
  fail(std::string("expected ") + expected + ", found " + value_->type_name());
}

std::size_t JsonNode::index_among(const std::vector<std::string>& known) const {
  if (!value_->is_string()) fail_type("a word");
  const auto& word = value_->get_ref<const std::string&>();
  const auto found = std::find(known.begin(), known.end(), word);
  if (found == known.end()) fail("\"" + word + "\": unknown word" + suggestion(word, known));
  return static_cast<std::size_t>(found - known.begin());
}

bool JsonNode::has(const std::string& key) const {
  return value_->is_object() && value_->contains(key);
}
bool JsonNode::is_array() const {
  return value_->is_array();
}
bool JsonNode::is_object() const {
  return value_->is_object();
}
bool JsonNode::is_string() const {
  return value_->is_string();
}

const JsonNode& JsonNode::object(const std::vector<std::string>& keys) const {
  if (!value_->is_object()) fail_type("an object");
  for (const auto& [key, value] : value_->items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      fail_key(key, "unknown key" + suggestion(key, keys));
  return *this;
}

JsonNode JsonNode::at(const std::string& key) const {
  if (!value_->is_object()) fail_type("an object");
  if (!value_->contains(key)) fail("the key \"" + key + "\" is missing; add it");
  return {*text_, (*value_)[key], pointer_ + "/" + pointer_part(key)};
}

std::optional<JsonNode> JsonNode::get(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return at(key);
}

std::vector<JsonNode> JsonNode::items(std::size_t least) const {
  if (!value_->is_array()) fail_type("an array");
  if (value_->size() < least)
    fail("expected at least " + std::to_string(least) + " items, found " + std::to_string(value_->size()));
  std::vector<JsonNode> out;
  for (std::size_t i = 0; i < value_->size(); ++i)
    out.push_back(JsonNode(*text_, (*value_)[i], pointer_ + "/" + std::to_string(i)));
  return out;
}

double JsonNode::number(double least, double most) const {
  if (!value_->is_number()) fail_type("a number");
  const double x = value_->get<double>();
  if (!std::isfinite(x) || x < least || x > most)
    fail("expected a number from " + number_text(least, 6) + " to " + number_text(most, 6) + ", found " +
         value_->dump());
  return x;
}

std::uint64_t JsonNode::integer(std::uint64_t least, std::uint64_t most) const {
  const bool whole = value_->is_number_unsigned();
  if (!value_->is_number()) fail_type("a whole number");
  if (!whole || value_->get<std::uint64_t>() < least || value_->get<std::uint64_t>() > most)
    fail("expected a whole number from " + std::to_string(least) + " to " + std::to_string(most) +
         ", found " + value_->dump());
  return value_->get<std::uint64_t>();
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) fail_type("true or false");
  return value_->get<bool>();
}

std::string JsonNode::string() const {
  if (!value_->is_string()) fail_type("a string");
  return value_->get<std::string>();
}

std::vector<double> JsonNode::numbers(std::size_t count) const {
  constexpr double kAny = std::numeric_limits<double>::max();
  if (!value_->is_array()) fail_type("an array of numbers");
  if (value_->size() != count)
    fail("expected " + std::to_string(count) + " numbers, found " + std::to_string(value_->size()));
  std::vector<double> out;
  for (const JsonNode& item : items()) out.push_back(item.number(-kAny, kAny));
  return out;
}

Eigen::Vector3d JsonNode::vector() const {
  const std::vector<double> x = numbers(3);
  return {x[0], x[1], x[2]};
}

}  // namespace lrb::io

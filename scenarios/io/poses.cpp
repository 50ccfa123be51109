#include "scenarios/io/poses.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "scenarios/io/files.hpp"
#include "trace/json_sax.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::io {
namespace {

constexpr std::string_view kBetween = " \t\r\v\f,";

std::vector<std::string_view> words_in(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(kBetween); at != std::string_view::npos;
       at = line.find_first_not_of(kBetween, at)) {
    const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// Returns a word in a form suitable for a one-line message.
std::string shown(std::string_view word) {
  constexpr std::size_t kLongest = 32;
  std::string out;
  for (const char c : word.substr(0, kLongest)) out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  return "\"" + out + (word.size() > kLongest ? "...\"" : "\"");
}

/// `wanted`: the expected content of each line, for the message.
double number(std::string_view word, const std::string& where, const std::string& wanted) {
  // from_chars does not accept a plus sign.
  const std::string_view digits = word.substr(word[0] == '+' ? 1 : 0);
  double x = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
  if (error == std::errc::result_out_of_range) {
    // Rounded to nearest: 0 for a number below the range.
    const double nearest = std::strtod(std::string(digits).c_str(), nullptr);
    if (std::abs(nearest) < 1) return nearest;
    throw InputError(where + shown(word) + " exceeds the range of a double");
  }
  if (error != std::errc() || end != digits.data() + digits.size())
    throw InputError(where + shown(word) + " is not a number: expected " + wanted);
  if (!std::isfinite(x))
    throw InputError(where + shown(word) + " is not finite; every number must be finite");
  return x;
}

/// Returns the next line of a text and moves `at` past it.
std::string_view next_line(const std::string& text, std::size_t& at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string_view line = std::string_view(text).substr(at, end - at);
  at = end + 1;
  return line;
}

/// Returns the length of a UTF-8 byte order mark at the beginning of a text, which spreadsheets write.
std::size_t mark_of(const std::string& text) {
  return text.starts_with("\xef\xbb\xbf") ? 3 : 0;
}

std::string_view trimmed(std::string_view cell) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  const std::size_t first = cell.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(kBlank) + 1 - first);
}

/// Returns the cells of a table's line, without surrounding blanks and quotes; empty for a line without
/// content. A comma in quotes does not end a cell.
std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  if (trimmed(line).empty() || trimmed(line)[0] == '#') return cells;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= line.size(); ++at) {
    if (at < line.size() && line[at] == '"') quoted = !quoted;
    if (at < line.size() && (line[at] != ',' || quoted)) continue;
    std::string_view cell = trimmed(line.substr(begin, at - begin));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.push_back(cell);
    begin = at + 1;
  }
  return cells;
}

bool names_columns(const std::vector<std::string_view>& cells) {
  return std::any_of(cells.begin(), cells.end(), [](std::string_view cell) {
    return std::find(kPoseColumns.begin(), kPoseColumns.end(), cell) != kPoseColumns.end();
  });
}

/// Returns the column of each number of a pose in a table's lines.
std::array<std::size_t, 12> columns_of(const std::vector<std::string_view>& names, const std::string& where) {
  std::array<std::size_t, 12> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto at = std::find(names.begin(), names.end(), kPoseColumns[i]);
    if (at == names.end())
      throw InputError(where + "missing column " + std::string(kPoseColumns[i]) +
                       ": expected r00,r01,r02,tx,r10,r11,r12,ty,r20,r21,r22,tz in any order");
    out[i] = static_cast<std::size_t>(at - names.begin());
  }
  return out;
}

double number_in(const std::vector<std::string_view>& cells, std::size_t column, const std::string& where) {
  if (cells[column].empty())
    throw InputError(where + "cell " + std::to_string(column + 1) + " is empty: expected a number");
  return number(cells[column], where, "12 numbers per line");
}

/// Throws unless the last four of 16 cells are 0, 0, 0, 1.
void check_last_row(const std::vector<std::string_view>& cells, const std::string& where) {
  for (std::size_t i = 12; i < 16; ++i)
    if (number_in(cells, i, where) != (i == 15 ? 1 : 0))
      throw InputError(where + "expected 0, 0, 0, 1 as the last row of the 4x4 pose");
}

/// Returns the number of the first cell of a line, from 1, that has nothing before its comma; 0: none.
std::size_t empty_cell(std::string_view line) {
  line = line.substr(0, line.find('#'));
  for (std::size_t cell = 1, at = 0;; ++cell) {
    const std::size_t end = line.find(',', at);
    if (end == std::string_view::npos) return 0;
    if (trimmed(line.substr(at, end - at)).empty()) return cell;
    at = end + 1;
  }
}

/// Calls visit(numbers, line) for each line of `count` numbers; `meaning` describes them for messages.
template <class Visit>
void read_lines(const std::string& text, const std::string& name, std::size_t count, const char* meaning,
                Visit&& visit) {
  const std::string numbers = std::to_string(count) + " numbers";
  std::vector<double> x(count);
  std::size_t line_number = 0;
  for (std::size_t at = mark_of(text); at < text.size();) {
    const std::string_view line = next_line(text, at);
    const std::vector<std::string_view> words = words_in(line);
    const std::string where = name + ":" + std::to_string(++line_number) + ": ";
    if (words.empty()) continue;
    if (const std::size_t cell = empty_cell(line))
      throw InputError(where + "cell " + std::to_string(cell) + " is empty: expected a number");
    for (std::size_t i = 0; i < words.size() && i < count; ++i)
      x[i] = number(words[i], where, numbers + " per line");
    if (words.size() != count)
      throw InputError(where + "expected " + numbers + " (" + meaning + "), found " +
                       std::to_string(words.size()));
    visit(std::span<const double>(x), line_number);
  }
}

}  // namespace

std::vector<Pose> parse_poses(const std::string& text, const std::string& name,
                              std::vector<std::size_t>* lines) {
  std::vector<Pose> poses;
  read_lines(text, name, 12, "a row-major 3x4 pose", [&](std::span<const double> x, std::size_t line) {
    poses.push_back(pose_of(x.first<12>()));
    if (lines != nullptr) lines->push_back(line);
  });
  if (poses.empty()) throw InputError(name + ": no poses: expected lines of 12 numbers (row-major 3x4)");
  return poses;
}

std::vector<PosePair> parse_motions(const std::string& text, const std::string& name) {
  std::vector<PosePair> motions;
  read_lines(text, name, 24, "two row-major 3x4 poses", [&](std::span<const double> x, std::size_t line) {
    motions.push_back({pose_of(x.first<12>()), pose_of(x.last<12>()), line});
  });
  if (motions.empty())
    throw InputError(name + ": no motions: expected lines of 24 numbers (two poses, row-major 3x4)");
  return motions;
}

std::vector<PosePair> read_motions(const std::string& path) {
  return parse_motions(read_text(path), path);
}

std::vector<Eigen::Vector3d> parse_points(const std::string& text, const std::string& name) {
  std::vector<Eigen::Vector3d> points;
  // The names of the columns, as tables have them, become a comment: the lines keep their numbers.
  const std::size_t mark = mark_of(text);
  std::size_t at = mark;
  const std::vector<std::string_view> names = words_in(next_line(text, at));
  const bool named = names == std::vector<std::string_view>{"x", "y", "z"};
  read_lines(named ? "#" + text.substr(mark) : text, name, 3, "x, y and z of a point",
             [&](std::span<const double> x, std::size_t) { points.emplace_back(x[0], x[1], x[2]); });
  if (points.empty()) throw InputError(name + ": no points: expected lines of 3 numbers (x, y, z)");
  return points;
}

std::vector<Eigen::Vector3d> read_points(const std::string& path) {
  return parse_points(read_text(path), path);
}

std::vector<Pose> parse_pose_table(const std::string& text, const std::string& name,
                                   std::vector<std::size_t>* lines) {
  std::vector<Pose> poses;
  std::array<std::size_t, 12> column{};
  std::iota(column.begin(), column.end(), 0U);
  bool named = false;
  std::size_t line_number = 0;
  for (std::size_t at = mark_of(text); at < text.size();) {
    const std::vector<std::string_view> cells = cells_of(next_line(text, at));
    const std::string where = name + ":" + std::to_string(++line_number) + ": ";
    if (cells.empty()) continue;
    if (poses.empty() && !named && names_columns(cells)) {
      column = columns_of(cells, where);
      named = true;
      continue;
    }
    const bool whole = !named && cells.size() == 16;
    if (whole) check_last_row(cells, where);
    const std::size_t needed = *std::max_element(column.begin(), column.end()) + 1;
    if (!whole && (named ? cells.size() < needed : cells.size() != 12))
      throw InputError(where + "expected " +
                       (named ? std::to_string(needed) + " cells, as in the first line"
                              : "12 numbers (a row-major 3x4 pose) or 16 (4x4)") +
                       ", found " + std::to_string(cells.size()) +
                       (cells.size() == 1 ? "; in a .csv file, commas separate them" : ""));
    std::array<double, 12> x{};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = number_in(cells, column[i], where);
    poses.push_back(pose_of(x));
    if (lines != nullptr) lines->push_back(line_number);
  }
  if (poses.empty()) throw InputError(name + ": no poses: expected lines of 12 numbers (row-major 3x4)");
  return poses;
}

Eigen::Vector3d parse_vector(const std::string& text, const std::string& option) {
  const std::vector<std::string_view> words = words_in(text);
  if (words.size() != 3)
    throw InputError(option + ": expected three numbers X,Y,Z, found " + std::to_string(words.size()) +
                     " in \"" + text + "\"");
  const std::string where = option + ": ";
  const auto x = [&](std::size_t i) { return number(words[i], where, "three numbers X,Y,Z"); };
  return {x(0), x(1), x(2)};
}

namespace {

bool ends_like(const std::string& path, std::string_view ending) {
  return path.size() >= ending.size() &&
         std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char x, char y) { return x == std::tolower(static_cast<unsigned char>(y)); });
}

/// Receives poses from a parser, and stops it at the first invalid value.
class PoseParser : public nlohmann::json_sax<nlohmann::json> {
 public:
  PoseParser(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  PoseList parse() {
    reject_nul(text_, name_);
    parse_with(text_, seen_, *this);
    return std::move(out_);
  }

  bool null() override { return scalar("null"); }
  bool boolean(bool) override { return scalar("boolean"); }
  bool number_integer(number_integer_t x) override { return number(static_cast<double>(x)); }
  bool number_unsigned(number_unsigned_t x) override { return number(static_cast<double>(x)); }
  bool number_float(number_float_t x, const string_t&) override { return number(x); }
  bool string(string_t&) override { return scalar("string"); }
  bool binary(binary_t&) override { return scalar("binary"); }

  bool key(string_t& key) override {
    if (level_ == Level::object && skipped_ == 0 && key == "poses") {
      if (!pointer_.empty())
        throw InputError(place(value_start()) + ": the key /poses occurs twice; keep one");
      pointer_ = "/poses";
      level_ = Level::member;
    }
    return done();
  }

  bool start_object(std::size_t) override {
    if (level_ == Level::root)
      level_ = Level::object;
    else if (level_ == Level::object || skipped_ > 0)
      ++skipped_;
    else
      reject("object");
    return done();
  }

  bool end_object() override {
    if (skipped_ > 0)
      --skipped_;
    else if (pointer_.empty())
      reject_root();
    return done();
  }

  bool start_array(std::size_t) override {
    switch (level_) {
      case Level::root:
      case Level::member:
        start_[0] = value_start();
        of_object_ = level_ == Level::member;
        level_ = Level::list;
        break;
      case Level::object:
        ++skipped_;
        break;
      case Level::list:
        start_[1] = value_start();
        advance(position_, text_, reached_, start_[1]);
        reached_ = start_[1];
        found_ = 0;
        items_ = 0;
        level_ = Level::pose;
        break;
      case Level::pose:
        start_[2] = value_start();
        in_row_ = 0;
        level_ = Level::row;
        break;
      case Level::row:
        reject("array");
    }
    return done();
  }

  bool end_array() override {
    switch (level_) {
      case Level::object:
        --skipped_;
        break;
      case Level::list:
        if (out_.poses.empty()) fail(start_[0], pointer_, "expected at least 1 items, found 0");
        level_ = of_object_ ? Level::object : Level::root;
        break;
      case Level::pose:
        take_pose();
        level_ = Level::list;
        break;
      default:  // a row
        if (in_row_ != 4)
          fail(start_[2], item_pointer(), "expected 4 numbers, found " + std::to_string(in_row_));
        ++items_;
        level_ = Level::pose;
    }
    return done();
  }

  bool parse_error(std::size_t position, const std::string& token,
                   const nlohmann::json::exception& error) override {
    fail_json(text_, name_, position, token, error);
  }

 private:
  /// The parser's current context: before the list, in an object whose other members are skipped, after the
  /// key "poses", in the list, in a pose, or in one of its rows.
  enum class Level : std::uint8_t { root, object, member, list, pose, row };

  bool done() {
    last_end_ = static_cast<std::size_t>(seen_ - text_.data());
    return true;
  }

  /// Returns the start of the value that the parser has just reached.
  std::size_t value_start() const { return text_.find_first_not_of(" \t\r\n,:", last_end_); }

  bool scalar(const char* type) {
    if (level_ != Level::object) reject(type);
    return done();
  }

  bool number(double x) {
    if (level_ != Level::pose && level_ != Level::row) return scalar("number");
    if (found_ < x_.size()) x_[found_] = x;
    ++found_;
    ++(level_ == Level::row ? in_row_ : items_);
    return done();
  }

  void take_pose() {
    if (found_ != 12 && found_ != 16)
      fail(start_[1], pose_pointer(),
           "expected a pose of 12 numbers (3x4, row by row) or 16 (4x4), found " + std::to_string(found_));
    constexpr std::array<double, 4> kLast = {0, 0, 0, 1};
    if (found_ == 16 && !std::equal(kLast.begin(), kLast.end(), x_.begin() + 12))
      fail(start_[1], pose_pointer(), "expected 0, 0, 0, 1 as the last row of the 4x4 pose");
    out_.poses.push_back(pose_of(std::span<const double, 12>(x_.data(), 12)));
    out_.places.push_back(place(position_));
  }

  std::string pose_pointer() const { return pointer_ + "/" + std::to_string(out_.poses.size()); }
  std::string item_pointer() const { return pose_pointer() + "/" + std::to_string(items_); }

  std::string place(const TextPosition& p) const {
    return name_ + ":" + std::to_string(p.line) + ":" + std::to_string(p.column);
  }
  std::string place(std::size_t offset) const { return place(position_in(text_, offset)); }

  [[noreturn]] void fail(std::size_t offset, const std::string& pointer, const std::string& message) const {
    throw InputError(place(offset) + ": " + (pointer.empty() ? "" : pointer + ": ") + message);
  }

  [[noreturn]] void reject_root() const {
    fail(0, "", "expected an array of poses, or an object with such an array as \"poses\"");
  }

  /// Rejects a value of this type at its location.
  [[noreturn]] void reject(const char* type) const {
    const std::string found = std::string(", found ") + type;
    if (level_ == Level::root) reject_root();
    if (level_ == Level::member) fail(value_start(), pointer_, "expected an array" + found);
    if (level_ == Level::list) fail(value_start(), pose_pointer(), "expected an array" + found);
    fail(value_start(), item_pointer() + (level_ == Level::row ? "/" + std::to_string(in_row_) : ""),
         "expected a number" + found);
  }

  const std::string &text_, &name_;
  const char* seen_ = text_.data();
  std::size_t last_end_ = 0;   ///< of the previous value or key
  TextPosition position_;      ///< of the current or previous pose
  std::size_t reached_ = 0;    ///< the offset of position_
  std::size_t start_[3] = {};  ///< of the list, the pose and the row
  Level level_ = Level::root;
  bool of_object_ = false;                          ///< the list is a member of an object
  std::size_t skipped_ = 0;                         ///< enclosing values that are skipped
  std::string pointer_;                             ///< of the list
  std::size_t found_ = 0, items_ = 0, in_row_ = 0;  ///< numbers and items of the pose, numbers of the row
  std::array<double, 16> x_{};
  PoseList out_;
};

std::string row_text(const Pose& pose, std::string_view between, bool json) {
  std::string out;
  for (const double x : rows_of(pose)) {
    if (!out.empty()) out += between;
    out += exact_text(x);
    // "-0" would be parsed as an integer, and lose its sign.
    if (json && x == 0 && std::signbit(x)) out += ".0";
  }
  return out;
}

std::string pose_table(std::span<const Pose> poses) {
  std::string out;
  for (const std::string_view name : kPoseColumns) out.append(out.empty() ? "" : ",").append(name);
  for (const Pose& pose : poses) out += "\n" + row_text(pose, ",", false);
  return out + "\n";
}

std::string pose_json(std::span<const Pose> poses) {
  std::string out = "[";
  for (std::size_t i = 0; i < poses.size(); ++i)
    out += (i == 0 ? "\n  [" : ",\n  [") + row_text(poses[i], ", ", true) + "]";
  return out + "\n]\n";
}

}  // namespace

PoseList open_poses(const std::string& path) {
  const std::string name = printable_name(path);
  constexpr std::uint64_t kMaxJson = std::uint64_t{64} << 20;
  if (ends_like(path, ".json")) return parse_pose_json(read_text(path, kMaxJson), name);
  // A pipe has no extension: the content decides.
  const std::string text = read_text(path);
  std::size_t at = text.find_first_not_of(" \t\r\n", mark_of(text));
  if (at != std::string::npos && (text[at] == '[' || text[at] == '{')) {
    if (text.size() > kMaxJson)
      throw InputError(name + ": expected at most " + std::to_string(kMaxJson) +
                       " bytes of JSON, found more; write lines of numbers instead");
    return parse_pose_json(text, name);
  }
  PoseList out;
  std::vector<std::size_t> lines;
  const bool is_table = at != std::string::npos && names_columns(cells_of(next_line(text, at)));
  out.poses = is_table || ends_like(path, ".csv") ? parse_pose_table(text, name, &lines)
                                                  : parse_poses(text, name, &lines);
  for (const std::size_t line : lines) out.places.push_back(name + ":" + std::to_string(line));
  return out;
}

PoseList parse_pose_json(const std::string& text, const std::string& name) {
  return PoseParser(text, name).parse();
}

void save_poses(const std::string& path, std::span<const Pose> poses) {
  std::string text;
  if (ends_like(path, ".json")) {
    text = pose_json(poses);
  } else if (ends_like(path, ".csv")) {
    text = pose_table(poses);
  } else {
    for (const Pose& pose : poses) text += row_text(pose, " ", false) + "\n";
  }
  write_text(path, text);
}

}  // namespace lrb::io

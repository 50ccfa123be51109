#include "scenarios/io/json/pose_list.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/json/json_text.hpp"
#include "scenarios/io/number_text.hpp"
#include "scenarios/io/pose_file.hpp"

namespace lrb::io {
namespace {

bool ends_like(const std::string& path, std::string_view ending) {
  return path.size() >= ending.size() &&
         std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char x, char y) { return x == std::tolower(static_cast<unsigned char>(y)); });
}

/// Takes poses from a parser, and stops it at the first value that is none.
class PoseParser : public nlohmann::json_sax<nlohmann::json> {
 public:
  PoseParser(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  PoseList parse() {
    refuse_nul(text_, name_);
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
        throw InputError(place(value_start()) + ": the key /poses occurs twice: keep one");
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
      refuse("object");
    return done();
  }

  bool end_object() override {
    if (skipped_ > 0)
      --skipped_;
    else if (pointer_.empty())
      refuse_root();
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
        refuse("array");
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
  /// What the parser is in: before the list, in an object of which members but one are skipped, behind the
  /// key "poses", in the list, in a pose, or in a row of it.
  enum class Level : std::uint8_t { root, object, member, list, pose, row };

  bool done() {
    last_end_ = static_cast<std::size_t>(seen_ - text_.data());
    return true;
  }

  /// Returns where the value begins that the parser has just reached.
  std::size_t value_start() const { return text_.find_first_not_of(" \t\r\n,:", last_end_); }

  bool scalar(const char* type) {
    if (level_ != Level::object) refuse(type);
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
      fail(start_[1], pose_pointer(), "the last row of the 4x4 pose is not 0, 0, 0, 1");
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

  [[noreturn]] void refuse_root() const {
    fail(0, "", "expected an array of poses, or an object with such an array as \"poses\"");
  }

  /// Refuses a value of this type where it is.
  [[noreturn]] void refuse(const char* type) const {
    const std::string found = std::string(", found ") + type;
    if (level_ == Level::root) refuse_root();
    if (level_ == Level::member) fail(value_start(), pointer_, "expected an array" + found);
    if (level_ == Level::list) fail(value_start(), pose_pointer(), "expected an array" + found);
    fail(value_start(), item_pointer() + (level_ == Level::row ? "/" + std::to_string(in_row_) : ""),
         "expected a number" + found);
  }

  const std::string &text_, &name_;
  const char* seen_ = text_.data();
  std::size_t last_end_ = 0;   ///< of the value or key before
  TextPosition position_;      ///< of the pose, or of the one before
  std::size_t reached_ = 0;    ///< the offset of position_
  std::size_t start_[3] = {};  ///< of the list, the pose and the row
  Level level_ = Level::root;
  bool of_object_ = false;                          ///< the list is a member
  std::size_t skipped_ = 0;                         ///< values around this one that are skipped
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
    if (json && x == 0 && std::signbit(x)) out += ".0";  // "-0" would be an integer, and lose its sign
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
  constexpr std::uint64_t kMostJson = std::uint64_t{64} << 20;
  if (ends_like(path, ".json")) return parse_pose_json(read_text(path, kMostJson), name);
  PoseList out;
  std::vector<std::size_t> lines;
  out.poses = ends_like(path, ".csv") ? parse_pose_table(read_text(path), name, &lines)
                                      : parse_poses(read_text(path), name, &lines);
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

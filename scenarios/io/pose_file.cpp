#include "scenarios/io/pose_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string_view>

#include "engine/core/error.hpp"
#include "scenarios/io/files.hpp"

namespace lrb::io {
namespace {

constexpr std::string_view kBetween = " \t\r\v\f,";

std::vector<std::string_view> words_of(std::string_view line) {
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

/// Returns a word as it can be shown in a one-line message.
std::string shown(std::string_view word) {
  constexpr std::size_t kLongest = 32;
  std::string out;
  for (const char c : word.substr(0, kLongest)) out += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  return "\"" + out + (word.size() > kLongest ? "...\"" : "\"");
}

/// wanted: what each line must have, for the message.
double number(std::string_view word, const std::string& where, const std::string& wanted) {
  const std::string_view digits = word.substr(word[0] == '+' ? 1 : 0);  // from_chars does not read a plus
                                                                        // sign
  double x = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
  if (error == std::errc::result_out_of_range)
    throw InputError(where + shown(word) + " is beyond the range of a double");
  if (error != std::errc() || end != digits.data() + digits.size())
    throw InputError(where + shown(word) + " is not a number: expected " + wanted);
  if (!std::isfinite(x))
    throw InputError(where + shown(word) + " is not finite: every number of a pose must be");
  return x;
}

/// Returns the next line of a text and moves `at` behind it.
std::string_view next_line(const std::string& text, std::size_t& at) {
  const std::size_t end = std::min(text.find('\n', at), text.size());
  const std::string_view line = std::string_view(text).substr(at, end - at);
  at = end + 1;
  return line;
}

std::string_view trimmed(std::string_view cell) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  const std::size_t first = cell.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(kBlank) + 1 - first);
}

/// Returns the cells of a table's line, without blanks and quotes around them; none for a line without
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

/// Returns where in a table's line each number of a pose stands.
std::array<std::size_t, 12> columns_of(const std::vector<std::string_view>& names, const std::string& where) {
  std::array<std::size_t, 12> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto at = std::find(names.begin(), names.end(), kPoseColumns[i]);
    if (at == names.end())
      throw InputError(where + "no column " + std::string(kPoseColumns[i]) +
                       ": expected r00,r01,r02,tx,r10,r11,r12,ty,r20,r21,r22,tz in any order");
    out[i] = static_cast<std::size_t>(at - names.begin());
  }
  return out;
}

double number_in(const std::vector<std::string_view>& cells, std::size_t column, const std::string& where) {
  if (cells[column].empty())
    throw InputError(where + "cell " + std::to_string(column + 1) + " is empty: expected a number");
  return number(cells[column], where, "12 numbers a line");
}

/// Throws unless the last four of 16 cells are the last row of a pose.
void check_last_row(const std::vector<std::string_view>& cells, const std::string& where) {
  for (std::size_t i = 12; i < 16; ++i)
    if (number_in(cells, i, where) != (i == 15 ? 1 : 0))
      throw InputError(where + "the last row of the 4x4 pose is not 0, 0, 0, 1");
}

/// Calls see(numbers, line) for each line of `count` numbers; `meaning` says what these are.
template <class See>
void read_lines(const std::string& text, const std::string& name, std::size_t count, const char* meaning,
                See&& see) {
  const std::string numbers = std::to_string(count) + " numbers";
  std::vector<double> x(count);
  std::size_t line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::vector<std::string_view> words = words_of(next_line(text, at));
    const std::string where = name + ":" + std::to_string(++line_number) + ": ";
    if (words.empty()) continue;
    for (std::size_t i = 0; i < words.size() && i < count; ++i)
      x[i] = number(words[i], where, numbers + " a line");
    if (words.size() != count)
      throw InputError(where + "expected " + numbers + " (" + meaning + "), found " +
                       std::to_string(words.size()));
    see(std::span<const double>(x), line_number);
  }
}

}  // namespace

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

std::vector<Pose> parse_pose_table(const std::string& text, const std::string& name,
                                   std::vector<std::size_t>* lines) {
  std::vector<Pose> poses;
  std::array<std::size_t, 12> column{};
  std::iota(column.begin(), column.end(), 0U);
  bool named = false;
  std::size_t line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
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
                       (named ? std::to_string(needed) + " cells, as the first line names them"
                              : "12 numbers (a row-major 3x4 pose) or 16 (4x4)") +
                       ", found " + std::to_string(cells.size()));
    std::array<double, 12> x{};
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = number_in(cells, column[i], where);
    poses.push_back(pose_of(x));
    if (lines != nullptr) lines->push_back(line_number);
  }
  if (poses.empty()) throw InputError(name + ": no poses: expected lines of 12 numbers (row-major 3x4)");
  return poses;
}

Eigen::Vector3d parse_vector(const std::string& text, const std::string& option) {
  const std::vector<std::string_view> words = words_of(text);
  if (words.size() != 3)
    throw InputError(option + ": expected three numbers X,Y,Z, found " + std::to_string(words.size()) +
                     " in \"" + text + "\"");
  const std::string where = option + ": ";
  const auto x = [&](std::size_t i) { return number(words[i], where, "three numbers X,Y,Z"); };
  return {x(0), x(1), x(2)};
}

}  // namespace lrb::io

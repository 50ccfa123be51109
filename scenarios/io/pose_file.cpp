#include "scenarios/io/pose_file.hpp"

#include <charconv>
#include <cmath>
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

Pose pose_of(const double* x) {
  Pose pose;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) pose.r(r, c) = x[4 * r + c];
    pose.t[r] = x[4 * r + 3];
  }
  return pose;
}

/// Calls see(numbers, line) for each line of `count` numbers; `meaning` says what these are.
template <class See>
void read_lines(const std::string& text, const std::string& name, std::size_t count, const char* meaning,
                See&& see) {
  const std::string numbers = std::to_string(count) + " numbers";
  std::vector<double> x(count);
  std::size_t line_number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::vector<std::string_view> words = words_of(std::string_view(text).substr(at, end - at));
    at = end + 1;
    const std::string where = name + ":" + std::to_string(++line_number) + ": ";
    if (words.empty()) continue;
    for (std::size_t i = 0; i < words.size() && i < count; ++i)
      x[i] = number(words[i], where, numbers + " a line");
    if (words.size() != count)
      throw InputError(where + "expected " + numbers + " (" + meaning + "), found " +
                       std::to_string(words.size()));
    see(x.data(), line_number);
  }
}

}  // namespace

std::vector<Pose> parse_poses(const std::string& text, const std::string& name,
                              std::vector<std::size_t>* lines) {
  std::vector<Pose> poses;
  read_lines(text, name, 12, "a row-major 3x4 pose", [&](const double* x, std::size_t line) {
    poses.push_back(pose_of(x));
    if (lines != nullptr) lines->push_back(line);
  });
  if (poses.empty()) throw InputError(name + ": no poses: expected lines of 12 numbers (row-major 3x4)");
  return poses;
}

std::vector<PosePair> parse_motions(const std::string& text, const std::string& name) {
  std::vector<PosePair> motions;
  read_lines(text, name, 24, "two row-major 3x4 poses", [&](const double* x, std::size_t line) {
    motions.push_back({pose_of(x), pose_of(x + 12), line});
  });
  if (motions.empty())
    throw InputError(name + ": no motions: expected lines of 24 numbers (two poses, row-major 3x4)");
  return motions;
}

std::vector<PosePair> read_motions(const std::string& path) {
  return parse_motions(read_text(path), path);
}

std::vector<Pose> read_poses(const std::string& path, std::vector<std::size_t>* lines) {
  return parse_poses(read_text(path), path, lines);
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

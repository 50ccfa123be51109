#include "trace/measured.hpp"

#include <charconv>
#include <utility>

namespace lrb::trace {

namespace {

std::array<double, 3> array_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::optional<std::array<double, 2>> ends_of(const std::optional<ProvedInterval>& interval) {
  if (!interval) return std::nullopt;
  return std::array<double, 2>{interval->lower, interval->upper};
}

std::string digits(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string interval_words(double lower, double upper, std::size_t looks) {
  return "[" + digits(lower) + ", " + digits(upper) + "] in " + std::to_string(looks) + " looks";
}

}  // namespace

MeasuredDistance measured(const DistanceResult& result, std::vector<Bounds> course) {
  return {result.lower,
          result.upper,
          result.solids_meet(),
          {array_of(result.witness[0].point), array_of(result.witness[1].point)},
          std::move(course)};
}

MeasuredClash measured(const ClashResult& result, std::vector<Bounds> course) {
  return {result.kind,
          result.reason,
          result.shares_faces,
          {result.distance.lower, result.distance.upper},
          ends_of(result.depth),
          ends_of(result.volume),
          array_of(result.translation),
          std::move(course)};
}

MeasuredApproach measured(const FirstContactResult& result, std::vector<ContactBounds> course) {
  return {result.outcome, result.t0, result.t1, std::nullopt, std::nullopt, std::move(course)};
}

std::string words(const MeasuredDistance& m) {
  return interval_words(m.lower, m.upper, m.course.size());
}

std::string words(const MeasuredClash& m) {
  std::string out(name_of(m.kind));
  if (m.reason != ClashReason::none) out += ": " + std::string(name_of(m.reason));
  if (m.depth) out += ", depth " + interval_words((*m.depth)[0], (*m.depth)[1], m.course.size());
  return out;
}

std::string words(const MeasuredApproach& m) {
  std::string out = std::string(name_of(m.outcome)) + " " + interval_words(m.t0, m.t1, m.course.size());
  if (m.step) out += ", step " + digits((*m.step)[1]);
  return out;
}

}  // namespace lrb::trace

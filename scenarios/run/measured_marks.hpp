#pragma once
/// The marks of what a trace has measured at a step.

#include <array>
#include <optional>
#include <span>

#include "scenarios/run/measure_marks.hpp"
#include "trace/measured.hpp"

namespace lrb::run {

inline Eigen::Vector3d vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

inline std::optional<MarkedWay> gap_of(const trace::MeasuredDistance& distance) {
  return gap_of({distance.lower, distance.upper}, vector_of(distance.points[0]),
                vector_of(distance.points[1]));
}

inline std::optional<MarkedWay> way_out_of(const trace::MeasuredClash& clash, const LrbRep& a,
                                           const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                           std::span<const ContactRegion> contacts) {
  std::optional<ProvedInterval> depth;
  if (clash.depth) depth = {(*clash.depth)[0], (*clash.depth)[1]};
  return way_out_of(depth, vector_of(clash.translation), a, pose_a, b, pose_b, contacts);
}

}  // namespace lrb::run

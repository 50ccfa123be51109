#pragma once
/// Writes points and witnesses as `distance` and `sweep` print them.

#include "engine/query/distance/distance.hpp"
#include "trace/json_out.hpp"

namespace lrb::cli {

inline void write_vector(trace::JsonWriter& w, const char* name, const Eigen::Vector3d& x) {
  w.key(name).begin_array().value(x.x()).value(x.y()).value(x.z()).end_array();
}

/// Writes what of a face is nearest: its kind, and the vertices that span it.
inline void write_feature_of(trace::JsonWriter& w, const Witness& witness) {
  static constexpr const char* kNames[] = {"vertex", "edge", "face"};
  w.member("feature", kNames[witness.corner_count - 1]);
  w.key("vertices").begin_array();
  for (int k = 0; k < witness.corner_count; ++k)
    w.value(witness.corners[static_cast<std::size_t>(k)].value());
  w.end_array();
}

}  // namespace lrb::cli

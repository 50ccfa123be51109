#pragma once
/// The answers of a recorded run (trace.hpp) to further queries, and those that other engines reported.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/clash.hpp>
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/point_distance.hpp>

namespace lrb::trace {

// Recorded results of further queries: distance, clash and the convergence of their bounds, near pairs,
// contact manifolds and distances of points per step, and the first contact of a whole motion.

/// A DistanceResult without its features.
struct MeasuredDistance {
  double lower = 0, upper = 0;  ///< bounds of the distance of the surfaces; 0 if they intersect
  bool solids_meet = false;     ///< the surfaces intersect, or one body contains the other
  std::array<std::array<double, 3>, 2> points{};  ///< on the surfaces of A and B, at distance `upper`
  std::vector<Bounds> history;

  friend bool operator==(const MeasuredDistance&, const MeasuredDistance&) = default;
};

/// A ClashResult without its contact regions.
struct MeasuredClash {
  ClashKind kind = ClashKind::undecided;
  ClashReason reason = ClashReason::none;
  bool shares_faces = false;
  std::array<double, 2> distance{};                    ///< of the solids
  std::optional<std::array<double, 2>> depth, volume;  ///< intervals; nullopt: not known
  std::array<double, 3> translation{};                 ///< of B, that separates the solids
  std::vector<Bounds> history;                         ///< of the depth
  bool finished = true;  ///< false: ClashRequest::max_steps ended the search for the depth

  friend bool operator==(const MeasuredClash&, const MeasuredClash&) = default;
};

/// A NearPairsResult: the number of pairs, and the nearest of them.
struct MeasuredNearPairs : NearPairsNumbers {
  struct Pair {
    SimplexId a = kNull, b = kNull;
    double lower = 0, upper = 0;                    ///< bounds of the distance
    std::array<std::array<double, 3>, 2> points{};  ///< on A and B

    friend bool operator==(const Pair&, const Pair&) = default;
  };

  double within = 0;          ///< the requested distance
  std::vector<Pair> nearest;  ///< at most kMaxListed, by ascending lower bounds

  static constexpr std::size_t kMaxListed = 1000;
  friend bool operator==(const MeasuredNearPairs&, const MeasuredNearPairs&) = default;
};

/// A ManifoldResult without its pairs.
struct MeasuredManifolds {
  struct Point {
    std::uint64_t id = 0;                           ///< the same from step to step
    std::uint32_t manifold = 0;                     ///< number of its manifold
    double depth = 0;                               ///< negative: a gap
    std::array<double, 3> normal{};                 ///< from A to B
    std::array<std::array<double, 3>, 2> points{};  ///< on A and B

    friend bool operator==(const Point&, const Point&) = default;
  };

  double margin = 0;            ///< the requested distance of speculative contacts
  std::uint64_t manifolds = 0;  ///< number of manifolds found
  std::uint64_t found = 0;      ///< number of points found
  std::vector<Point> contacts;  ///< the first points, at most kMaxListed

  static constexpr std::size_t kMaxListed = 1000;
  friend bool operator==(const MeasuredManifolds&, const MeasuredManifolds&) = default;
};

/// Signed distances of points that move with B to A.
struct MeasuredPoints {
  struct Point {
    std::uint32_t number = 0;                       ///< of the point, from 0
    FaceId face = kNull;                            ///< of A, the closest one
    double lower = 0, upper = 0;                    ///< bounds of the distance, negative inside
    std::array<std::array<double, 3>, 2> points{};  ///< the point, and the closest one on A

    friend bool operator==(const Point&, const Point&) = default;
  };

  std::uint64_t count = 0, inside = 0, on_surface = 0;
  bool has_sides = false;       ///< A is closed; otherwise distances have no sign
  std::vector<Point> smallest;  ///< at most kMaxListed, by ascending lower bounds

  static constexpr std::size_t kMaxListed = 1000;
  friend bool operator==(const MeasuredPoints&, const MeasuredPoints&) = default;
};

/// First contact of the motion that the steps sample. Times are shares of the motion.
struct MeasuredApproach {
  MotionOutcome outcome = MotionOutcome::undecided;
  double t0 = 0, t1 = 0;  ///< as in FirstContactResult
  /// The same two times in steps of the trace: 11.36 is between steps 11 and 12. Below 0 if the contact comes
  /// before step 0. nullopt: no contact.
  std::optional<std::array<double, 2>> step;
  std::optional<std::array<double, 2>> length;  ///< path length of B's origin from step 0 until then
  std::vector<ContactBounds> history;           ///< empty unless the search was probed

  friend bool operator==(const MeasuredApproach&, const MeasuredApproach&) = default;
};

MeasuredDistance measured(const DistanceResult& result, std::vector<Bounds> history);
MeasuredClash measured(const ClashResult& result, std::vector<Bounds> history);
MeasuredNearPairs measured(const NearPairsResult& result, double within);
MeasuredManifolds measured(const ManifoldResult& result, double margin);
/// `points`: in the world; `has_sides`: A is closed.
MeasuredPoints measured(std::span<const PointDistance> distances, std::span<const Eigen::Vector3d> points,
                        bool has_sides);
/// Converts a result. `step` and `length` stay empty, because they depend on the steps of the trace.
MeasuredApproach measured(const FirstContactResult& result, std::vector<ContactBounds> history);

/// Return a one-line summary: "[0.25, 0.25] in 31 looks".
std::string to_text(const MeasuredDistance& m);
std::string to_text(const MeasuredClash& m);
std::string to_text(const MeasuredNearPairs& m);
std::string to_text(const MeasuredManifolds& m);
std::string to_text(const MeasuredPoints& m);
std::string to_text(const MeasuredApproach& m);

// The answer of another engine, as it reported it.

/// The kind of query. shape: of a tree with a shape whose mesh is for pictures only; not checked.
enum class EngineQuery : std::uint8_t { all_pairs, any, distance, first_contact, self, shape };
constexpr auto enum_names(EngineQuery) {
  return std::to_array<EnumName<EngineQuery>>({{EngineQuery::all_pairs, "all_pairs"},
                                               {EngineQuery::any, "any"},
                                               {EngineQuery::distance, "distance"},
                                               {EngineQuery::first_contact, "first_contact"},
                                               {EngineQuery::self, "self"},
                                               {EngineQuery::shape, "shape"}});
}
enum class EngineVerdict : std::uint8_t { separate, intersecting, unreported };
constexpr auto enum_names(EngineVerdict) {
  return std::to_array<EnumName<EngineVerdict>>({{EngineVerdict::separate, "separate"},
                                                 {EngineVerdict::intersecting, "intersecting"},
                                                 {EngineVerdict::unreported, "unreported"}});
}

struct EngineReport {
  /// A counter's value, or the beginning of a phase.
  struct Mark {
    std::uint32_t name = 0;   ///< index in TraceHeader::names
    std::uint32_t at = 0;     ///< number of events of the step before it, the step event included
    std::uint32_t value = 0;  ///< of a counter

    friend bool operator==(const Mark&, const Mark&) = default;
  };

  EngineQuery query = EngineQuery::all_pairs;
  EngineVerdict verdict = EngineVerdict::unreported;
  std::uint64_t pairs = 0;  ///< number of pairs by the engine's own count
  bool complete = true;     ///< all its events were recorded
  std::uint32_t thread = 0;
  std::uint64_t begin_ns = 0;  ///< since the recording began
  std::uint64_t duration_ns = 0;
  std::vector<Mark> counts, phases;  ///< in the engine's order

  friend bool operator==(const EngineReport&, const EngineReport&) = default;
};

}  // namespace lrb::trace

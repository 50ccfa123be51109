#pragma once
/// The answers of a captured engine, checked by the exact query on the captured meshes and poses.
///
/// The checks depend on the kind of query:
/// - all pairs: the verdict, the number of pairs, and the pairs themselves, as far as tests of triangles were
///   recorded.
/// - any: the verdict, and the tests of triangles that were recorded.
/// - self: the pairs of triangles without a common vertex, as all pairs. Engines differ about neighbours, so
///   neither these nor the number of pairs are compared.
/// - distance: the verdict, and the distance if it was recorded.
/// - rays, points and boxes as above. They hit triangles with a common point; a box is a solid. With
/// distance,
///   no hit of a ray may be before the first one found; the distance is the multiple of its direction there.
/// - first contact: the bodies must not be called separate if they intersect at the poses of the query, where
///   the motion begins. Nothing else is known about the motion.
///
/// A test in floating point may be wrong about triangles that are close to contact. An error is *undecidable*
/// if the triangles' gap or overlap depth is at most error_bound(), and only then.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "scenarios/profile/query_walk.hpp"
#include <lrbscope/enum_names.hpp>
#include <lrbscope/trace/capture.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::profile {

/// The number format in which an engine computes.
enum class Precision : std::uint8_t { float32, float64 };
constexpr auto enum_names(Precision) {
  return std::to_array<EnumName<Precision>>({{Precision::float32, "float"}, {Precision::float64, "double"}});
}
/// Guesses the format: float32 if every number of every volume is a float.
Precision precision_of(const capture::Capture& capture);

using Triangle = std::array<Eigen::Vector3d, 3>;  ///< corners in the world
using Points = std::span<const Eigen::Vector3d>;  ///< those of a triangle, or of a box

/// Units in the last place by which the coordinates in a floating test of two triangles may be wrong: those
/// of a pose product, its application to the corners, and the projections on an axis.
inline constexpr double kTestUlps = 16;
/// Returns the gap or overlap depth up to which a test of two triangles in floating point may err: kTestUlps
/// units in the last place of the sum of both triangles' largest terms, |R| |x| + |t| of a corner x.
double error_bound(Points a, const Pose& pose_a, Points b, const Pose& pose_b, Precision precision);
/// Returns the length of the shortest translation that separates two intersecting triangles, up to rounding:
/// the least overlap along the normals of their Minkowski sum (for triangles in one plane: 0).
double overlap_depth(Points a, Points b);
/// Returns the gap of two disjoint triangles, rounded down.
double gap_of(const Triangle& a, const Triangle& b);

/// Why an intersecting pair of triangles is missing.
enum class Culprit : std::uint8_t {
  none,           ///< nothing is missing: the pair was reported wrongly
  triangle_test,  ///< the triangles were tested and called disjoint
  volumes,        ///< the volumes of two nodes above them were called disjoint
  child_volumes,  ///< the volumes of two children of wide nodes above them were called disjoint
  traversal,      ///< the volumes of two nodes above them overlap, and the pair beneath was never visited
  not_visited,    ///< no pair of nodes above them was visited
  in_no_leaf,     ///< one of the triangles is in no leaf
  unrecorded,     ///< the events of the query are not complete
};
constexpr auto enum_names(Culprit) {
  return std::to_array<EnumName<Culprit>>({{Culprit::none, "none"},
                                           {Culprit::triangle_test, "triangle_test"},
                                           {Culprit::volumes, "volumes"},
                                           {Culprit::child_volumes, "child_volumes"},
                                           {Culprit::traversal, "traversal"},
                                           {Culprit::not_visited, "not_visited"},
                                           {Culprit::in_no_leaf, "in_no_leaf"},
                                           {Culprit::unrecorded, "unrecorded"}});
}

/// A pair of triangles about which the engine is wrong.
struct WrongPair {
  TrianglePair triangles;
  bool missed = false;       ///< else reported without an intersection
  bool undecidable = false;  ///< `margin` is at most `bound`
  double margin = 0;         ///< missed: overlap depth; else gap. World units
  double bound = 0;          ///< see error_bound()
  Culprit culprit = Culprit::none;
  std::array<std::uint32_t, 2> nodes{kNull, kNull};  ///< volumes, child_volumes, traversal: the pair to blame
  std::uint8_t axis = capture::kNoAxis;              ///< volumes: as recorded
  std::array<double, 2> outside{0, 0};  ///< volumes: how far each triangle sticks out of its node's volume
  std::array<bool, 2> in_leaf{true, true};  ///< in_no_leaf: false for a triangle without a leaf
};

/// From best to worst.
enum class Judgement : std::uint8_t { unchecked, right, undecidable, wrong };
constexpr auto enum_names(Judgement) {
  return std::to_array<EnumName<Judgement>>({{Judgement::unchecked, "unchecked"},
                                             {Judgement::right, "right"},
                                             {Judgement::undecidable, "undecidable"},
                                             {Judgement::wrong, "wrong"}});
}

struct QueryVerdict {
  static constexpr std::size_t kKept = 100;  ///< most wrong pairs kept of a query

  std::uint32_t number = 0;  ///< of the query
  capture::QueryKind kind = capture::QueryKind::all_pairs;
  Judgement outcome = Judgement::unchecked;  ///< the worst of the answer's and the pairs'
  Judgement answer = Judgement::unchecked;   ///< of the verdict and the number of pairs
  std::string remark;                        ///< the error of the answer, or why something is unchecked
  std::string distance;                      ///< the error of the distance, which is in `remark`, too
  bool pairs_checked = false;                ///< the recorded tests of triangles were compared
  std::uint64_t exact_pairs = 0;
  std::uint64_t found = 0;              ///< pairs whose recorded tests say that they intersect
  std::uint64_t right = 0;              ///< intersecting pairs that the engine found
  std::uint64_t missed = 0, extra = 0;  ///< beyond the error bound
  std::uint64_t undecidable = 0;        ///< missed or reported wrongly, within it
  std::vector<WrongPair> wrong;         ///< the first kKept; those beyond the error bound first
  std::vector<TrianglePair> exact;      ///< all intersecting pairs, ascending
};

/// A frequent error in recorded poses.
enum class PoseError : std::uint8_t { inverted, transposed, exchanged, rotated_last };
inline constexpr std::size_t kPoseErrors = 4;
/// Returns the error as a clause: "the poses of A and B are exchanged".
std::string_view words(PoseError error);

class Checker {
 public:
  /// `bodies` must outlive this object.
  Checker(CapturedBodies& bodies, Precision precision);

  /// Checks a query. `walk`: of the same query; nullptr for one with a side without a tree, which is not
  /// checked. `known`: the intersecting pairs, if they were computed before. Throws InputError as collide()
  /// does.
  QueryVerdict check(const capture::Query& query, const QueryWalk* walk,
                     const std::vector<SimplexPair>* known = nullptr);

  /// Returns true for a wrong pair that arithmetic of the engine's precision cannot decide.
  bool is_undecidable(const capture::Query& query, const QueryWalk& walk, const TrianglePair& pair,
                      bool missed);

  /// Returns true for each error whose reversal makes the reported pairs of a query the exact ones, up to 1 %
  /// of them. All false if the query reports no pairs.
  std::array<bool, kPoseErrors> explaining_errors(const capture::Query& query, const QueryWalk& walk);

 private:
  struct Posed;  ///< the bodies of a query

  Posed posed_bodies(const capture::Query& query, const QueryWalk& walk);
  std::vector<TrianglePair> exact_pairs(const Posed& posed);
  WrongPair describe(const Posed& posed, const TrianglePair& pair, bool missed) const;
  void blame(const Posed& posed, const QueryWalk& walk, bool tested, WrongPair& wrong);
  void check_pairs(const Posed& posed, const QueryWalk& walk, QueryVerdict& out);
  void check_answer(const Posed& posed, QueryVerdict& out);
  /// Compares the engine's distance with the proven one.
  void check_value(const Posed& posed, QueryVerdict& out);
  /// Returns the bound of the error of a distance in the engine's format.
  double error_of_distance(const Posed& posed) const;

  CapturedBodies& bodies_;
  Precision precision_;
  bool records_triangles_ = false;  ///< some query reports tests of triangles
  Workspace workspace_;
};

/// Returns a sentence about a wrong pair: "missed 3560,3155: nodes 2047 and 3548, which contain them, were
/// found disjoint along axis 1 of A's box; triangle 3560 sticks out of its node by 0.0123". Nodes have the
/// engine's numbers.
std::string sentence(const WrongPair& wrong, const capture::Tree& a, const capture::Tree& b);
/// Returns what wrong pairs have in common: "missed; cause: volumes, from which a triangle sticks out".
std::string cause_of(const WrongPair& wrong);

}  // namespace lrb::profile

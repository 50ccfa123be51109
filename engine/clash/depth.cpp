/// Bounds the penetration depth of two solids: the length of the shortest translation that separates them
/// (Cameron and Culley 1986). Steps:
/// 1. Lower bound: convex sets inside both bodies, and the depth of their Minkowski difference
///    (minkowski.hpp).
/// 2. Upper bound: the depth of the convex hulls. For two convex bodies this suffices: both bounds agree up
///    to rounding.
/// 3. Otherwise search for shorter translations: along face normals, then by small rotations of the best
///    direction.
/// 4. Raise the lower bound by pairs of balls inside the bodies (overlap_proof.cpp), and search where that
///    fails.
/// 5. Prove the best translation with the distance query.
/// Only the lower bounds of steps 1 and 4 and the translation of step 5 are proven; the search is a
/// heuristic.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "engine/clash/clash_parts.hpp"
#include "engine/clash/clash_tolerances.hpp"
#include "engine/clash/minkowski.hpp"
#include "engine/clash/separation_search.hpp"
#include "engine/collide/collide_into.hpp"
#include "engine/collide/relation.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/contact.hpp>

namespace lrb {
namespace {

/// Bounds depths. Lower bounds come from overlapping sets inside the bodies, upper bounds from translations
/// that are proven to separate. For convex bodies both agree up to rounding.
class DepthFinder {
 public:
  /// `query`: begun with the bodies, which must be closed. `result`: all pairs of intersecting simplices.
  /// max_steps: as in ClashRequest. adapter: null, or notified of bounds on the depth.
  DepthFinder(QueryContext& query, const CollideResult& result, const UnitBodies& bodies,
              SeparationSearch& penetration, std::uint64_t max_steps, BoundsProbeAdapter* adapter = nullptr);

  struct Depth {
    ProvedInterval length;  ///< world
    Vector3d translation{0, 0, 0};
  };
  Depth depth();
  /// `n`: approximately of unit length.
  ProvedInterval along(const Vector3d& n);
  /// Returns false if the limit of steps ended a search.
  bool finished() const { return !is_cut_; }

 private:
  /// Convex sets inside each body, around a common point.
  struct Common {
    ConvexPoints a, b;
  };
  std::optional<Vector3d> inside_point(Side side, const Vector3d& unit, const Vector3d& shift);
  std::optional<ConvexPoints> shrunken(Side side);
  Eigen::AlignedBox3d common_box(const Vector3d& shift);
  std::optional<Vector3d> deepest_common(const Vector3d& shift);
  double common_clearance(const Vector3d& x, const Vector3d& shift, double enough);
  std::optional<Common> common_sets(const Vector3d& shift, WholeTriangles whole);
  const SurfaceDistance& surface(Side side);
  double raise_lower(double known, double& best, Vector3d& best_n);
  std::vector<Vector3d> directions();
  void improve(const Vector3d& n, double& best, Vector3d& best_n);
  void refine(double& best, Vector3d& best_n);
  void find_depth(MinkowskiDifference& difference, unsigned max_steps, bool is_inner);
  void notify(double least);
  double hull_width(const Vector3d& n) const;
  double along_lower(const Vector3d& n);
  std::uint64_t steps() const { return separation_search_.query_count() + located_; }
  bool is_spent();

  QueryContext& query_;
  const CollideResult& result_;
  const UnitBodies& bodies_;
  SeparationSearch& separation_search_;
  std::uint64_t max_steps_;
  std::uint64_t located_ = 0;      ///< number of points located in both bodies
  double share_ = kShareOfSearch;  ///< of the limit, for the present search
  bool is_cut_ = false;            ///< the limit ended a search
  BoundsProbeAdapter* adapter_;
  double reported_lower_ = 0;             ///< lower bound on the depth, world units; only with an adapter
  std::uint64_t grown_ = 0;               ///< number of expansion steps; only with an adapter
  std::optional<ConvexPoints> whole_[2];  ///< the set of a convex body
  std::optional<SurfaceDistance> surface_[2];  ///< built on first use
  std::vector<Vector3d> common_;               ///< points of both bodies at their poses, the deepest first
};

Vector3d normal_of(const UnitBody& body, std::uint32_t triangle) {
  const auto& t = body.triangles[triangle];
  const Vector3d &a = body.points[t[0]], &b = body.points[t[1]], &c = body.points[t[2]];
  // Half the cross product: its length is the triangle's area.
  return 0.5 * (b - a).cross(c - a);
}

/// Directions with the total area of the faces normal to them; nearly equal directions are merged.
class Directions {
 public:
  void add(const Vector3d& normal) {
    const double area = stable_norm3(normal);
    // A degenerate face has no direction.
    if (!(area > 0)) return;
    const Vector3d n = normal / area;
    // Directions in one cell of a grid are merged into the first one, with the sum of the areas.
    std::array<int, 3> cell;
    for (int k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] = static_cast<int>(std::lround(n[k] * kDirectionGrid));
    const auto [known, is_new] = of_cell_.try_emplace(cell, list_.size());
    if (is_new) list_.push_back({n, 0});
    list_[known->second].second += area;
  }
  /// Returns the directions of largest area.
  std::vector<Vector3d> largest(std::size_t count) {
    // Stable: among equal areas the first found comes first.
    std::stable_sort(list_.begin(), list_.end(),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    std::vector<Vector3d> out;
    for (const auto& [n, area] : list_)
      if (out.size() < count) out.push_back(n);
    return out;
  }

 private:
  std::map<std::array<int, 3>, std::size_t> of_cell_;
  std::vector<std::pair<Vector3d, double>> list_;
};

ConvexPoints moved(ConvexPoints points, const Vector3d& by) {
  for (Vector3d& x : points) x += by;
  return points;
}

DepthFinder::DepthFinder(QueryContext& query, const CollideResult& result, const UnitBodies& bodies,
                         SeparationSearch& penetration, std::uint64_t max_steps, BoundsProbeAdapter* adapter)
    : query_(query),
      result_(result),
      bodies_(bodies),
      separation_search_(penetration),
      max_steps_(max_steps),
      adapter_(adapter) {
  // The set of a convex body is the body itself, slightly shrunk: computed once for all queries below.
  for (const Side side : {Side::a, Side::b}) whole_[static_cast<int>(side)] = shrunken(side);
}

/// Returns true, and notes it, once the present search has used its share of the limit.
bool DepthFinder::is_spent() {
  const bool is_now =
      max_steps_ > 0 && static_cast<double>(steps()) >= share_ * static_cast<double>(max_steps_);
  is_cut_ = is_cut_ || is_now;
  return is_now;
}

/// Returns a point of a body near x, in units, that was exactly located inside it, or nullopt if x is not
/// inside. shift: an assumed translation of B.
std::optional<Vector3d> DepthFinder::inside_point(Side side, const Vector3d& x, const Vector3d& shift) {
  // A shifted B contains x if B contains x - shift.
  const Vector3d world = bodies_.frame.to_world(side == Side::a ? x : Vector3d(x - shift));
  // The point is located after rounding to world coordinates, and the rounded point is converted back.
  if (!world.allFinite() || locate(query_[side], world.data()) != Where::inside) return std::nullopt;
  return bodies_.frame.to_unit(world);
}

std::optional<ConvexPoints> DepthFinder::shrunken(Side side) {
  const UnitBody& body = bodies_.body[static_cast<int>(side)];
  // Area centroid of the surface: it does not depend on the triangulation.
  Vector3d centre = Vector3d::Zero();
  double area = 0;
  for (std::uint32_t i = 0; i < body.triangles.size(); ++i) {
    const auto& t = body.triangles[i];
    const double share = stable_norm3(normal_of(body, i));
    centre += share / 3 * (body.points[t[0]] + body.points[t[1]] + body.points[t[2]]);
    area += share;
  }
  if (!(area > 0)) return std::nullopt;
  // A convex body contains the centroid.
  const std::optional<Vector3d> inside = inside_point(side, centre / area, Vector3d::Zero());
  return inside ? shrunken_body(body, *inside) : std::nullopt;
}

/// Returns the smaller clearance of a point from both surfaces, or 0 if it is not inside both bodies or not
/// more than `enough`.
double DepthFinder::common_clearance(const Vector3d& x, const Vector3d& shift, double enough) {
  ++located_;
  const double least =
      std::min(surface(Side::a).at(x, {}, enough), surface(Side::b).at(x - shift, {}, enough));
  // Exact location is slower than clearances.
  if (!(least > enough) || !inside_point(Side::a, x, shift) || !inside_point(Side::b, x, shift)) return 0;
  return least;
}

/// Returns a box that approximates or contains the bodies' intersection. Corners of the intersection are
/// points where faces of both intersect, and vertices of one body inside the other.
Eigen::AlignedBox3d DepthFinder::common_box(const Vector3d& shift) {
  Eigen::AlignedBox3d boxes[2], out;
  for (int side = 0; side < 2; ++side)
    for (const Vector3d& x : bodies_.body[side].points)
      boxes[side].extend(side == 0 ? x : Vector3d(x + shift));
  // The contacts are valid only for the unshifted bodies.
  if (!shift.isZero(0)) return boxes[0].intersection(boxes[1]);
  // Corners of the first kind.
  for (const SimplexPair& pair : result_.pairs) {
    const double *a[3], *b[3];
    query_[Side::a].world.corners(pair.a, a);
    query_[Side::b].world.corners(pair.b, b);
    const exact::PairContact contact = exact::contact_of_triangles(a, b);
    for (int c = 0; c < contact.corner_count; ++c)
      out.extend(bodies_.frame.to_unit(contact.corners[static_cast<std::size_t>(c)].x));
  }
  // Corners of the second kind. Vertices are located only if they would enlarge the box.
  for (const Side side : {Side::a, Side::b})
    for (const Vector3d& x : bodies_.body[static_cast<int>(side)].points)
      if (boxes[1 - static_cast<int>(side)].contains(x) && !out.contains(x) &&
          inside_point(other(side), x, Vector3d::Zero()))
        out.extend(x);
  return out;
}

/// Searches for the common point with the largest clearance: on a grid, then by compass search from the best
/// point.
std::optional<Vector3d> DepthFinder::deepest_common(const Vector3d& shift) {
  Vector3d best = Vector3d::Zero();
  double most = 0;
  const Eigen::AlignedBox3d box = common_box(shift);
  // The grid is refined only while no common point is found.
  for (int grid = kStartGrid; grid <= kFinestStartGrid && !(most > 0) && !box.isEmpty(); grid *= 2)
    for (int i = 0; i < grid * grid * grid && !is_spent(); ++i) {
      const Vector3d cell(i % grid, i / grid % grid, i / (grid * grid));
      const Vector3d x = box.min() + ((cell.array() + 0.5) / grid * box.sizes().array()).matrix();
      const double clearance = common_clearance(x, shift, 0);
      // Every common point may help the proof of overlap later.
      if (clearance > 0 && shift.isZero(0)) common_.push_back(x);
      // Gains within rounding are ignored: the choice among equally deep points must not depend on it.
      if (clearance > most * (1 + kClearlyMore)) {
        most = clearance;
        best = x;
      }
    }
  if (!(most > 0)) return std::nullopt;
  unsigned tries = 0;
  // Compass search: step along each axis, and halve the step when no step gains.
  for (double step = most; step > kStartStep * most && tries < kMaxSteps && !is_spent();) {
    bool moved = false;
    for (int k = 0; k < 3; ++k)
      for (const double sign : {-1.0, 1.0}) {
        const Vector3d x = best + sign * step * Vector3d::Unit(k);
        const double clearance = common_clearance(x, shift, most);
        ++tries;
        if (!(clearance > most * (1 + kClearlyMore))) continue;
        most = clearance;
        best = x;
        moved = true;
      }
    if (!moved) step /= 2;
  }
  return best;
}

const SurfaceDistance& DepthFinder::surface(Side side) {
  const int i = static_cast<int>(side);
  if (!surface_[i]) surface_[i].emplace(bodies_.body[i]);
  return *surface_[i];
}

std::optional<DepthFinder::Common> DepthFinder::common_sets(const Vector3d& shift, WholeTriangles whole) {
  // Both bodies convex: the same sets for every shift.
  if (whole_[0] && whole_[1]) return Common{*whole_[0], moved(*whole_[1], shift)};
  const std::optional<Vector3d> x = deepest_common(shift);
  // The deepest point is tried first by OverlapProof.
  if (shift.isZero(0) && x) common_.insert(common_.begin(), *x);
  if (!x) return std::nullopt;
  std::optional<ConvexPoints> sets[2];
  for (const Side side : {Side::a, Side::b}) {
    const int i = static_cast<int>(side);
    // For a body that is not convex, the convex region around the common point. B's is computed at B's pose,
    // then translated.
    sets[i] = whole_[i] ? whole_[i] : convex_about(bodies_.body[i], *inside_point(side, *x, shift), whole);
    if (!sets[i]) return std::nullopt;
  }
  return Common{std::move(*sets[0]), moved(std::move(*sets[1]), shift)};
}

/// Reports the bounds. `least`: length of the shortest translation found so far, in units.
void DepthFinder::notify(double least) {
  if (adapter_ == nullptr) return;
  const double upper = least < kInfinity ? bodies_.frame.length_to_world(least) : kInfinity;
  adapter_->notify(separation_search_.query_count() + grown_, reported_lower_, upper);
}

/// Expands the Minkowski difference and reports its bounds: lower bounds from sets inside the bodies, upper
/// bounds from the convex hulls.
void DepthFinder::find_depth(MinkowskiDifference& difference, unsigned max_steps, bool is_inner) {
  if (adapter_ == nullptr) {
    difference.find_depth(max_steps);
    return;
  }
  // In chunks of increasing size, with a report after each.
  for (unsigned done = 0; done < max_steps;) {
    const auto look = static_cast<unsigned>(BoundsProbeAdapter::next_look(done));
    const unsigned steps = std::min(look, max_steps) - done;
    const unsigned grown = difference.find_depth(steps);
    done += grown;
    grown_ += grown;
    if (is_inner) reported_lower_ = bodies_.frame.length_to_world(difference.depth_lower());
    notify(is_inner ? kInfinity : difference.depth_upper());
    // Finished before the end of the chunk.
    if (grown < steps) return;
  }
}

double DepthFinder::hull_width(const Vector3d& n) const {
  // Support function of the Minkowski difference: after this translation a plane separates the convex hulls.
  return n.dot(farthest(bodies_.body[0].points, n)) + (-n).dot(farthest(bodies_.body[1].points, -n));
}

/// Returns the normals of the faces that intersect the other body, and of the largest faces. B is separated
/// from a face of A along its normal, and from A by its own faces against their normals.
std::vector<Vector3d> DepthFinder::directions() {
  // Faces in contact, and all faces, each with areas. Normals of B are negated.
  Directions in_contact, all;
  for (const SimplexPair& pair : result_.pairs) {
    in_contact.add(normal_of(bodies_.body[0], pair.a));
    in_contact.add(-normal_of(bodies_.body[1], pair.b));
  }
  for (int side = 0; side < 2; ++side)
    for (std::uint32_t i = 0; i < bodies_.body[side].triangles.size(); ++i)
      all.add((side == 0 ? 1 : -1) * normal_of(bodies_.body[side], i));
  std::vector<Vector3d> out = in_contact.largest(kDirectionsInContact);
  for (const Vector3d& n : all.largest(kDirectionsOfFaces)) out.push_back(n);
  return out;
}

/// Searches for a shorter translation along n.
void DepthFinder::improve(const Vector3d& n, double& best, Vector3d& best_n) {
  // At `width` the convex hulls are separated; bodies that are not convex may be separated earlier.
  const double width = hull_width(n);
  if (!(width > 0)) return;
  // Only translations that are clearly shorter than the best one count.
  const double most = std::min(width, best * (1 - kDirectionGain));
  const double s = separation_search_.least_separation(n, most, kDirectionSamples, kSearchShare * most);
  // No sample separates, unless the width itself is the improvement.
  if (s >= most && (most < width || !(width < best))) return;
  best = s;
  best_n = n;
  notify(best);
}

/// Rotates the direction by decreasing angles while that shortens the translation.
void DepthFinder::refine(double& best, Vector3d& best_n) {
  unsigned tries = 0;
  for (double step = kFirstTurn; step > kMinTurn && tries < kMaxSteps && !is_spent();) {
    // Two axes normal to the direction; small rotations towards each, both ways.
    const Vector3d across = best_n.unitOrthogonal(), other = best_n.cross(across);
    bool shorter = false;
    for (const Vector3d& towards : {across, other, Vector3d(-across), Vector3d(-other)}) {
      const Vector3d n = (best_n + step * towards).normalized();
      // Require a gain proportional to the angle, so that a single query rejects a rotation without it.
      const double s = best * (1 - kTurnGain * step);
      ++tries;
      if (!separation_search_.is_separated(n, s)) continue;
      // Without sampling: bisect below the length that was just found to separate.
      best = separation_search_.least_separation(n, s, 1, kSearchShare * s);
      best_n = n;
      notify(best);
      shorter = true;
      break;
    }
    // No rotation helped: halve the angle.
    if (!shorter) step /= 2;
  }
}

/// Proves a lower bound on the depth, in units, for bodies that are not both convex, unless the `known` one
/// is nearly as long as the translation. Searches for shorter translations where the proof fails.
double DepthFinder::raise_lower(double known, double& best, Vector3d& best_n) {
  OverlapProof proof(surface(Side::a), surface(Side::b), [this](Side side, const Vector3d& x) {
    return inside_point(side, x, Vector3d::Zero()).has_value();
  });
  // Nothing to gain, or no common point to start from. No depth exceeds 1 unit, the size of both bodies.
  if (known >= kNarrowDepth * best || !proof.begin(common_, std::min(best, kUnitReach * 0.5))) return known;
  constexpr unsigned kPart = kMaxRoomPoints / kRoomLooks;
  share_ = 1;
  for (unsigned part = 0; part < kRoomLooks && proof.lower() < kNarrowDepth * best && !is_spent(); ++part) {
    // Alternate between proving and searching in the direction where the proof got stuck.
    const auto most = max_steps_ > 0 ? std::min<std::uint64_t>(kPart, max_steps_ - steps()) : kPart;
    const unsigned looked = proof.grow(static_cast<unsigned>(most));
    grown_ += looked;
    located_ += looked;
    reported_lower_ = std::max(reported_lower_, bodies_.frame.length_to_world(proof.lower()));
    // Where the proof fails, a shorter translation may exist.
    const double before = best;
    if (proof.undecided().norm() > 0) improve(proof.undecided().normalized(), best, best_n);
    if (best < before) refine(best, best_n);
    notify(best);
    // The proof cannot continue.
    if (looked < most) break;
  }
  return std::max(known, proof.lower());
}

DepthFinder::Depth DepthFinder::depth() {
  Depth out;
  out.length.upper = kInfinity;
  const bool convex = whole_[0] && whole_[1];
  double lower = 0;
  // Step 1: proven lower bound from convex sets around a common point.
  if (const std::optional<Common> sets = common_sets(Vector3d::Zero(), WholeTriangles::no)) {
    MinkowskiDifference difference(sets->a, sets->b);
    find_depth(difference, kMaxDepthSteps, true);
    lower = difference.depth_lower();
  }
  // Step 2: upper bound from the convex hulls, which contain the bodies.
  const ConvexPoints &a = bodies_.body[0].points, &b = bodies_.body[1].points;
  MinkowskiDifference hulls(a, b);
  find_depth(hulls, convex ? kMaxDepthSteps : kRoughDepthSteps, false);
  double best = hulls.depth_upper();
  Vector3d best_n = hulls.direction();
  // Steps 3 and 4, for bodies that are not convex, which may be separated before their hulls are.
  if (!convex) {
    for (const Vector3d& n : directions()) {
      if (is_spent()) break;
      improve(n, best, best_n);
    }
    if (best < kInfinity) refine(best, best_n);
    lower = raise_lower(lower, best, best_n);
  }
  // The searches above bisect no more than they compare.
  if (!convex && best < kInfinity) best = separation_search_.least_separation(best_n, best, 1, 0);
  out.length.lower = bodies_.frame.length_to_world(lower);
  // Step 5: prove the best translation, or else that of the convex hulls, which depends on no sampling.
  std::optional<SeparatingTranslation> move;
  if (best < kInfinity) move = separation_search_.prove(best_n, best);
  if (best < kInfinity && !move) move = separation_search_.prove(hulls.direction(), hulls.depth_upper());
  if (move) {
    out.translation = move->translation;
    out.length.upper = move->length;
  }
  // The answer's bounds, even if the unproven ones reported before were narrower.
  if (adapter_ != nullptr)
    adapter_->settle(separation_search_.query_count() + grown_, out.length.lower, out.length.upper);
  return out;
}

/// Proves overlap along n in steps: convex sets around a common point overlap for all translations up to the
/// next step, where another common point is searched.
double DepthFinder::along_lower(const Vector3d& n) {
  double from = 0, lower = 0;
  share_ = 1;
  // The first step is cheap for convex bodies.
  for (unsigned step = 0; step < kMaxWaySteps && (step == 0 || !is_spent()); ++step) {
    // Convex sets of the bodies with B at the current translation.
    const std::optional<Common> sets = common_sets(from * n, WholeTriangles::yes);
    if (!sets) break;
    MinkowskiDifference difference(sets->a, sets->b);
    // The polytope must contain the origin first; then it is expanded only where the ray along n leaves it.
    difference.find_depth(kRoughDepthSteps);
    difference.follow(n);
    const double gain = difference.along_lower(n);
    // Rounded down.
    const double next = (from + gain) * (1 - 0x1p-50);
    if (!(next > lower + kSeparationMargin)) break;
    lower = next;
    // Convex bodies: one step is enough.
    if (whole_[0] && whole_[1]) break;
    // A little less than was proven, so that a common point still exists at the next step.
    from += kWayShare * gain;
  }
  return lower;
}

ProvedInterval DepthFinder::along(const Vector3d& n) {
  const double lower = along_lower(n), width = hull_width(n);
  // Candidates, the shortest first: the lower bound itself, the first separating sample, the width of the
  // hulls.
  std::optional<double> upper = separation_search_.prove_along(n, lower);
  if (!upper && !is_spent())
    upper = separation_search_.prove_along(n, separation_search_.least_separation(n, width, kWaySamples, 0));
  if (!upper) upper = separation_search_.prove_along(n, width);
  const UnitFrame& frame = bodies_.frame;
  return {frame.length_to_world(lower), upper ? frame.length_to_world(*upper) : kInfinity};
}

}  // namespace

void measure_depth(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                   const ClashRequest& request, QueryContext& query, const CollideResult& found,
                   const UnitBodies& bodies, BoundsProbeAdapter* adapter, ClashResult& result) {
  SeparationSearch search(a, pose_a, b, pose_b, bodies);
  DepthFinder finder(query, found, bodies, search, request.max_steps, adapter);
  if (request.depth) {
    const DepthFinder::Depth depth = finder.depth();
    result.depth = depth.length;
    result.translation = depth.translation;
  }
  if (request.along) result.along = finder.along(request.along->stableNormalized());
  result.finished = finder.finished();
}

}  // namespace lrb

// Tightly fitting fronts by one global queue of outward collapses (progressive hulls: Sander, Gu, Gortler,
// Hoppe and Snyder 2000), cut into regions by a cap on components.
// 1. Propose collapses for all edges of the front: onto one of the two vertices if that is in front of all
//    faces that it would cover, otherwise to a new vertex, at a rough cost.
// 2. Pop the cheapest. Place its vertex, and put it back if its true cost is higher.
// 3. Measure the deviation at sample points. If it is too large, the edge sleeps until the limit is larger.
// 4. Confirm exactly that the vertex is in front of the faces to be covered; collapse; propose the edges
//    around it.
// 5. When the queue is empty, prove the lids of the components that are simple enough, and make them regions.
//    A component that fails its proof is undone, and its faces are marked: collapses that cover them are
//    proven one by one.

#include "engine/construct/front_simplifier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/construct/front_update.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;
using Index = OpenFront::Index;

/// Maximum number of faces beneath a component, for each interior vertex that a patch should have: with 16 of
/// these, 112 faces. Measured on five bodies and three seeds: at 96 and 128, fronts of 3 % and 2 % more
/// faces.
constexpr std::uint32_t kFloorPerInterior = 7;
constexpr std::uint32_t kMinFloor = 12;
/// The same for each lid that a region may have (BuildOptions::max_lids), where lids are limited: a patch of
/// two rings has 24 faces and 10 lids.
constexpr std::uint32_t kFloorPerLid = 3;
/// A round that leaves more than this share of the committed front is the last at its deviation limit.
constexpr double kGain = 0.9;
/// A component with more than this share of the faces that it may have hardly grows.
constexpr double kFull = 0.8;
/// Number of vertices whose edges are worked off together.
constexpr std::size_t kChunk = 1000;
/// Price of a region's lid, as kFitBudget; lower, because nearly all components reach it.
constexpr double kBudget = 0.67;
/// The same for regions of few lids, which save fewer faces each. It rises by kRise after each level that
/// leaves nearly the whole mesh (kStuck) though its limit on the deviation, relative to the body's size, is
/// no longer small: the body offers no cheaper lids. (A knotted tube would have no wrapper within 2 % of its
/// size.)
constexpr double kFewLidsBudget = 0.9, kRise = 1.15, kStuck = 0.97, kNotSmall = 0.002;
/// Depth of the target below the star's centre, in radii: see OutwardCollapse::place().
constexpr double kDepth = 10;
/// See OutwardCollapse::needle_cost(). Smaller: needles, at which later collapses are refused.
constexpr double kNeedleWeight = 1e-3;
/// A collapse whose mean height over the star exceeds this share of the limit sleeps without being measured.
constexpr double kMaxHeight = 0.7;
/// A collapse that was too far off sleeps until the limit is this many times as large, at least.
constexpr float kWake = 1.05f;
/// Faces of a component that failed its proof in spite of a proof for each collapse are not covered until the
/// limit is this many times as large.
constexpr float kExclude = 1.6f;
/// Sample points: usual number of steps along an edge, largest distance between them relative to the limit,
/// and the most steps along an edge and of a grid.
constexpr int kSteps = 4, kMaxSteps = 32, kMaxRows = 10;
constexpr float kSpacing = 12;
constexpr float kNever = std::numeric_limits<float>::infinity();
/// Deviation limit of levels without one: less than kNever.
constexpr float kUnlimited = std::numeric_limits<float>::max();
/// A level without a limit on the deviation that leaves more than this share of the front gains too little.
constexpr double kFreeGain = 0.85;
/// A component of such a level has at most one in this many faces of the front beneath it, so that there are
/// several components.
constexpr std::uint32_t kParts = 12;
/// Without a limit on the deviation, where lids are limited: the number of such components, of levels that
/// may gain too little, and the maximum ratio of a lid's faces to its floor. The front becomes simple enough
/// to be closed by one small region.
constexpr std::uint32_t kFewLidsParts = 3;
constexpr int kStalled = 2, kFewLidsStalled = 6;
constexpr double kFewLidsWorth = 0.9;

double cube(double x) {
  return x * x * x;
}

}  // namespace

FrontSimplifier::FrontSimplifier(FrontMesh& front, ComplexBuilder& complex, const std::vector<bool>& frozen,
                                 const std::vector<Eigen::AlignedBox3d>& component_boxes,
                                 const BodyBounds& bounds, const BuildOptions& options, PassCounter& passes)
    : front_(front),
      complex_(complex),
      options_(options),
      passes_(passes),
      tree_(front),
      open_(front, frozen, options.merge_planes),
      geometry_(open_, bounds, kDepth, kNeedleWeight),
      proof_(open_, front, component_boxes),
      real_faces_(frozen.size()),
      floor_limit_(options.max_lids > 0 ? kFloorPerLid * options.max_lids
                                        : std::max(kMinFloor, kFloorPerInterior * options.patch_interior)),
      queue_(cube(open_.size() / open_.unit())),
      random_(options.seed) {}

void FrontSimplifier::fit(std::uint32_t least, const std::function<void()>& before_level) {
  const std::size_t real = real_faces_;
  max_floor_ = floor_limit_;
  double budget = options_.max_lids > 0 ? kFewLidsBudget : kBudget;
  body_.emplace(front_, tree_, open_.unit());
  fit_fronts(
      open_.size(), least, kGain, [&] { return front_.triangle_count(); },
      [&](std::uint32_t before, double limit) {
        // Rounded down, so that reported deviations are within the limit.
        limit_ = static_cast<float>(limit / open_.unit() * (1 - 0x1p-24));
        before_level();
        // A higher price is paid while fewer pseudo faces were made than planned.
        const double correction = fitting_correction(before, real, complex_.face_count() - real);
        level(BuildStage::fit, limit, fitting_worth(before, real, budget, correction));
        if (options_.max_lids > 0 && limit > kNotSmall * open_.size() &&
            front_.triangle_count() > kStuck * static_cast<double>(real))
          budget *= kRise;
      });
  body_.reset();
}

void FrontSimplifier::simplify(const std::function<void()>& before_level) {
  limit_ = kUnlimited;
  new_hints_.clear();
  new_off_ = 0;
  const bool few_lids = options_.max_lids > 0;
  // A level that gains too little is followed by another one, which proves each collapse where lids failed.
  for (int stalled = 0; stalled < (few_lids ? kFewLidsStalled : kStalled) &&
                        front_.triangle_count() > options_.max_outer_faces;) {
    const std::uint32_t before = front_.triangle_count();
    before_level();
    max_floor_ = std::clamp(before / (few_lids ? kFewLidsParts : kParts), kMinFloor, floor_limit_);
    level(BuildStage::simplify, 0, few_lids ? kFewLidsWorth : kLastCapWorth);
    stalled = front_.triangle_count() > kFreeGain * before ? stalled + 1 : 0;
  }
}

/// Makes one level, and reports it. `worth`: maximum number of faces of a lid relative to its floor.
void FrontSimplifier::level(BuildStage stage, double limit, double worth) {
  passes_.report_begin(stage, front_.triangle_count(), limit);
  collapse_all();
  commit(worth);
  passes_.report_end({.front_faces = front_.triangle_count(), .excluded = open_.excluded(limit_)});
  passes_.end_pass(complex_, front_.triangle_count());
}

/// Makes all collapses within the limit, chunk by chunk: the order of distant collapses does not matter, and
/// a chunk stays in the caches.
void FrontSimplifier::collapse_all() {
  const std::vector<Index> order = along_curve();
  // Start at a random vertex, so that seeds give different fronts.
  const std::size_t first = random_.below(static_cast<std::uint32_t>(order.size()));
  for (std::size_t i = 0; i < order.size();) {
    for (const std::size_t last = std::min(i + kChunk, order.size()); i < last; ++i)
      propose_around(order[(first + i) % order.size()]);
    while (!queue_.empty()) evaluate(queue_.pop());
  }
}

/// Returns the vertices in use along a space-filling curve (Morton order).
std::vector<Index> FrontSimplifier::along_curve() const {
  constexpr std::uint32_t kCells = 1024;
  const auto spread = [](std::uint32_t x) {
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
  };
  std::vector<std::uint64_t> keys;
  for (Index v = 0; v < open_.vertex_count(); ++v) {
    if (!open_.is_used(v)) continue;
    std::uint32_t code = 0;
    for (int i = 0; i < 3; ++i) {
      const double cell = (open_.x(v)[i] - open_.box().min()[i]) / open_.size() * kCells;
      code |= spread(static_cast<std::uint32_t>(std::clamp(cell, 0.0, kCells - 1.0))) << i;
    }
    keys.push_back(std::uint64_t{code} << 32 | v);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const std::uint64_t k : keys) order.push_back(static_cast<Index>(k));
  return order;
}

// Proposals.

bool FrontSimplifier::load_hub(Index w) {
  hub_.w = w;
  hub_.spokes.clear();
  hub_.outward.setZero();
  hub_.rim_sum.setZero();
  hub_.offset = hub_.area = 0;
  hub_.united.clear();
  const Index first = open_.any_face(w);
  Index f = first;
  do {
    if (hub_.spokes.full()) return false;
    const auto& t = open_[f];
    const int i = OpenFront::index_of(t, w);
    const Index to = t.v[(i + 1) % 3];
    hub_.spokes.push_back({f, to});
    hub_.outward += t.n * t.area;
    hub_.offset += t.d * t.area;
    hub_.area += t.area;
    hub_.rim_sum += open_.x(to);
    open_.unite(f, limit_, hub_.united);
    f = t.across[(i + 2) % 3];
  } while (f != first);
  return true;
}

/// Proposes the edges of a vertex to those with larger numbers.
void FrontSimplifier::propose_around(Index w) {
  if (!open_.is_used(w) || !load_hub(w)) return;
  for (std::size_t k = 0; k < hub_.spokes.size(); ++k)
    if (w < hub_.spokes[k].to) propose(k);
}

/// Returns true unless the collapse of the face's edge sleeps, or was refused and nothing has changed.
bool FrontSimplifier::may_try(Index f, int edge) const {
  const auto& state = open_.state(f);
  if (state.wake[edge] <= limit_) return true;
  if (state.wake[edge] != kNever) return false;
  const Index u = open_[f].v[edge], v = open_[f].v[(edge + 1) % 3];
  return std::max(open_.changed_at(u), open_.changed_at(v)) > state.refused_at[edge];
}

/// Proposes what can be done with one edge of the hub. The edge w, to lies between the faces of this spoke
/// and of the one before.
void FrontSimplifier::propose(std::size_t k) {
  const Index w = hub_.w, r = hub_.spokes[k].to;
  const std::size_t n = hub_.spokes.size();
  const Index left = hub_.spokes[k].face, right = hub_.spokes[k > 0 ? k - 1 : n - 1].face;
  // The other faces around r, and the vertices beyond.
  others_.clear();
  for (Index f = right;;) {
    const auto& t = open_[f];
    f = t.across[(OpenFront::index_of(t, r) + 2) % 3];
    if (f == left) break;
    if (others_.full()) return;
    others_.push_back(f);
  }
  Vector3 rim = hub_.rim_sum - open_.x(r);
  std::size_t rim_size = n - 1;
  for (std::size_t i = 0; i + 1 < others_.size(); ++i) {
    const auto& t = open_[others_[i]];
    rim += open_.x(t.v[(OpenFront::index_of(t, r) + 2) % 3]);
    ++rim_size;
  }
  // Step 1: onto one of the two vertices.
  bool r_onto_w = true, w_onto_r = true;
  for (const Index o : others_)
    if (!(dot3(open_[o].n, open_.x(w)) > open_[o].d)) {
      r_onto_w = false;
      break;
    }
  for (std::size_t j = 0; j < n && w_onto_r; ++j) {
    const Index f = hub_.spokes[j].face;
    if (f != left && f != right) w_onto_r = dot3(open_[f].n, open_.x(r)) > open_[f].d;
  }
  bool proposed = false;
  if (r_onto_w) proposed |= propose_onto(r, w);
  if (w_onto_r) proposed |= propose_onto(w, r);
  // A new vertex costs a placement: only where nothing simpler can be done.
  if (proposed) return;
  // Step 2: the cap, which blocks most edges at the end of a level.
  scratch_union_ = hub_.united;
  for (const Index o : others_) open_.unite(o, limit_, scratch_union_);
  if (!may_unite(scratch_union_)) return;
  // Step 3: the rough cost of a new vertex: the volume under the lowest point in front of all planes that is
  // over the star's centre along its mean normal. The edge's state is kept from its smaller vertex.
  const Index low = std::min(w, r), holder = w < r ? left : right;
  if (!may_try(holder, OpenFront::index_of(open_[holder], low))) return;
  Vector3 outward = hub_.outward;
  double offset = hub_.offset;
  for (const Index o : others_) {
    outward += open_[o].n * open_[o].area;
    offset += open_[o].d * open_[o].area;
  }
  const double length = norm3(outward);
  if (!(length > 0)) return;
  const Vector3 along = outward / length, centre = rim / static_cast<double>(rim_size);
  double height = -kInfinity;
  const auto raise = [&](Index f) {
    const auto& p = open_[f];
    constexpr double kMinSlope = 0.1;
    height = std::max(height, (p.d - dot3(p.n, centre)) / std::max(dot3(p.n, along), kMinSlope));
  };
  for (const auto& spoke : hub_.spokes) raise(spoke.face);
  for (const Index o : others_) raise(o);
  const double volume =
      std::max(0.0, (dot3(outward, centre) - offset + height * length) / (3 * open_.unit()));
  queue_.push({static_cast<float>(volume), low, std::max(w, r), false});
}

bool FrontSimplifier::propose_onto(Index u, Index v) {
  if (!open_.find_star(u, v, true, scratch_) || !geometry_.is_in_front(scratch_)) return false;
  unite(scratch_, scratch_union_);
  if (!may_unite(scratch_union_) || !geometry_.clears_neighbours(scratch_)) return false;
  double area = 0;
  const double volume = geometry_.volume_under(scratch_, open_.x(v), area);
  const auto cost = static_cast<float>(volume + geometry_.needle_cost(scratch_, open_.x(v), area));
  if (!(cost < std::numeric_limits<float>::max())) return false;
  queue_.push({cost, u, v, true});
  return true;
}

// Evaluation.

void FrontSimplifier::unite(const Star& star, Union& united) const {
  united.clear();
  for (const Index f : star.faces) open_.unite(f, limit_, united);
}

/// Returns true if one more collapse may unite these.
bool FrontSimplifier::may_unite(const Union& united) const {
  if (united.excluded || united.faces > max_floor_) return false;
  return options_.max_lids == 0 || united.floor <= options_.max_lids + 2 * (united.collapses + 1);
}

/// Returns the number of steps between sample points from a to b: more where these are far from each other,
/// relative to the limit. (A long edge over a crease can be far off between few sample points, and its lid
/// would keep out all others above it.)
int FrontSimplifier::steps_along(const SurfaceWalk::Point& a, const SurfaceWalk::Point& b) const {
  const float x = a.x() - b.x(), y = a.y() - b.y(), z = a.z() - b.z();
  const float steps = std::sqrt(x * x + y * y + z * z) / (kSpacing * limit_);
  return steps < kSteps ? kSteps : static_cast<int>(std::min(steps, static_cast<float>(kMaxSteps)));
}

/// Returns 0 if the fan from w is within the limit of the body at its sample points; else about its
/// deviation. Prepares the state of its faces.
float FrontSimplifier::excess(const Star& star, const Vector3& w) {
  using Point = SurfaceWalk::Point;
  const float enough = limit_ * limit_;
  const auto mix = [](float s, const Point& a, float t, const Point& b) { return Point(s * a + t * b); };
  const Point tip = body_->local(w);
  FrontMesh::Slot hint = open_.state(star.faces[0]).hint;
  float most = 0, failed = 0;
  const auto is_near = [&](const Point& p) {
    const float sq = body_->walk(p, hint, enough);
    most = std::max(most, std::min(sq, enough));
    if (sq <= enough || body_->find_within(p, hint, enough)) return true;
    failed = std::sqrt(sq);
    return false;
  };
  if (!star.onto_v && !is_near(tip)) return failed;
  new_hints_.clear();
  Point a = body_->local(open_.x(star.rim[0].a)), b;
  for (std::size_t k = 0; k < star.rim.size(); ++k, a = b) {
    b = body_->local(open_.x(star.rim[k].b));
    hint = open_.state(star.rim[k].face).hint;
    const Point base = mix(0.5f, a, 0.5f, b);
    const int steps = steps_along(a, tip);
    const auto share = [](int i, int of) { return static_cast<float>(i) / static_cast<float>(of); };
    // The edge from a is in two triangles, but for the first one of a fan that is not closed. The middle
    // first, where most fail.
    const bool edge = !(star.onto_v && k == 0);
    if (edge && !is_near(mix(0.5f, a, 0.5f, tip))) return failed;
    if (!is_near(mix(2 / 3.0f, base, 1 / 3.0f, tip))) return failed;
    new_hints_.push_back(hint);
    if (!is_near(mix(0.5f, base, 0.5f, tip))) return failed;
    for (int i = 1; edge && i < steps; ++i)
      if (2 * i != steps && !is_near(mix(share(i, steps), a, share(steps - i, steps), tip))) return failed;
    // Large triangles: a grid.
    const int rows = std::min(std::max({steps, steps_along(b, tip), steps_along(a, b)}), kMaxRows);
    if (rows <= kSteps) continue;
    for (int i = 1; i < rows - 1; ++i)
      for (int j = 1; i + j < rows; ++j) {
        const float s = share(i, rows), t = share(j, rows);
        if (!is_near(mix(1, mix(s, a, t, b), 1 - s - t, tip))) return failed;
      }
  }
  new_off_ = std::sqrt(most);
  return 0;
}

/// Records that the collapse of star_ was refused: until the limit is `wake` or, if that is kNever, until a
/// face of its star changes.
void FrontSimplifier::refuse(CapVerdict verdict, float wake) {
  for (const Index c : united_.components) open_.set_held_by(c, verdict);
  if (star_.onto_v) return;
  auto& state = open_.state(star_.faces[0]);
  state.wake[star_.edge] = wake;
  state.refused_at[star_.edge] = open_.now();
}

/// Makes a proposed collapse, or refuses it. A collapse that would cover excluded or too many faces is
/// dropped without a verdict, here and in propose(), and so is an edge whose rim is too long.
void FrontSimplifier::evaluate(const QueuedCollapse& c) {
  // Step 1: the star may have changed since the collapse was proposed.
  if (!open_.is_used(c.u) || !open_.is_used(c.v) || !open_.find_star(c.u, c.v, c.onto_v, star_)) return;
  unite(star_, united_);
  if (!may_unite(united_)) return;
  if (!open_.leaves_surface(star_)) return refuse(CapVerdict::no_surface, kNever);
  // Step 2: the position.
  Vector3 w;
  if (c.onto_v) {
    w = open_.x(c.v);
    if (!geometry_.is_in_front(star_) || !geometry_.clears_neighbours(star_)) return;
  } else if (!geometry_.place(star_, w)) {
    return refuse(CapVerdict::no_place, kNever);
  }
  // Step 3: the cost.
  double area = 0;
  const double volume = geometry_.volume_under(star_, w, area);
  if (const double height = 3 * volume / area; height > kMaxHeight * limit_)
    return refuse(CapVerdict::too_thick, static_cast<float>(height / kMaxHeight));
  const auto cost = static_cast<float>(volume + geometry_.needle_cost(star_, w, area));
  if (!(cost < std::numeric_limits<float>::max())) return refuse(CapVerdict::too_thin, kNever);
  if (!queue_.empty() && queue_.bucket_of(cost) > queue_.current())
    return queue_.push({cost, c.u, c.v, c.onto_v});
  // Step 4: the deviation, of fans that do not fold back over their neighbours.
  if (geometry_.folds(star_, w)) return refuse(CapVerdict::turns_inward, kNever);
  if (const float deviation = body_ ? excess(star_, w) : 0; deviation > 0)
    return refuse(CapVerdict::too_thick, std::max(deviation, kWake * limit_));
  // Step 5: the exact tests.
  if (!geometry_.is_strictly_in_front(star_, w)) return refuse(CapVerdict::no_place, kNever);
  if (open_.was_restored()) {
    const bool careful = std::any_of(star_.faces.begin(), star_.faces.end(),
                                     [&](Index f) { return open_.state(f).careful; }) ||
                         std::any_of(united_.components.begin(), united_.components.end(),
                                     [&](Index i) { return open_.is_careful(i); });
    if (careful)
      if (const CapVerdict v = proof_.judge_fan(star_, united_.components, w, tree_);
          v != CapVerdict::accepted)
        return refuse(v, kNever);
  }
  const Index tip = open_.collapse(star_, united_, w, new_hints_, new_off_);
  // Step 6: propose new collapses: the edges from the new fan's vertex to the rim.
  if (!load_hub(tip)) return;
  on_rim_.resize(open_.vertex_count(), false);
  for (const auto& r : star_.rim) on_rim_[r.a] = on_rim_[r.b] = true;
  for (std::size_t k = 0; k < hub_.spokes.size(); ++k)
    if (on_rim_[hub_.spokes[k].to]) propose(k);
  for (const auto& r : star_.rim) on_rim_[r.a] = on_rim_[r.b] = false;
}

// Commits.

void FrontSimplifier::commit(double worth) {
  if (!tree_.fits(front_)) tree_.rebuild(front_);
  for (OpenFront::Lid& lid : open_.lids()) {
    const CapVerdict verdict = finish(lid, worth);
    if (options_.probe) notify(lid, verdict);
    if (verdict == CapVerdict::accepted) put_on(lid);
    // A component that is not simple enough stays open. One that failed is undone, and so is one that cannot
    // grow any more, because the polygons that it covers in part cost too many faces.
    else if (verdict == CapVerdict::too_many_faces && open_.floor_faces(lid.component) > kFull * max_floor_ &&
             !open_.uncovered_parts(lid.component, true).empty())
      open_.restore(lid, 0);
    else if (verdict != CapVerdict::too_many_faces && verdict != CapVerdict::splits_polygon)
      open_.restore(lid, open_.is_careful(lid.component) ? kExclude * limit_ : 0);
  }
}

CapVerdict FrontSimplifier::finish(OpenFront::Lid& lid, double worth) {
  std::vector<Index> rest;  // of merged planes
  const auto is_worth_it = [&] {
    rest = open_.uncovered_parts(lid.component, true);
    return static_cast<double>(lid.faces.size() + rest.size()) <=
           worth * static_cast<double>(options_.merge_planes ? open_.floor_faces(lid.component)
                                                             : open_.floor(lid.component).size());
  };
  if (!is_worth_it()) return CapVerdict::too_many_faces;
  if (!cover_polygons(lid)) return CapVerdict::splits_polygon;
  if (!is_worth_it()) return CapVerdict::too_many_faces;
  const CapVerdict verdict = proof_.judge(lid, tree_);
  // The rest of a merged plane stays where it is, as triangles of the lid.
  if (verdict == CapVerdict::accepted)
    for (const Index f : rest) lid.faces.push_back(open_.keep(lid.component, f));
  return verdict;
}

/// Extends the floor to whole polygons of the mesh: by flips that only move the lid outward, then by covering
/// the remaining parts of a polygon with flat pyramids. Returns false if neither is possible somewhere.
bool FrontSimplifier::cover_polygons(OpenFront::Lid& lid) {
  for (;;) {
    const std::vector<Index> parts = open_.uncovered_parts(lid.component, false);
    if (parts.empty()) return true;
    bool progress = false;
    for (const Index f : parts)
      for (int i = 0; i < 3 && open_.state(f).alive; ++i) {
        Index flipped[2];
        const Index beyond = open_[f].across[i];
        if (!open_.flip_outward(lid.component, f, i, flipped)) continue;
        std::erase(lid.faces, beyond);
        lid.faces.insert(lid.faces.end(), {flipped[0], flipped[1]});
        progress = true;
      }
    if (progress) continue;
    for (const Index f : parts) {
      star_.faces.clear(), star_.rim.clear();
      star_.onto_v = false;
      star_.faces.push_back(f);
      const auto& v = open_[f].v;
      for (int i = 0; i < 3; ++i) star_.rim.push_back({v[i], v[(i + 1) % 3], open_[f].across[i], f});
      Vector3 w;
      if (open_.state(f).excluded_below > limit_ || !geometry_.place(star_, w) ||
          !geometry_.is_strictly_in_front(star_, w))
        return false;
      const auto raised = open_.raise(lid.component, f, w);
      lid.faces.insert(lid.faces.end(), raised.begin(), raised.end());
    }
  }
}

void FrontSimplifier::put_on(const OpenFront::Lid& lid) {
  Sheet sheet;
  const auto& floor = open_.floor(lid.component);
  for (const Index f : floor) sheet.removed.push_back(open_.state(f).slot);
  std::vector<Index> fresh;  // vertices that are new in the committed front
  const auto corner_of = [&](Index v) {
    if (open_.corner(v) != kNull) return open_.corner(v);
    const auto at = std::find(fresh.begin(), fresh.end(), v);
    if (at == fresh.end()) {
      fresh.push_back(v);
      sheet.new_points.push_back(open_.x(v));
      return static_cast<FrontMesh::Corner>(Sheet::kNewPoint + fresh.size() - 1);
    }
    return static_cast<FrontMesh::Corner>(Sheet::kNewPoint + (at - fresh.begin()));
  };
  for (const Index f : lid.faces) {
    const auto& v = open_[f].v;
    sheet.added.push_back({corner_of(v[0]), corner_of(v[1]), corner_of(v[2])});
  }
  work_out(front_, sheet);
  const FrontMesh::Corner first = front_.point_count();
  const std::uint32_t component = front_[sheet.removed.front()].component;
  const auto slots = cover(front_, complex_, sheet, passes_.layer(), component, options_.probe);
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    const auto corner = static_cast<FrontMesh::Corner>(first + i);
    open_.set_committed(fresh[i], corner, front_.point(corner).id);
  }
  for (const FrontMesh::Slot s : slots) tree_.update(s, box_of(front_, s));
  open_.commit(lid, slots);
}

/// Reports a component as a patch, with its lid as the cap.
void FrontSimplifier::notify(const OpenFront::Lid& lid, CapVerdict verdict) const {
  const auto& floor = open_.floor(lid.component);
  // The vertices that the lid does not have.
  std::vector<Index> inside, kept;
  for (const Index f : lid.faces) kept.insert(kept.end(), open_[f].v.begin(), open_[f].v.end());
  for (const Index f : floor) inside.insert(inside.end(), open_[f].v.begin(), open_[f].v.end());
  for (auto* list : {&inside, &kept}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  std::vector<VertexId> vertices;
  for (const Index v : inside)
    if (!std::binary_search(kept.begin(), kept.end(), v)) vertices.push_back(open_.id(v));
  const VertexId first = vertices.empty() ? open_.id(inside.front()) : vertices.front();
  options_.probe->patch({first, static_cast<std::uint32_t>(floor.size()),
                         static_cast<std::uint32_t>(vertices.size()), vertices});
  float deviation = 0;
  for (const Index f : lid.faces) deviation = std::max(deviation, open_.state(f).deviation);
  // What holds back a lid of too many faces is why its last collapse was refused.
  if (verdict == CapVerdict::too_many_faces) verdict = open_.held_by(lid.component);
  options_.probe->cap(
      {static_cast<std::uint32_t>(lid.faces.size()), static_cast<std::uint32_t>(floor.size()), verdict,
       open_.is_careful(lid.component),
       verdict == CapVerdict::accepted && body_ ? std::min(deviation, limit_) * open_.unit() : -1});
}

}  // namespace lrb::construct

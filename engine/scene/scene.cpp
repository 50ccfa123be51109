// Collisions and distances among many moving bodies.
// collide():
// 1. Recompute the world AABBs of moved bodies.
// 2. Broad phase: within a scene, sort and sweep, coherent from call to call; otherwise a one-axis sweep.
// 3. Narrow phase: an exact query for each pair, as one batch. Within a scene, pairs of which neither body
// has
//    moved keep their answers.
// nearest(): branch and bound over pairs in ascending order of the gaps of their AABBs.
// Candidate pairs are sorted by gap and keys, so no result depends on the number of threads.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "engine/scene/near_boxes.hpp"
#include <lrbscope/broad_phase.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/scene.hpp>
#include <lrbscope/workspace.hpp>
#include <lrbscope/world_box.hpp>

namespace lrb {
namespace scene {

/// A posed body: one slot of a scene.
struct PlacedBody {
  BodyKey key{};
  const LrbRep* rep = nullptr;
  Pose pose;
};

/// The bodies of one side of a query with their world AABBs: an entire scene or a single body. A free slot
/// has an empty box.
struct Participant {
  std::span<const Box> boxes;
  std::span<const PlacedBody> placed;
};

/// A candidate pair, by slot indices. Ordered by gap, then by keys.
struct NearbyPair {
  double gap = 0;  ///< lower bound on the distance of their AABBs
  BodyKey key_a{}, key_b{};
  std::uint32_t a = 0, b = 0;

  friend bool operator<(const NearbyPair& x, const NearbyPair& y) {
    return std::tie(x.gap, x.key_a, x.key_b) < std::tie(y.gap, y.key_a, y.key_b);
  }
};

}  // namespace scene

namespace {

using namespace scene;

// The pairs of a query.

/// The two sides of a query. `is_one`: both are the same scene, and each unordered pair counts once.
struct Participants {
  Participant a, b;
  bool is_one = false;

  /// Returns the pair of two bodies; of the same scene, the one with the lower key first.
  NearbyPair pair(std::uint32_t i, std::uint32_t j, double gap) const {
    if (is_one && a.placed[j].key < a.placed[i].key) std::swap(i, j);
    return {gap, a.placed[i].key, b.placed[j].key, i, j};
  }

  /// Calls visit(near) for the pairs whose AABBs are at most `limit` apart. visit() may lower the limit.
  template <class Visit>
  void each_near(const double& limit, const Visit& visit) const {
    const auto found = [&](std::uint32_t i, std::uint32_t j, double gap) { visit(pair(i, j, gap)); };
    is_one ? each_near_pair(a.boxes, limit, found) : each_near_pair(a.boxes, b.boxes, limit, found);
  }

  PosedPair posed(const NearbyPair& near) const {
    const PlacedBody &x = a.placed[near.a], &y = b.placed[near.b];
    return {x.rep, x.pose, y.rep, y.pose};
  }
};

/// Returns the pair with the smallest gap between AABBs (ties: lowest keys), or nullopt if there is no pair.
std::optional<NearbyPair> nearest_of(const Participants& participants) {
  std::optional<NearbyPair> nearest;
  double limit = std::numeric_limits<double>::infinity();
  participants.each_near(limit, [&](const NearbyPair& n) {
    // Lowering the limit during the sweep prunes the rest of it.
    if (nearest && !(n < *nearest)) return;
    nearest = n;
    limit = n.gap;
  });
  return nearest;
}

double distance_of(const DistanceResult& found, Apart apart) {
  return apart == Apart::solids ? found.solids_upper() : found.upper;
}

/// Returns true if collide() reports an answer: an error, or any contact or containment.
bool is_reported(const Expected<CollideResult>& answer) {
  return !answer || (answer->relation != Relation::separate && answer->relation != Relation::undefined);
}

}  // namespace

using scene::Box, scene::NearbyPair, scene::Participant, scene::PlacedBody;

class Scene::Impl {
 public:
  explicit Impl(unsigned threads) : workers_(threads), batch_(workers_.count()) {}

  BodyKey add(Body body, const Pose& pose);
  bool remove(BodyKey key);
  bool move(BodyKey key, const Pose& pose);

  std::size_t size() const { return place_of_.size(); }
  bool has(BodyKey key) const { return place_of_.contains(key); }
  const Body& body(BodyKey key) const { return *slots_[place_of_.at(key)].body; }
  const Pose& pose(BodyKey key) const { return placed_[place_of_.at(key)].pose; }
  std::vector<BodyKey> keys() const;

  void reserve(std::size_t bodies);

  /// Return the two sides of a query, with up-to-date boxes: the scene with itself; a body from outside with
  /// the scene; the scene with another one.
  Participants own();
  Participants with(const Participant& outside) { return {outside, participant(), false}; }
  Participants with(Impl& other);

  std::span<const ScenePair> near(const Participants& participants, double within);
  std::optional<ScenePair> nearest_boxes(const Participants& participants) const;
  std::span<const SceneAnswer> collide(const Participants& participants, const CollideRequest& request);
  std::optional<SceneDistance> nearest(const Participants& participants, const DistanceRequest& request,
                                       Apart apart);

  Work work;

 private:
  /// The data of a body in addition to PlacedBody and its box.
  struct Slot {
    std::optional<Body> body;
    std::shared_ptr<const BodyExtent> extent;  ///< shared by all copies of a body
    ExtremeVertices last;
    bool has_moved = false, has_changed = false;  ///< is in moved_, in changed_
    std::uint64_t moved_at = 0;                   ///< by clock_
  };

  /// A pair of the last collide() within the scene.
  struct Queried {
    BodyKey a{}, b{};
    std::size_t reported = kNotReported;  ///< index in reported_
  };
  static constexpr std::size_t kNotReported = std::numeric_limits<std::size_t>::max();

  std::uint32_t free_place();
  void note_change(std::uint32_t place) {
    if (!std::exchange(slots_[place].has_changed, true)) changed_.push_back(place);
  }
  void add_places(std::size_t more);
  std::shared_ptr<const BodyExtent> extent_of(const LrbRep& rep);
  Participant participant();
  std::vector<NearbyPair> find_near(const Participants& participants, double within);
  std::vector<NearbyPair> sweep(const Participants& all);
  std::vector<const Queried*> find_kept(std::span<const NearbyPair> near,
                                        const CollideRequest& request) const;
  void measure(const Participants& participants, std::span<const NearbyPair> near, DistanceRequest request);

  Workers workers_;
  Batch batch_;
  SweepAndPrune sweep_;
  std::uint64_t next_key_ = 0;
  std::size_t came_and_gone_ = 0;  ///< bodies added or removed since the last sweep

  std::vector<Slot> slots_;
  std::vector<PlacedBody> placed_;  ///< (|slots|)
  std::vector<Box> boxes_;          ///< (|slots|) empty for free slots
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> moved_;    ///< slots whose boxes must be recomputed
  std::vector<std::uint32_t> changed_;  ///< slots whose boxes have changed since the last sweep
  std::unordered_map<BodyKey, std::uint32_t> place_of_;
  std::unordered_map<std::uint64_t, std::weak_ptr<const BodyExtent>> extents_;  ///< by LrbRep::serial()

  std::vector<ScenePair> near_;
  std::vector<PosedPair> questions_;
  CollideAnswers answers_;
  DistanceAnswers distances_;
  std::vector<SceneAnswer> reported_, next_reported_;  ///< of pairs within the scene
  std::vector<SceneAnswer> reported_outside_;          ///< of pairs with others
  std::uint64_t clock_ = 0;                            ///< counts moves
  std::vector<Queried> queried_;                       ///< ascending by keys
  std::uint64_t queried_at_ = 0;                       ///< by clock_
  CollideRequest queried_with_;
};

std::vector<BodyKey> Scene::Impl::keys() const {
  std::vector<BodyKey> out;
  out.reserve(place_of_.size());
  for (const auto& [key, place] : place_of_) out.push_back(key);
  std::sort(out.begin(), out.end());
  return out;
}

/// Adds free slots. The broad phase restarts if the number of boxes changes.
void Scene::Impl::add_places(std::size_t more) {
  const std::size_t before = slots_.size();
  // Reverse order: slots are taken from the back of free_, so the lowest index is used first.
  for (std::size_t i = before + more; i-- > before;) free_.push_back(static_cast<std::uint32_t>(i));
  slots_.resize(before + more);
  placed_.resize(before + more);
  boxes_.resize(before + more);
}

void Scene::Impl::reserve(std::size_t bodies) {
  if (bodies > slots_.size()) add_places(bodies - slots_.size());
}

std::uint32_t Scene::Impl::free_place() {
  constexpr std::size_t kFew = 16;
  // Grow by half: amortised constant time per body.
  if (free_.empty()) add_places(std::max(kFew, slots_.size() / 2));
  const std::uint32_t place = free_.back();
  free_.pop_back();
  return place;
}

std::shared_ptr<const BodyExtent> Scene::Impl::extent_of(const LrbRep& rep) {
  // Copies of a body share its extent. The map has weak references: the slots own it.
  std::weak_ptr<const BodyExtent>& known = extents_[rep.serial()];
  std::shared_ptr<const BodyExtent> extent = known.lock();
  if (!extent) known = extent = std::make_shared<const BodyExtent>(rep);
  return extent;
}

BodyKey Scene::Impl::add(Body body, const Pose& pose) {
  const std::uint32_t place = free_place();
  const auto key = BodyKey{next_key_++};
  Slot& slot = slots_[place];
  slot.extent = extent_of(body.rep());
  placed_[place] = {key, &body.rep(), pose};
  slot.body = std::move(body);
  slot.last = {};
  slot.moved_at = ++clock_;
  // The flag keeps each slot in moved_ at most once.
  if (!std::exchange(slot.has_moved, true)) moved_.push_back(place);
  place_of_[key] = place;
  ++came_and_gone_;
  return key;
}

bool Scene::Impl::remove(BodyKey key) {
  const auto found = place_of_.find(key);
  if (found == place_of_.end()) return false;
  const std::uint32_t place = found->second;
  const std::uint64_t serial = placed_[place].rep->serial();
  // The last copy of a body releases the shared extent; then the map entry is removed.
  slots_[place].extent.reset();
  if (extents_[serial].expired()) extents_.erase(serial);
  slots_[place].body.reset();
  placed_[place] = {};
  boxes_[place].setEmpty();
  note_change(place);
  free_.push_back(place);
  place_of_.erase(found);
  ++came_and_gone_;
  return true;
}

bool Scene::Impl::move(BodyKey key, const Pose& pose) {
  const auto found = place_of_.find(key);
  if (found == place_of_.end()) return false;
  const std::uint32_t place = found->second;
  if (placed_[place].pose.r == pose.r && placed_[place].pose.t == pose.t) return true;
  placed_[place].pose = pose;
  slots_[place].moved_at = ++clock_;
  if (!std::exchange(slots_[place].has_moved, true)) moved_.push_back(place);
  return true;
}

Participant Scene::Impl::participant() {
  work.moved = moved_.size();
  // Recompute only the AABBs of moved bodies, in parallel: each task writes its own slot.
  workers_.for_each(moved_.size(), [&](std::size_t k, unsigned) {
    const std::uint32_t place = moved_[k];
    Slot& slot = slots_[place];
    if (slot.body && slot.has_moved) boxes_[place] = slot.extent->in_world(placed_[place].pose, &slot.last);
  });
  for (const std::uint32_t place : moved_) slots_[place].has_moved = false;
  for (const std::uint32_t place : moved_) note_change(place);
  moved_.clear();
  return {boxes_, placed_};
}

Participants Scene::Impl::own() {
  const Participant all = participant();
  return {all, all, true};
}

Participants Scene::Impl::with(Impl& other) {
  const Participant others = other.participant();
  return {participant(), others, false};
}

/// Returns the pairs of a scene whose AABBs intersect, by the broad phase.
std::vector<NearbyPair> Scene::Impl::sweep(const Participants& all) {
  // The insertion sort moves each new box through the order. If more than 1 in 8 bodies were added or
  // removed, restart with a full sort.
  constexpr std::size_t kShareThatStays = 8;
  if (std::exchange(came_and_gone_, 0) > slots_.size() / kShareThatStays) sweep_ = {};
  std::sort(changed_.begin(), changed_.end());
  std::vector<NearbyPair> near;
  for (const BodyPair& p : sweep_.update(all.a.boxes, changed_)) near.push_back(all.pair(p.i, p.j, 0));
  for (const std::uint32_t place : changed_) slots_[place].has_changed = false;
  changed_.clear();
  work.broad_phase = sweep_.work();
  return near;
}

std::vector<NearbyPair> Scene::Impl::find_near(const Participants& participants, double within) {
  std::vector<NearbyPair> near;
  // Within one scene and at distance 0, the coherent broad phase applies. Otherwise sweep along one axis.
  if (participants.is_one && !(within > 0))
    near = sweep(participants);
  else
    participants.each_near(within, [&](const NearbyPair& n) { near.push_back(n); });
  // A unique order, whichever method found the pairs. Without removed bodies, the sweep has it already.
  if (!std::is_sorted(near.begin(), near.end())) std::sort(near.begin(), near.end());
  work.near = near.size();
  return near;
}

std::span<const ScenePair> Scene::Impl::near(const Participants& participants, double within) {
  const FloatMode float_mode;
  near_.clear();
  for (const NearbyPair& n : find_near(participants, within)) near_.push_back({n.key_a, n.key_b, n.gap});
  return near_;
}

std::optional<ScenePair> Scene::Impl::nearest_boxes(const Participants& participants) const {
  const FloatMode float_mode;
  const std::optional<NearbyPair> found = nearest_of(participants);
  if (!found) return {};
  return ScenePair{found->key_a, found->key_b, found->gap};
}

/// Returns for each pair within the scene the last answer, if it is still valid, or null.
std::vector<const Scene::Impl::Queried*> Scene::Impl::find_kept(std::span<const NearbyPair> near,
                                                                const CollideRequest& request) const {
  std::vector<const Queried*> kept(near.size());
  // An answer that depends on the time taken is not repeatable.
  if (queried_.empty() || !(queried_with_ == request) || request.max_time > 0) return kept;
  const auto has_stayed = [&](std::uint32_t place) { return slots_[place].moved_at <= queried_at_; };
  // Both lists are ascending by keys.
  auto last = queried_.begin();
  for (std::size_t i = 0; i < near.size(); ++i) {
    const NearbyPair& n = near[i];
    while (last != queried_.end() && std::tie(last->a, last->b) < std::tie(n.key_a, n.key_b)) ++last;
    if (last == queried_.end()) break;
    if (last->a == n.key_a && last->b == n.key_b && has_stayed(n.a) && has_stayed(n.b)) kept[i] = &*last;
  }
  return kept;
}

std::span<const SceneAnswer> Scene::Impl::collide(const Participants& participants,
                                                  const CollideRequest& request) {
  const FloatMode float_mode;
  const std::vector<NearbyPair> near = find_near(participants, 0);
  std::vector<const Queried*> kept(near.size());
  if (participants.is_one) kept = find_kept(near, request);
  questions_.clear();
  for (std::size_t i = 0; i < near.size(); ++i)
    if (kept[i] == nullptr) questions_.push_back(participants.posed(near[i]));
  work.kept = near.size() - questions_.size();
  // The narrow phase runs all exact queries as one batch.
  batch_.collide(questions_, request, answers_);
  std::vector<Queried> queried;
  std::vector<SceneAnswer>& reported = participants.is_one ? next_reported_ : reported_outside_;
  std::size_t count = 0, answered = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    queried.push_back({near[i].key_a, near[i].key_b, kNotReported});
    Expected<CollideResult>* answer = nullptr;
    if (kept[i] == nullptr)
      answer = &answers_[answered++];
    else if (kept[i]->reported != kNotReported)
      answer = &reported_[kept[i]->reported].result;
    if (answer == nullptr || !is_reported(*answer)) continue;
    if (reported.size() == count) reported.emplace_back();
    reported[count].a = near[i].key_a;
    reported[count].b = near[i].key_b;
    // Swap instead of move: the buffers of earlier results are reused for the next ones.
    std::swap(reported[count].result, *answer);
    queried.back().reported = count++;
  }
  if (!participants.is_one) return std::span<const SceneAnswer>(reported).first(count);
  std::swap(reported_, next_reported_);
  queried_ = std::move(queried);
  queried_at_ = clock_;
  queried_with_ = request;
  return std::span<const SceneAnswer>(reported_).first(count);
}

/// Computes the distances of pairs, into distances_. DistanceRequest::within is ignored, because every pair
/// needs bounds.
void Scene::Impl::measure(const Participants& participants, std::span<const NearbyPair> near,
                          DistanceRequest request) {
  request.within.reset();
  questions_.clear();
  for (const NearbyPair& n : near) questions_.push_back(participants.posed(n));
  batch_.distance(questions_, request, distances_);
}

std::optional<SceneDistance> Scene::Impl::nearest(const Participants& participants,
                                                  const DistanceRequest& request, Apart apart) {
  const FloatMode float_mode;
  // Pairs per batch, independent of the number of threads. Distances found in a batch prune later ones.
  constexpr std::size_t kAtATime = 64;
  // Step 1: an upper bound, from the pair with the smallest gap between AABBs.
  const std::optional<NearbyPair> likely = nearest_of(participants);
  if (!likely) return {};
  measure(participants, std::span(&*likely, 1), request);
  SceneDistance best{likely->key_a, likely->key_b, distances_[0]};
  if (!best.result) return best;
  // Step 2: only pairs whose gap is within that bound can be closer. They are in ascending order of gap.
  const std::vector<NearbyPair> near = find_near(participants, distance_of(*best.result, apart));
  for (std::size_t begin = 0; begin < near.size(); begin += kAtATime) {
    const double upper = distance_of(*best.result, apart);
    // The gap is a lower bound on the distance: no further pair can be closer.
    if (upper == 0 || near[begin].gap > upper) break;
    const auto some = std::span(near).subspan(begin, std::min(kAtATime, near.size() - begin));
    // Step 3: exact distances of the next batch, which may lower the bound.
    measure(participants, some, request);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const SceneDistance found{some[i].key_a, some[i].key_b, distances_[i]};
      // An error is the answer, because this pair might have been the closest.
      if (!found.result) return found;
      if (distance_of(*found.result, apart) < distance_of(*best.result, apart)) best = found;
    }
  }
  return best;
}

namespace {

/// A single body as one side of a query.
struct ExclusiveAccess {
  ExclusiveAccess(const Body& body, const Pose& pose)
      : box(world_box(body, pose)), placed{BodyKey{}, &body.rep(), pose} {}
  operator Participant() const { return {{&box, 1}, {&placed, 1}}; }

  Box box;
  PlacedBody placed;
};

}  // namespace

Scene::Scene(unsigned threads) : impl_(std::make_unique<Impl>(threads)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

void Scene::reserve(std::size_t bodies) {
  impl_->reserve(bodies);
}
BodyKey Scene::add(Body body, const Pose& pose) {
  return impl_->add(std::move(body), pose);
}
bool Scene::remove(BodyKey key) {
  return impl_->remove(key);
}
bool Scene::move(BodyKey key, const Pose& pose) {
  return impl_->move(key, pose);
}
std::size_t Scene::size() const {
  return impl_->size();
}
bool Scene::has(BodyKey key) const {
  return impl_->has(key);
}
const Body& Scene::body(BodyKey key) const {
  return impl_->body(key);
}
const Pose& Scene::pose(BodyKey key) const {
  return impl_->pose(key);
}
std::vector<BodyKey> Scene::keys() const {
  return impl_->keys();
}

std::span<const ScenePair> Scene::near(double within) {
  return impl_->near(impl_->own(), within);
}
std::span<const ScenePair> Scene::near(const Body& body, const Pose& pose, double within) {
  const ExclusiveAccess alone(body, pose);
  return impl_->near(impl_->with(alone), within);
}
std::span<const ScenePair> Scene::near(Scene& other, double within) {
  return impl_->near(impl_->with(*other.impl_), within);
}

std::optional<ScenePair> Scene::nearest_boxes() {
  return impl_->nearest_boxes(impl_->own());
}
std::optional<ScenePair> Scene::nearest_boxes(const Body& body, const Pose& pose) {
  const ExclusiveAccess alone(body, pose);
  return impl_->nearest_boxes(impl_->with(alone));
}
std::optional<ScenePair> Scene::nearest_boxes(Scene& other) {
  return impl_->nearest_boxes(impl_->with(*other.impl_));
}

std::span<const SceneAnswer> Scene::collide(const CollideRequest& request) {
  return impl_->collide(impl_->own(), request);
}
std::span<const SceneAnswer> Scene::collide(const Body& body, const Pose& pose,
                                            const CollideRequest& request) {
  const ExclusiveAccess alone(body, pose);
  return impl_->collide(impl_->with(alone), request);
}
std::span<const SceneAnswer> Scene::collide(Scene& other, const CollideRequest& request) {
  return impl_->collide(impl_->with(*other.impl_), request);
}

std::optional<SceneDistance> Scene::nearest(const DistanceRequest& request, Apart apart) {
  return impl_->nearest(impl_->own(), request, apart);
}
std::optional<SceneDistance> Scene::nearest(const Body& body, const Pose& pose,
                                            const DistanceRequest& request, Apart apart) {
  const ExclusiveAccess alone(body, pose);
  return impl_->nearest(impl_->with(alone), request, apart);
}
std::optional<SceneDistance> Scene::nearest(Scene& other, const DistanceRequest& request, Apart apart) {
  return impl_->nearest(impl_->with(*other.impl_), request, apart);
}

const Scene::Work& Scene::work() const {
  return impl_->work;
}

}  // namespace lrb

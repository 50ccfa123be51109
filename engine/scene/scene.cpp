#include "engine/scene/scene.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "engine/core/parallel.hpp"
#include "engine/query/batch/batch.hpp"
#include "engine/query/broad_phase.hpp"
#include "engine/query/world_box.hpp"
#include "engine/scene/near_boxes.hpp"

namespace lrb {
namespace scene {

/// A body where it stands.
struct Standing {
  BodyKey key{};
  const LrbRep* rep = nullptr;
  Pose pose;
};

/// Bodies with their boxes: those of a scene, or one alone. Where nobody stands the box is empty.
struct Party {
  std::span<const Box> boxes;
  std::span<const Standing> standing;
};

/// Two bodies to be asked about, by their places in their parties.
struct Near {
  double gap = 0;  ///< of their boxes
  BodyKey key_a{}, key_b{};
  std::uint32_t a = 0, b = 0;

  friend bool operator<(const Near& x, const Near& y) {
    return std::tie(x.gap, x.key_a, x.key_b) < std::tie(y.gap, y.key_a, y.key_b);
  }
};

}  // namespace scene

namespace {

using namespace scene;

/// Returns two bodies of the same scene, the one with the lower key first.
Near near_of_one(const Party& party, std::uint32_t i, std::uint32_t j, double gap) {
  if (party.standing[j].key < party.standing[i].key) std::swap(i, j);
  return {gap, party.standing[i].key, party.standing[j].key, i, j};
}

Near near_of_two(const Party& a, const Party& b, std::uint32_t i, std::uint32_t j, double gap) {
  return {gap, a.standing[i].key, b.standing[j].key, i, j};
}

PosedPair posed(const Party& a, const Party& b, const Near& near) {
  const Standing &x = a.standing[near.a], &y = b.standing[near.b];
  return {x.rep, x.pose, y.rep, y.pose};
}

/// Returns true if an answer is one that a scene tells.
bool is_told(const Expected<CollideResult>& answer) {
  return !answer || (answer->relation != Relation::separate && answer->relation != Relation::undefined);
}

}  // namespace

using scene::Box, scene::Near, scene::Party, scene::Standing;

class Scene::Held {
 public:
  explicit Held(unsigned threads) : workers_(threads), batch_(workers_.count()) {}

  BodyKey add(Body body, const Pose& pose);
  bool remove(BodyKey key);
  bool move(BodyKey key, const Pose& pose);

  std::size_t size() const { return place_of_.size(); }
  bool has(BodyKey key) const { return place_of_.contains(key); }
  const Body& body(BodyKey key) const { return *slots_[place_of_.at(key)].body; }
  const Pose& pose(BodyKey key) const { return standing_[place_of_.at(key)].pose; }
  std::vector<BodyKey> keys() const;

  /// Returns all bodies, with boxes as they stand now.
  Party party();
  std::span<const SceneAnswer> collide(const CollideRequest& request);
  std::span<const SceneAnswer> collide(const Party& a, const Party& b, const CollideRequest& request);
  std::optional<SceneDistance> nearest(const DistanceRequest& request);
  std::optional<SceneDistance> nearest(const Party& a, const Party& b, const DistanceRequest& request);

  Work work;

 private:
  /// Beside what Standing and the box say of a body.
  struct Slot {
    std::optional<Body> body;
    std::shared_ptr<const BodyExtent> extent;  ///< one for all copies of a body
    ExtremeVertices last;
    bool has_moved = false;
  };

  std::uint32_t free_place();
  std::shared_ptr<const BodyExtent> extent_of(const LrbRep& rep);
  std::span<const SceneAnswer> ask(const Party& a, const Party& b, std::vector<Near>& near,
                                   const CollideRequest& request);
  void measure(const Party& a, const Party& b, std::span<const Near> near, DistanceRequest request);
  template <class EachNear>
  std::optional<SceneDistance> nearest_of(const Party& a, const Party& b, const DistanceRequest& request,
                                          const EachNear& each_near);

  Workers workers_;
  Batch batch_;
  SweepAndPrune sweep_;
  std::uint64_t next_key_ = 0;
  std::size_t came_and_gone_ = 0;  ///< since the last sweep

  std::vector<Slot> slots_;
  std::vector<Standing> standing_;  ///< (|slots|)
  std::vector<Box> boxes_;          ///< (|slots|) empty where nobody stands
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> moved_;  ///< slots whose boxes are to be made anew
  std::unordered_map<BodyKey, std::uint32_t> place_of_;
  std::unordered_map<std::uint64_t, std::weak_ptr<const BodyExtent>> extents_;  ///< by LrbRep::serial()

  std::vector<PosedPair> questions_;
  CollideAnswers answers_;
  DistanceAnswers distances_;
  std::vector<SceneAnswer> told_;
};

std::vector<BodyKey> Scene::Held::keys() const {
  std::vector<BodyKey> out;
  out.reserve(place_of_.size());
  for (const auto& [key, place] : place_of_) out.push_back(key);
  std::sort(out.begin(), out.end());
  return out;
}

/// Returns a slot where nobody stands. Slots come in numbers, so that the broad phase seldom sees more boxes than
/// before, which makes it give up its order.
std::uint32_t Scene::Held::free_place() {
  if (free_.empty()) {
    const std::size_t before = slots_.size(), more = std::max<std::size_t>(16, before / 2);
    for (std::size_t i = before + more; i-- > before;) free_.push_back(static_cast<std::uint32_t>(i));
    slots_.resize(before + more);
    standing_.resize(before + more);
    boxes_.resize(before + more);
  }
  const std::uint32_t place = free_.back();
  free_.pop_back();
  return place;
}

std::shared_ptr<const BodyExtent> Scene::Held::extent_of(const LrbRep& rep) {
  std::weak_ptr<const BodyExtent>& known = extents_[rep.serial()];
  std::shared_ptr<const BodyExtent> extent = known.lock();
  if (!extent) known = extent = std::make_shared<const BodyExtent>(rep);
  return extent;
}

BodyKey Scene::Held::add(Body body, const Pose& pose) {
  const std::uint32_t place = free_place();
  const auto key = BodyKey{next_key_++};
  Slot& slot = slots_[place];
  slot.extent = extent_of(body.rep());
  standing_[place] = {key, &body.rep(), pose};
  slot.body = std::move(body);
  slot.last = {};
  if (!std::exchange(slot.has_moved, true)) moved_.push_back(place);
  place_of_[key] = place;
  ++came_and_gone_;
  return key;
}

bool Scene::Held::remove(BodyKey key) {
  const auto found = place_of_.find(key);
  if (found == place_of_.end()) return false;
  const std::uint32_t place = found->second;
  const std::uint64_t serial = standing_[place].rep->serial();
  slots_[place].extent.reset();
  if (extents_[serial].expired()) extents_.erase(serial);
  slots_[place].body.reset();
  standing_[place] = {};
  boxes_[place].setEmpty();
  free_.push_back(place);
  place_of_.erase(found);
  ++came_and_gone_;
  return true;
}

bool Scene::Held::move(BodyKey key, const Pose& pose) {
  const auto found = place_of_.find(key);
  if (found == place_of_.end()) return false;
  const std::uint32_t place = found->second;
  standing_[place].pose = pose;
  if (!std::exchange(slots_[place].has_moved, true)) moved_.push_back(place);
  return true;
}

Party Scene::Held::party() {
  work.moved = moved_.size();
  workers_.for_each(moved_.size(), [&](std::size_t k, unsigned) {
    const std::uint32_t place = moved_[k];
    Slot& slot = slots_[place];
    if (slot.body && slot.has_moved) boxes_[place] = slot.extent->in_world(standing_[place].pose, &slot.last);
  });
  for (const std::uint32_t place : moved_) slots_[place].has_moved = false;
  moved_.clear();
  return {boxes_, standing_};
}

std::span<const SceneAnswer> Scene::Held::ask(const Party& a, const Party& b, std::vector<Near>& near,
                                              const CollideRequest& request) {
  std::sort(near.begin(), near.end());
  questions_.clear();
  for (const Near& n : near) questions_.push_back(posed(a, b, n));
  batch_.collide(questions_, request, answers_);
  std::size_t count = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (!is_told(answers_[i])) continue;
    if (told_.size() == count) told_.emplace_back();
    told_[count].a = near[i].key_a;
    told_[count].b = near[i].key_b;
    std::swap(told_[count].result, answers_[i]);  // what was told before is memory for the next answers
    ++count;
  }
  work.near = near.size();
  return std::span<const SceneAnswer>(told_).first(count);
}

std::span<const SceneAnswer> Scene::Held::collide(const CollideRequest& request) {
  constexpr std::size_t kShareThatStays = 8;
  // Each body that comes or goes is carried through the order: of many, sorting is quicker.
  if (std::exchange(came_and_gone_, 0) > slots_.size() / kShareThatStays) sweep_ = {};
  const Party all = party();
  std::vector<Near> near;
  for (const BodyPair& p : sweep_.update(boxes_)) near.push_back(near_of_one(all, p.i, p.j, 0));
  work.swaps = sweep_.work().swaps;
  work.sorted_afresh = sweep_.work().sorted_afresh;
  return ask(all, all, near, request);
}

std::span<const SceneAnswer> Scene::Held::collide(const Party& a, const Party& b,
                                                  const CollideRequest& request) {
  std::vector<Near> near;
  const double touching = 0;
  scene::each_near_pair(a.boxes, b.boxes, touching, [&](std::uint32_t i, std::uint32_t j, double gap) {
    near.push_back(near_of_two(a, b, i, j, gap));
  });
  return ask(a, b, near, request);
}

/// Asks how far pairs are apart, into distances_.
void Scene::Held::measure(const Party& a, const Party& b, std::span<const Near> near,
                          DistanceRequest request) {
  request.within.reset();
  questions_.clear();
  for (const Near& n : near) questions_.push_back(posed(a, b, n));
  batch_.distance(questions_, request, distances_);
}

/// Finds the nearest pair. each_near(limit, see): calls see(near) for the pairs whose boxes are no further apart
/// than `limit`, which see() may lower.
template <class EachNear>
std::optional<SceneDistance> Scene::Held::nearest_of(const Party& a, const Party& b,
                                                     const DistanceRequest& request,
                                                     const EachNear& each_near) {
  // Asks about this many at a time, whatever the number of threads: what they find spares queries about the next.
  constexpr std::size_t kAtATime = 64;
  std::optional<Near> likely;
  double limit = std::numeric_limits<double>::infinity();
  each_near(limit, [&](const Near& n) {
    if (likely && !(n < *likely)) return;
    likely = n;
    limit = n.gap;
  });
  if (!likely) return {};
  std::vector<Near> near = {*likely};
  measure(a, b, near, request);
  SceneDistance best{likely->key_a, likely->key_b, distances_[0]};
  if (!best.result) return best;
  near.clear();
  limit = best.result->upper;
  each_near(limit, [&](const Near& n) { near.push_back(n); });
  std::sort(near.begin(), near.end());
  for (std::size_t asked = 0; asked < near.size(); asked += kAtATime) {
    const double upper = best.result->upper;
    if (upper == 0 || near[asked].gap > upper) break;
    const auto some = std::span(near).subspan(asked, std::min(kAtATime, near.size() - asked));
    measure(a, b, some, request);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const SceneDistance found{some[i].key_a, some[i].key_b, distances_[i]};
      if (!found.result) return found;
      if (found.result->upper < best.result->upper) best = found;
    }
  }
  return best;
}

std::optional<SceneDistance> Scene::Held::nearest(const DistanceRequest& request) {
  const Party all = party();
  return nearest_of(all, all, request, [&](const double& limit, const auto& see) {
    scene::each_near_pair(all.boxes, limit, [&](std::uint32_t i, std::uint32_t j, double gap) {
      see(near_of_one(all, i, j, gap));
    });
  });
}

std::optional<SceneDistance> Scene::Held::nearest(const Party& a, const Party& b,
                                                  const DistanceRequest& request) {
  return nearest_of(a, b, request, [&](const double& limit, const auto& see) {
    scene::each_near_pair(a.boxes, b.boxes, limit, [&](std::uint32_t i, std::uint32_t j, double gap) {
      see(near_of_two(a, b, i, j, gap));
    });
  });
}

namespace {

/// One body as a party.
struct Alone {
  Alone(const Body& body, const Pose& pose)
      : box(world_box(body, pose)), standing{BodyKey{}, &body.rep(), pose} {}
  operator Party() const { return {{&box, 1}, {&standing, 1}}; }

  Box box;
  Standing standing;
};

}  // namespace

Scene::Scene(unsigned threads) : held_(std::make_unique<Held>(threads)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

BodyKey Scene::add(Body body, const Pose& pose) {
  return held_->add(std::move(body), pose);
}
bool Scene::remove(BodyKey key) {
  return held_->remove(key);
}
bool Scene::move(BodyKey key, const Pose& pose) {
  return held_->move(key, pose);
}
std::size_t Scene::size() const {
  return held_->size();
}
bool Scene::has(BodyKey key) const {
  return held_->has(key);
}
const Body& Scene::body(BodyKey key) const {
  return held_->body(key);
}
const Pose& Scene::pose(BodyKey key) const {
  return held_->pose(key);
}
std::vector<BodyKey> Scene::keys() const {
  return held_->keys();
}

std::span<const SceneAnswer> Scene::collide(const CollideRequest& request) {
  return held_->collide(request);
}
std::span<const SceneAnswer> Scene::collide(const Body& body, const Pose& pose,
                                            const CollideRequest& request) {
  return held_->collide(Alone(body, pose), held_->party(), request);
}
std::span<const SceneAnswer> Scene::collide(Scene& other, const CollideRequest& request) {
  const Party others = other.held_->party();
  return held_->collide(held_->party(), others, request);
}

std::optional<SceneDistance> Scene::nearest(const DistanceRequest& request) {
  return held_->nearest(request);
}
std::optional<SceneDistance> Scene::nearest(const Body& body, const Pose& pose,
                                            const DistanceRequest& request) {
  return held_->nearest(Alone(body, pose), held_->party(), request);
}
std::optional<SceneDistance> Scene::nearest(Scene& other, const DistanceRequest& request) {
  const Party others = other.held_->party();
  return held_->nearest(held_->party(), others, request);
}

const Scene::Work& Scene::work() const {
  return held_->work;
}

}  // namespace lrb

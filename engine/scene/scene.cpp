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

/// Whose pairs are asked about: those of one party, or of two.
struct Parties {
  Party a, b;
  bool is_one = false;

  /// Calls see(near) for the pairs whose boxes are no further apart than `limit`, which see() may lower.
  template <class See>
  void each_near(const double& limit, const See& see) const {
    if (is_one)
      each_near_pair(a.boxes, limit,
                     [&](std::uint32_t i, std::uint32_t j, double gap) { see(near_of_one(a, i, j, gap)); });
    else
      each_near_pair(a.boxes, b.boxes, limit, [&](std::uint32_t i, std::uint32_t j, double gap) {
        see(near_of_two(a, b, i, j, gap));
      });
  }

  PosedPair posed(const Near& near) const {
    const Standing &x = a.standing[near.a], &y = b.standing[near.b];
    return {x.rep, x.pose, y.rep, y.pose};
  }
};

/// Returns the pair whose boxes are nearest to each other.
std::optional<Near> nearest_of(const Parties& parties) {
  std::optional<Near> nearest;
  double limit = std::numeric_limits<double>::infinity();
  parties.each_near(limit, [&](const Near& n) {
    if (nearest && !(n < *nearest)) return;
    nearest = n;
    limit = n.gap;
  });
  return nearest;
}

double distance_of(const DistanceResult& found, Apart apart) {
  return apart == Apart::solids ? found.solids_upper() : found.upper;
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

  void reserve(std::size_t bodies);

  /// Return whose pairs are asked about, with boxes as they stand now: those of the scene; of a body from
  /// outside and one of the scene; of the scene and another.
  Parties own();
  Parties with(const Party& outside) { return {outside, party(), false}; }
  Parties with(Held& other);

  std::span<const ScenePair> near(const Parties& parties, double within);
  std::optional<ScenePair> nearest_boxes(const Parties& parties) const;
  std::span<const SceneAnswer> collide(const Parties& parties, const CollideRequest& request);
  std::optional<SceneDistance> nearest(const Parties& parties, const DistanceRequest& request, Apart apart);

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
  void add_places(std::size_t more);
  std::shared_ptr<const BodyExtent> extent_of(const LrbRep& rep);
  Party party();
  std::vector<Near> find_near(const Parties& parties, double within);
  std::vector<Near> sweep(const Party& all);
  void measure(const Parties& parties, std::span<const Near> near, DistanceRequest request);

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

  std::vector<ScenePair> near_;
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

/// Adds places where nobody stands. The broad phase gives up its order when it sees more boxes than before.
void Scene::Held::add_places(std::size_t more) {
  const std::size_t before = slots_.size();
  for (std::size_t i = before + more; i-- > before;) free_.push_back(static_cast<std::uint32_t>(i));
  slots_.resize(before + more);
  standing_.resize(before + more);
  boxes_.resize(before + more);
}

void Scene::Held::reserve(std::size_t bodies) {
  if (bodies > slots_.size()) add_places(bodies - slots_.size());
}

std::uint32_t Scene::Held::free_place() {
  constexpr std::size_t kFew = 16;
  if (free_.empty()) add_places(std::max(kFew, slots_.size() / 2));
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

Parties Scene::Held::own() {
  const Party all = party();
  return {all, all, true};
}

Parties Scene::Held::with(Held& other) {
  const Party others = other.party();
  return {party(), others, false};
}

/// Finds the pairs of a scene whose boxes meet, by the broad phase.
std::vector<Near> Scene::Held::sweep(const Party& all) {
  constexpr std::size_t kShareThatStays = 8;
  // Each body that comes or goes is carried through the order: of many, sorting is quicker.
  if (std::exchange(came_and_gone_, 0) > slots_.size() / kShareThatStays) sweep_ = {};
  std::vector<Near> near;
  for (const BodyPair& p : sweep_.update(all.boxes)) near.push_back(near_of_one(all, p.i, p.j, 0));
  work.broad_phase = sweep_.work();
  return near;
}

std::vector<Near> Scene::Held::find_near(const Parties& parties, double within) {
  std::vector<Near> near;
  if (parties.is_one && !(within > 0))
    near = sweep(parties.a);
  else
    parties.each_near(within, [&](const Near& n) { near.push_back(n); });
  std::sort(near.begin(), near.end());
  work.near = near.size();
  return near;
}

std::span<const ScenePair> Scene::Held::near(const Parties& parties, double within) {
  near_.clear();
  for (const Near& n : find_near(parties, within)) near_.push_back({n.key_a, n.key_b, n.gap});
  return near_;
}

std::optional<ScenePair> Scene::Held::nearest_boxes(const Parties& parties) const {
  const std::optional<Near> found = nearest_of(parties);
  if (!found) return {};
  return ScenePair{found->key_a, found->key_b, found->gap};
}

std::span<const SceneAnswer> Scene::Held::collide(const Parties& parties, const CollideRequest& request) {
  const std::vector<Near> near = find_near(parties, 0);
  questions_.clear();
  for (const Near& n : near) questions_.push_back(parties.posed(n));
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
  return std::span<const SceneAnswer>(told_).first(count);
}

/// Asks how far pairs are apart, into distances_.
void Scene::Held::measure(const Parties& parties, std::span<const Near> near, DistanceRequest request) {
  request.within.reset();
  questions_.clear();
  for (const Near& n : near) questions_.push_back(parties.posed(n));
  batch_.distance(questions_, request, distances_);
}

std::optional<SceneDistance> Scene::Held::nearest(const Parties& parties, const DistanceRequest& request,
                                                  Apart apart) {
  // Asks about this many at a time, whatever the number of threads: what they find spares queries about the
  // next.
  constexpr std::size_t kAtATime = 64;
  const std::optional<Near> likely = nearest_of(parties);
  if (!likely) return {};
  measure(parties, std::span(&*likely, 1), request);
  SceneDistance best{likely->key_a, likely->key_b, distances_[0]};
  if (!best.result) return best;
  const std::vector<Near> near = find_near(parties, distance_of(*best.result, apart));
  for (std::size_t asked = 0; asked < near.size(); asked += kAtATime) {
    const double upper = distance_of(*best.result, apart);
    if (upper == 0 || near[asked].gap > upper) break;
    const auto some = std::span(near).subspan(asked, std::min(kAtATime, near.size() - asked));
    measure(parties, some, request);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const SceneDistance found{some[i].key_a, some[i].key_b, distances_[i]};
      if (!found.result) return found;
      if (distance_of(*found.result, apart) < distance_of(*best.result, apart)) best = found;
    }
  }
  return best;
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

void Scene::reserve(std::size_t bodies) {
  held_->reserve(bodies);
}
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

std::span<const ScenePair> Scene::near(double within) {
  return held_->near(held_->own(), within);
}
std::span<const ScenePair> Scene::near(const Body& body, const Pose& pose, double within) {
  const Alone alone(body, pose);
  return held_->near(held_->with(alone), within);
}
std::span<const ScenePair> Scene::near(Scene& other, double within) {
  return held_->near(held_->with(*other.held_), within);
}

std::optional<ScenePair> Scene::nearest_boxes() {
  return held_->nearest_boxes(held_->own());
}
std::optional<ScenePair> Scene::nearest_boxes(const Body& body, const Pose& pose) {
  const Alone alone(body, pose);
  return held_->nearest_boxes(held_->with(alone));
}
std::optional<ScenePair> Scene::nearest_boxes(Scene& other) {
  return held_->nearest_boxes(held_->with(*other.held_));
}

std::span<const SceneAnswer> Scene::collide(const CollideRequest& request) {
  return held_->collide(held_->own(), request);
}
std::span<const SceneAnswer> Scene::collide(const Body& body, const Pose& pose,
                                            const CollideRequest& request) {
  const Alone alone(body, pose);
  return held_->collide(held_->with(alone), request);
}
std::span<const SceneAnswer> Scene::collide(Scene& other, const CollideRequest& request) {
  return held_->collide(held_->with(*other.held_), request);
}

std::optional<SceneDistance> Scene::nearest(const DistanceRequest& request, Apart apart) {
  return held_->nearest(held_->own(), request, apart);
}
std::optional<SceneDistance> Scene::nearest(const Body& body, const Pose& pose,
                                            const DistanceRequest& request, Apart apart) {
  const Alone alone(body, pose);
  return held_->nearest(held_->with(alone), request, apart);
}
std::optional<SceneDistance> Scene::nearest(Scene& other, const DistanceRequest& request, Apart apart) {
  return held_->nearest(held_->with(*other.held_), request, apart);
}

const Scene::Work& Scene::work() const {
  return held_->work;
}

}  // namespace lrb

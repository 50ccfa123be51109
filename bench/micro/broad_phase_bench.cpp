// The broad phase beside the managers of FCL and Bullet: 1,000 and 10,000 boxes of which all or 1 % move in a
// step. Each step updates the boxes and lists the pairs that intersect. Before timing, the pairs of every
// manager are compared with lrbscope's. "moved": only the boxes that moved are passed on.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#ifdef LRB_HAS_FCL
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/geometry/shape/box.h>
#endif
#ifdef LRB_HAS_BULLET
#include <btBulletCollisionCommon.h>
#endif

#include <lrbscope/broad_phase.hpp>

using namespace lrb;

namespace {

using Box = Eigen::AlignedBox3d;
using Moved = std::vector<std::uint32_t>;
using Pairs = std::vector<BodyPair>;

/// Boxes in a room, which bounce off its walls. Coordinates and sizes are multiples of 2^-10, so that floats
/// represent them and every manager has the same boxes.
class Room {
 public:
  Room(std::uint32_t count, double share) : moved_count_(static_cast<std::uint32_t>(share * count)) {
    // Seven boxes that overlap a box, as in a dense crowd.
    side_ = std::cbrt(count * 8.0 / 7);
    std::uniform_real_distribution<double> place(0, side_), size(0.6, 1.4), speed(-0.02, 0.02);
    const auto vector = [&](auto& range) {
      return on_grid({range(random_), range(random_), range(random_)});
    };
    for (std::uint32_t i = 0; i < count; ++i) {
      const Eigen::Vector3d low = vector(place);
      boxes_.emplace_back(low, low + vector(size));
      speeds_.push_back(vector(speed));
    }
  }

  /// Moves boxes, the next ones in turn, and returns them, ascending.
  const Moved& step() {
    moved_.clear();
    const auto count = static_cast<std::uint32_t>(boxes_.size());
    for (std::uint32_t k = 0; k < moved_count_; ++k) moved_.push_back((first_ + k) % count);
    std::sort(moved_.begin(), moved_.end());
    first_ = (first_ + moved_count_) % count;
    for (const std::uint32_t i : moved_) {
      for (int k = 0; k < 3; ++k)
        if (boxes_[i].min()[k] + speeds_[i][k] < 0 || boxes_[i].min()[k] + speeds_[i][k] > side_)
          speeds_[i][k] = -speeds_[i][k];
      boxes_[i].translate(speeds_[i]);
    }
    return moved_;
  }

  const std::vector<Box>& boxes() const { return boxes_; }

 private:
  static Eigen::Vector3d on_grid(const Eigen::Vector3d& x) {
    constexpr double kGrid = 1024;
    return (x * kGrid).array().round() / kGrid;
  }

  std::mt19937_64 random_{5};
  std::uint32_t moved_count_, first_ = 0;
  double side_;
  std::vector<Box> boxes_;
  std::vector<Eigen::Vector3d> speeds_;
  Moved moved_;
};

struct Complete {
  explicit Complete(const std::vector<Box>& boxes) { sweep.update(boxes); }
  const Pairs& update(const std::vector<Box>& boxes, const Moved&) { return sweep.update(boxes); }
  SweepAndPrune sweep;
};

struct Incremental {
  explicit Incremental(const std::vector<Box>& boxes) { sweep.update(boxes); }
  const Pairs& update(const std::vector<Box>& boxes, const Moved& moved) {
    return sweep.update(boxes, moved);
  }
  SweepAndPrune sweep;
};

[[maybe_unused]] BodyPair ordered(std::uint32_t i, std::uint32_t j) {
  return {std::min(i, j), std::max(i, j)};
}

#ifdef LRB_HAS_FCL
/// A manager of FCL. The bodies are boxes without rotation, so that FCL's AABBs are the boxes.
template <class Manager>
class Fcl {
 public:
  explicit Fcl(const std::vector<Box>& boxes) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      objects_.push_back(std::make_unique<fcl::CollisionObjectd>(
          std::make_shared<fcl::Boxd>(boxes[i].sizes()), fcl::Transform3d::Identity()));
      objects_.back()->setUserData(reinterpret_cast<void*>(i));
      place(i, boxes[i]);
      manager_.registerObject(objects_.back().get());
    }
    manager_.setup();
  }

  const Pairs& update(const std::vector<Box>& boxes, const Moved& moved) {
    changed_.clear();
    for (const std::uint32_t i : moved) {
      place(i, boxes[i]);
      changed_.push_back(objects_[i].get());
    }
    if (moved.size() == boxes.size())
      manager_.update();
    else
      manager_.update(changed_);
    pairs_.clear();
    manager_.collide(&pairs_, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* pairs) {
      // Some managers report boxes that overlap on one axis only.
      if (a->getAABB().overlap(b->getAABB())) static_cast<Pairs*>(pairs)->push_back(ordered(id(a), id(b)));
      return false;
    });
    return pairs_;
  }

 private:
  static std::uint32_t id(const fcl::CollisionObjectd* object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object->getUserData()));
  }
  void place(std::size_t i, const Box& box) {
    objects_[i]->setTranslation(box.center());
    objects_[i]->computeAABB();
  }

  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::vector<fcl::CollisionObjectd*> changed_;
  Manager manager_;
  Pairs pairs_;
};
#endif

#ifdef LRB_HAS_BULLET
/// A broad phase of Bullet. Its cache of pairs also contains pairs of enlarged boxes.
template <class Broadphase>
class Bullet {
 public:
  explicit Bullet(const std::vector<Box>& boxes, std::unique_ptr<Broadphase> broadphase)
      : broadphase_(std::move(broadphase)), numbers_(boxes.size()) {
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
      numbers_[i] = i;
      proxies_.push_back(broadphase_->createProxy(vector(boxes[i].min()), vector(boxes[i].max()), 0,
                                                  &numbers_[i], 1, 1, nullptr));
    }
  }
  ~Bullet() {
    for (btBroadphaseProxy* proxy : proxies_) broadphase_->destroyProxy(proxy, nullptr);
  }
  Bullet(const Bullet&) = delete;
  Bullet& operator=(const Bullet&) = delete;

  const Pairs& update(const std::vector<Box>& boxes, const Moved& moved) {
    for (const std::uint32_t i : moved)
      broadphase_->setAabb(proxies_[i], vector(boxes[i].min()), vector(boxes[i].max()), nullptr);
    broadphase_->calculateOverlappingPairs(nullptr);
    pairs_.clear();
    const btBroadphasePairArray& found = broadphase_->getOverlappingPairCache()->getOverlappingPairArray();
    for (int k = 0; k < found.size(); ++k) {
      const btBroadphaseProxy *a = found[k].m_pProxy0, *b = found[k].m_pProxy1;
      if (TestAabbAgainstAabb2(a->m_aabbMin, a->m_aabbMax, b->m_aabbMin, b->m_aabbMax))
        pairs_.push_back(ordered(number(a), number(b)));
    }
    return pairs_;
  }

 private:
  static btVector3 vector(const Eigen::Vector3d& x) {
    return {static_cast<btScalar>(x.x()), static_cast<btScalar>(x.y()), static_cast<btScalar>(x.z())};
  }
  static std::uint32_t number(const btBroadphaseProxy* proxy) {
    return *static_cast<const std::uint32_t*>(proxy->m_clientObject);
  }

  std::unique_ptr<Broadphase> broadphase_;
  std::vector<std::uint32_t> numbers_;
  std::vector<btBroadphaseProxy*> proxies_;
  Pairs pairs_;
};
#endif

/// Returns true if pairs are those of `all`, apart from boxes that only touch, which some managers omit.
bool are_pairs(const Pairs& pairs, const Pairs& all, const std::vector<Box>& boxes) {
  Pairs missing;
  std::set_difference(all.begin(), all.end(), pairs.begin(), pairs.end(), std::back_inserter(missing));
  return std::includes(all.begin(), all.end(), pairs.begin(), pairs.end()) &&
         std::all_of(missing.begin(), missing.end(), [&](const BodyPair& p) {
           return (boxes[p.i].intersection(boxes[p.j]).sizes().array() == 0).any();
         });
}

/// make(boxes) returns a manager.
template <class Make>
void add(const std::string& name, std::uint32_t count, double share, const Make& make) {
  const std::string what =
      std::to_string(count) + " boxes, " + (share == 1 ? "all" : "1 %") + " move/" + name;
  benchmark::RegisterBenchmark(what.c_str(), [=](benchmark::State& state) {
    Room room(count, share), reference_room(count, share);
    const auto manager = make(room.boxes());
    Complete reference(reference_room.boxes());
    constexpr int kChecked = 20;
    for (int i = 0; i < kChecked; ++i) {
      const Moved& moved = room.step();
      Pairs pairs = manager->update(room.boxes(), moved);
      std::sort(pairs.begin(), pairs.end());
      const Moved& same = reference_room.step();
      if (!are_pairs(pairs, reference.update(reference_room.boxes(), same), room.boxes()))
        return state.SkipWithError("pairs are missing or wrong");
    }
    std::size_t found = 0, steps = 0;
    for (auto _ : state) {
      state.PauseTiming();
      const Moved& moved = room.step();
      state.ResumeTiming();
      found += manager->update(room.boxes(), moved).size();
      ++steps;
    }
    state.counters["pairs"] = static_cast<double>(found) / static_cast<double>(steps);
  })->Unit(benchmark::kMicrosecond);
}

template <class Manager>
auto plain() {
  return [](const std::vector<Box>& boxes) { return std::make_unique<Manager>(boxes); };
}

void add_all(std::uint32_t count, double share) {
  add("lrbscope", count, share, plain<Complete>());
  add("lrbscope, moved", count, share, plain<Incremental>());
#ifdef LRB_HAS_FCL
  add("FCL, dynamic AABB tree, moved", count, share, plain<Fcl<fcl::DynamicAABBTreeCollisionManagerd>>());
  add("FCL, dynamic AABB tree in an array, moved", count, share,
      plain<Fcl<fcl::DynamicAABBTreeCollisionManager_Arrayd>>());
  add("FCL, sweep and prune, moved", count, share, plain<Fcl<fcl::SaPCollisionManagerd>>());
#endif
#ifdef LRB_HAS_BULLET
  add("Bullet, dynamic AABB tree, moved", count, share, [](const std::vector<Box>& boxes) {
    return std::make_unique<Bullet<btDbvtBroadphase>>(boxes, std::make_unique<btDbvtBroadphase>());
  });
  add("Bullet, sweep and prune, moved", count, share, [](const std::vector<Box>& boxes) {
    Box all;
    for (const Box& box : boxes) all.extend(box);
    constexpr float kMargin = 2;
    const auto corner = [](const Eigen::Vector3d& x, float by) {
      const Eigen::Vector3f f = x.cast<float>();
      return btVector3(f.x() + by, f.y() + by, f.z() + by);
    };
    return std::make_unique<Bullet<bt32BitAxisSweep3>>(
        boxes, std::make_unique<bt32BitAxisSweep3>(corner(all.min(), -kMargin), corner(all.max(), kMargin),
                                                   static_cast<unsigned>(boxes.size()) + 1));
  });
#endif
}

}  // namespace

int main(int argc, char** argv) {
  constexpr double kFew = 0.01;
  for (const std::uint32_t count : {1000u, 10000u})
    for (const double share : {1.0, kFew}) add_all(count, share);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}

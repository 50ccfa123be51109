#pragma once
/// Simplifies the front of a 3D body by one queue of outward edge collapses.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/builders.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/embed_check.hpp"
#include "engine/construct/front_mesh.hpp"
#include "engine/construct/half_spaces.hpp"
#include "engine/construct/open_front.hpp"
#include "engine/construct/outward_collapse.hpp"
#include "engine/construct/surface_walk.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::construct {

// A queue of edge collapses, about in the order of their costs.

struct QueuedCollapse {
  float cost;
  std::uint32_t u, v;
  bool onto_v;  ///< u moves onto v; otherwise both become one new vertex
};

/// Buckets by cost, two for each power of two. Within a bucket the last in is the first out: successive
/// collapses are then often neighbours, which the caches like. (A heap takes 10 to 15 % more time for a whole
/// build; finer buckets and other orders within a bucket are no better.)
class CollapseQueue {
 public:
  /// `unit`: typical large cost; only the 60 powers of two below it and a few above have their own buckets.
  explicit CollapseQueue(double unit) : per_unit_(static_cast<float>(1 / unit)), buckets_(2 * kOctaves) {}

  bool empty() const { return size_ == 0; }
  std::uint32_t bucket_of(float cost) const {
    constexpr std::uint32_t kLowest = (127 - kOctaves + 8) << 23;
    const auto bits = std::bit_cast<std::uint32_t>(cost * per_unit_);
    return bits <= kLowest ? 0 : std::min(2 * kOctaves - 1, (bits - kLowest) >> 22);
  }
  /// The bucket of the collapse popped last.
  std::uint32_t current() const { return current_; }

  void push(const QueuedCollapse& c) {
    const std::uint32_t b = bucket_of(c.cost);
    buckets_[b].push_back(c);
    current_ = std::min(current_, b);
    ++size_;
  }
  QueuedCollapse pop() {
    while (buckets_[current_].empty()) ++current_;
    const QueuedCollapse c = buckets_[current_].back();
    buckets_[current_].pop_back();
    --size_;
    return c;
  }

 private:
  static constexpr std::uint32_t kOctaves = 60;
  float per_unit_;
  std::vector<std::vector<QueuedCollapse>> buckets_;
  std::uint32_t current_ = 0;
  std::size_t size_ = 0;
};

/// Simplifies the front level by level. At a level, the cheapest collapse is made until none is left, or none
/// within the level's limit on the deviation from the body. A component never has more than a certain number
/// of faces beneath it, so that collapses leave many components, whose borders the queue finds by itself.
/// Those whose lids are simple enough become regions; the others stay open and go on at the next level, so
/// that few collapses are undone.
class FrontSimplifier {
 public:
  /// `frozen` (real faces): those that are never covered. `component_boxes`: see LidProof. `bounds`: new
  /// vertices stay inside.
  FrontSimplifier(FrontMesh& front, ComplexBuilder& complex, const std::vector<bool>& frozen,
                  const std::vector<Eigen::AlignedBox3d>& component_boxes, const BodyBounds& bounds,
                  const BuildOptions& options, PassCounter& passes);

  /// Makes tightly fitting levels, each with a larger limit on the deviation, until the front has no more
  /// than `least` triangles. The front must still be the mesh itself. Calls before_level(), which may change
  /// the bounds, before each level.
  void fit(std::uint32_t least, const std::function<void()>& before_level);
  /// Makes levels without a limit on the deviation, until two gain too little.
  void simplify(const std::function<void()>& before_level);

 private:
  using Index = OpenFront::Index;
  using Star = OpenFront::Star;
  using Union = OpenFront::Union;
  using Vector3 = Eigen::Vector3d;

  /// A vertex with its faces: the common part of the proposals for its edges.
  struct Hub {
    struct Spoke {
      Index face, to;  ///< the face w, to, next
    };
    Index w;
    Few<Spoke, 2 * OpenFront::kMaxRim> spokes;
    Vector3 outward, rim_sum;
    double offset, area;
    Union united;
  };

  void level(BuildStage stage, double limit, double worth);
  void collapse_all();
  std::vector<Index> along_curve() const;
  // Proposals.
  bool load_hub(Index w);
  void propose_around(Index w);
  void propose(std::size_t spoke);
  bool propose_onto(Index u, Index v);
  bool may_try(Index f, int edge) const;
  // Evaluation.
  float excess(const Star& star, const Vector3& w);
  int steps_along(const SurfaceWalk::Point& a, const SurfaceWalk::Point& b) const;
  void unite(const Star& star, Union& united) const;
  bool may_unite(const Union& united) const;
  void refuse(CapVerdict verdict, float wake);
  void evaluate(const QueuedCollapse& c);
  // Commits.
  void commit(double worth);
  CapVerdict finish(OpenFront::Lid& lid, double worth);
  bool cover_polygons(OpenFront::Lid& lid);
  void put_on(const OpenFront::Lid& lid);
  void notify(const OpenFront::Lid& lid, CapVerdict verdict) const;

  FrontMesh& front_;
  ComplexBuilder& complex_;
  const BuildOptions& options_;
  PassCounter& passes_;
  AabbTree tree_;  ///< over the committed front
  OpenFront open_;
  OutwardCollapse geometry_;
  std::optional<SurfaceWalk> body_;  ///< while fitting
  LidProof proof_;
  const std::size_t real_faces_;
  const std::uint32_t floor_limit_;  ///< maximum number of faces beneath a component
  std::uint32_t max_floor_ = 0;      ///< the same at the current level
  CollapseQueue queue_;
  Random random_;
  float limit_ = 0;  ///< on the deviation; OpenFront::unit()
  Hub hub_;
  Star star_, scratch_;
  Union united_, scratch_union_;
  Few<Index, 2 * OpenFront::kMaxRim> others_;
  std::vector<FrontMesh::Slot> new_hints_;
  float new_off_ = 0;
  std::vector<bool> on_rim_;
};

}  // namespace lrb::construct

#pragma once
/// Makes the tightly fitting fronts of a 3D body: by one queue of outward edge collapses.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/builders.hpp"
#include "engine/construct/collapse_queue.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/front_mesh.hpp"
#include "engine/construct/half_spaces.hpp"
#include "engine/construct/lid_proof.hpp"
#include "engine/construct/open_front.hpp"
#include "engine/construct/surface_walk.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::construct {

/// Simplifies the front level by level, each with a larger limit on the deviation from the body. At a level,
/// the cheapest collapse within the limit is made until none is left. A component never has more than a
/// certain number of faces beneath it, so that collapses leave many components, whose borders the queue finds
/// by itself. Those whose lids are simple enough become regions; the others stay open and go on at the next
/// level, so that few collapses are undone.
class FrontFitter {
 public:
  /// `front`: still the mesh itself. `tree`: over it; may be rebuilt. `frozen` (real faces): those that are
  /// never covered. `component_boxes`: see EmbedCheck.
  FrontFitter(FrontMesh& front, std::optional<AabbTree>& tree, ComplexBuilder& complex,
              const std::vector<bool>& frozen, const std::vector<Eigen::AlignedBox3d>& component_boxes,
              const BodyBounds& bounds, const BuildOptions& options, PassCounter& passes);

  /// Makes levels until the front has no more than `least` triangles. Calls before_round(), which may change
  /// the bounds, before each round.
  void run(std::uint32_t least, const std::function<void()>& before_round);

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

  void simplify();
  std::vector<Index> along_curve() const;
  // Proposals.
  bool load_hub(Index w);
  void propose_around(Index w);
  void propose(std::size_t spoke);
  bool propose_onto(Index u, Index v);
  bool may_try(Index f, int edge) const;
  // Evaluation.
  bool is_in_front(const Star& star, const Vector3& p) const;
  bool clears_neighbours(const Star& star) const;
  bool place(const Star& star, Vector3& w);
  double volume_under(const Star& star, const Vector3& w, double& area) const;
  double shape_cost(const Star& star, const Vector3& w, double area) const;
  float excess(const Star& star, const Vector3& w);
  int steps_along(const SurfaceWalk::Point& a, const SurfaceWalk::Point& b) const;
  bool folds(const Star& star, const Vector3& w) const;
  bool is_strictly_in_front(const Star& star, const Vector3& w) const;
  void unite(const Star& star, Union& united) const;
  void refuse(CapVerdict verdict, float wake);
  void work_off();
  void evaluate(const QueuedCollapse& c);
  // Commits.
  void commit(double worth);
  CapVerdict finish(OpenFront::Lid& lid, double worth);
  bool cover_polygons(OpenFront::Lid& lid);
  void put_on(const OpenFront::Lid& lid);
  void notify(const OpenFront::Lid& lid, CapVerdict verdict) const;

  FrontMesh& front_;
  std::optional<AabbTree>& tree_;
  ComplexBuilder& complex_;
  const BodyBounds& bounds_;
  const BuildOptions& options_;
  PassCounter& passes_;
  Eigen::AlignedBox3d box_;  ///< of the body
  double size_;              ///< its largest side
  OpenFront open_;
  SurfaceWalk body_;
  LidProof proof_;
  std::uint32_t max_floor_;  ///< maximum number of faces beneath a component
  CollapseQueue queue_;
  Random random_;
  double limit_ = 0;  ///< on the deviation; mesh units
  Hub hub_;
  Star star_, scratch_;
  Union united_, scratch_union_;
  Few<Index, 2 * OpenFront::kMaxRim> others_;
  std::vector<HalfSpace> half_spaces_;
  std::vector<FrontMesh::Slot> new_hints_;
  float new_off_ = 0;
  std::vector<bool> on_rim_;
};

}  // namespace lrb::construct

// Building of LRB-reps, and the builder for 3D bodies (progressive hulls); the one for 2D bodies is in
// chain_builder.cpp.
//
// On request, faces in a common plane first become regions without volume (planar_patches.hpp).
// The builder works on the current front, at first the mesh itself, and adds one level after the other:
// 1. One queue of edge collapses simplifies the entire front outward. It is cut into components by a cap on
//    the number of faces beneath each (front_simplifier.hpp).
// 2. A component whose lid is simple enough is proven, exactly, to be disjoint from all other faces
//    (embed_check.hpp). The new front is then embedded again and encloses the old one, so that all faces of
//    the complex intersect only in shared vertices and edges.
// 3. The space between floor and lid becomes a region (front_update.hpp). The lid is part of the front of the
//    next level.
//
// The first levels fit tightly: their deviation from the body is limited. When levels gain too little,
// concavities are bridged, and finally one wrapper of few faces is put around all of them (closing.hpp).

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/builders.hpp"
#include "engine/construct/closing.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/front_mesh.hpp"
#include "engine/construct/front_simplifier.hpp"
#include "engine/construct/half_spaces.hpp"
#include "engine/construct/planar_patches.hpp"
#include "engine/construct/whole_fronts.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/self_intersections.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/disjoint_sets.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb::construct {
namespace {

using Slot = FrontMesh::Slot;
using Corner = FrontMesh::Corner;

}  // namespace

std::vector<std::vector<std::uint32_t>> find_holders(const Mesh& mesh,
                                                     const std::vector<Component>& components) {
  std::vector<std::uint32_t> component_of(mesh.face_count(), kNull);
  for (std::uint32_t c = 0; c < components.size(); ++c)
    for (const FaceId f : components[c].faces) component_of[f] = c;
  // One ray per point answers for all components at once.
  const SideFinder finder(mesh, std::move(component_of));
  // Vertices on another component's surface decide nothing: try the next face, up to this many.
  constexpr std::size_t kTries = 64;
  std::vector<std::vector<std::uint32_t>> holders(components.size());
  for (std::uint32_t c = 0; c < components.size(); ++c) {
    const auto& faces = components[c].faces;
    holders[c] = finder.around(c, [&](std::size_t i) {
      return i < std::min(kTries, faces.size()) ? &mesh.vertices[mesh.face(faces[i])[0]] : nullptr;
    });
    // The box of a container contains that of the other. This excludes most components that merely cross.
    std::erase_if(holders[c],
                  [&](std::uint32_t h) { return !components[h].box.contains(components[c].box); });
  }
  return holders;
}

namespace {

// Finds the faces of a self-intersecting body in front of which is not the outside:
// 1. Connect the triangles that intersect nothing into sheets. No sheet crosses a surface, so the winding
//    number of the surface is the same everywhere in front of it.
// 2. Compute it at one vertex of each sheet, by an exact ray.
// 3. A sheet whose number is not 0 is buried.

/// Returns the sign of the x coordinate of a triangle's normal. Exact.
int facing_x(const FrontMesh& front, Slot s) {
  const auto& v = front[s].v;
  // The coordinates y and z.
  return exact::orient2d(front.x(v[0]).data() + 1, front.x(v[1]).data() + 1, front.x(v[2]).data() + 1);
}

/// Returns the winding number of the front just in front of the triangles around v, which intersect no
/// others. Returns nullopt if these face both to +x and to -x, or if another triangle touches v.
std::optional<int> winding_in_front(const FrontMesh& front, const AabbTree& tree, Corner v) {
  // Step 1: does the ray from v to +x start in front of the triangles around v, or behind them?
  const Eigen::Vector3d& p = front.x(v);
  int side = 0;
  bool is_decided = true;
  front.for_each_around(v, [&](Slot s, int i) {
    if (const int facing = facing_x(front, s); facing != 0) {
      is_decided &= side != -facing;
      side = facing;
      return;
    }
    // A triangle parallel to the ray must not contain it.
    for (int k = 1; k < 3; ++k) is_decided &= front.x(front[s].v[(i + k) % 3]).x() <= p.x();
  });
  if (!is_decided || side == 0) return std::nullopt;
  // Step 2: where the ray leaves the surface, the winding number falls by 1; far away it is 0.
  int winding = side > 0 ? 0 : -1;
  const Eigen::Vector3d far(std::numeric_limits<double>::infinity(), p.y(), p.z());
  tree.for_each_in(Eigen::AlignedBox3d(p, far), [&](Slot s) {
    const auto& t = front[s].v;
    if (t[0] == v || t[1] == v || t[2] == v) return;
    const double* const triangle[3] = {front.x(t[0]).data(), front.x(t[1]).data(), front.x(t[2]).data()};
    const exact::RayHit hit = exact::ray_crosses(p.data(), triangle);
    if (hit == exact::RayHit::crosses) winding += facing_x(front, s);
    is_decided &= hit != exact::RayHit::on_face;
  });
  return is_decided ? std::optional(winding) : std::nullopt;
}

/// Returns the faces of a mesh that crosses itself in front of which is not the outside: they are in another
/// component, in another part of their own, or turned inward. `meeting`: the faces that intersect others in
/// more than shared vertices and edges, ascending; they are not among those returned. `front`: the mesh
/// itself.
///
/// A cap over such faces would be inside another part of the body, where no front stops it, and could pass
/// through the faces under that part's caps.
std::vector<FaceId> find_buried(const FrontMesh& front, const std::vector<FaceId>& meeting) {
  if (meeting.empty()) return {};
  const auto meets = [&](Slot s) {
    return std::binary_search(meeting.begin(), meeting.end(), front[s].face);
  };
  // Step 1. Intersecting triangles are the borders of sheets.
  DisjointSets sheets(front.slot_count());  // connected over edges
  for (Slot s = 0; s < front.slot_count(); ++s)
    for (const Slot t : front[s].across)
      if (!meets(s) && !meets(t)) sheets.join(s, t);
  // Step 2. A sheet that was not decided is tried again at its next triangle.
  enum class SheetKind : std::uint8_t { unknown, free, buried };
  const AabbTree tree(front);
  const auto look_at = [&](Slot s) {
    for (const Corner v : front[s].v) {
      bool is_inner = true;
      front.for_each_around(v, [&](Slot t, int) { is_inner &= !meets(t); });
      if (!is_inner) continue;
      if (const auto winding = winding_in_front(front, tree, v))
        return *winding == 0 ? SheetKind::free : SheetKind::buried;
    }
    return SheetKind::unknown;
  };
  std::vector<SheetKind> known(front.slot_count(), SheetKind::unknown);  // at a sheet's leader
  for (Slot s = 0; s < front.slot_count(); ++s)
    if (SheetKind& sheet = known[sheets.leader(s)]; !meets(s) && sheet == SheetKind::unknown)
      sheet = look_at(s);
  // Step 3. Undecided sheets count as buried: covering them could not be proven safe.
  std::vector<FaceId> buried;
  for (Slot s = 0; s < front.slot_count(); ++s)
    if (!meets(s) && known[sheets.leader(s)] != SheetKind::free) buried.push_back(front[s].face);
  return buried;
}

/// kFrontSwell where regions have few lids (BuildOptions::max_lids). Larger: fewer and smaller last regions,
/// and a looser outermost wrapper (measured on one body: 1.43 times the convex hull's volume at 0.02, 1.48 at
/// 0.05, 1.67 at 0.1).
constexpr double kFewLidsSwell = 0.05;

/// Builds the regions of a 3D body, level by level:
/// 1. Find the surfaces that bound voids, and the faces that must never be covered.
/// 2. Fitted levels of limited deviation (unless lean), then levels without a limit, until there are few
/// enough outer faces: FrontSimplifier.
/// 3. Bridge concavities, fill voids, and close with a wrapper if there are still too many outer faces.
class CollapseBuilder : WholeFronts<FrontMesh> {
 public:
  CollapseBuilder(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options)
      : WholeFronts(mesh, meeting, options),
        workers_(options.threads),
        bounds_(mesh.vertices, options.max_lids > 0 ? kFewLidsSwell : kFrontSwell) {
    // Faces in front of which is not the outside are not covered either.
    for (const FaceId f : find_buried(front_, meeting)) frozen_[f] = true;
    if (options.merge_planes) merge_planes(mesh);
  }

  LrbData run() {
    {
      FrontSimplifier simplifier = make_simplifier();
      if (!options_.lean) simplifier.fit(kFitDownTo, [&] { plan_polytope_from(kFittedPolytopeFrom); });
      simplifier.simplify([&] { plan_polytope_from(kPolytopeFrom); });
    }
    if (outer_size() > options_.max_outer_faces && bridge())
      make_simplifier().simplify([&] { plan_polytope_from(kPolytopeFrom); });
    return finish(options_.max_outer_faces);
  }

 private:
  std::vector<Eigen::Vector3d> outer_points() const override {
    std::vector<Eigen::Vector3d> points;
    for (Corner v = 0; v < front_.point_count(); ++v)
      if (front_.degree(v) > 0 && is_outer(front_.any_slot(v))) points.push_back(front_.x(v));
    return points;
  }
  Mesh wrapper_around(std::span<const Eigen::Vector3d> points) override {
    return enclosing_polytope(points, options_.max_outer_faces, kPolytopeDistance, workers_);
  }
  bool wrapper_holds(const Eigen::Vector3d& point) const override { return holds(wrapper_, point); }

  void merge_planes(const Mesh& mesh) {
    const MergedFaces merged = merge_coplanar(mesh, frozen_, kPlanarTriangles);
    if (merged.floors.empty()) return;
    passes_.report_begin(BuildStage::merge, front_.triangle_count());
    for (const auto& floor : merged.floors) {
      const RegionId region = complex_.add_region(passes_.layer());
      for (const FaceId f : floor) complex_.set_outer_cell(f, region);
    }
    std::vector<FaceId> numbers;
    std::vector<std::uint32_t> lids(complex_.region_count());
    for (FaceId f = 0; f < merged.mesh.face_count(); ++f) {
      const auto& [face, region] = merged.origin[f];
      if (region != kNull) ++lids[region];
      numbers.push_back(
          region == kNull ? face : complex_.add_pseudo_face(merged.mesh.face(f), RegionId(region), kOutside));
    }
    front_ = FrontMesh(merged.mesh, numbers);
    for (RegionId r(0); options_.probe && r < lids.size(); ++r) {
      const auto covered = static_cast<std::uint32_t>(merged.floors[r].size());
      options_.probe->patch({mesh.face(merged.floors[r][0])[0], covered, 0});
      options_.probe->cap({lids[r], covered, CapVerdict::accepted, false, 0});
      options_.probe->region(r);
    }
    passes_.report_end({.front_faces = front_.triangle_count()});
    end_pass();
  }

  FrontSimplifier make_simplifier() {
    return {front_, complex_, frozen_, component_boxes_, bounds_, options_, passes_};
  }

  /// Plans the outermost wrapper as soon as the front is simple enough: from now on it stays inside. Not
  /// where lids are limited: the front could no longer be simplified in small regions.
  void plan_polytope_from(std::uint32_t triangles) {
    if (options_.max_lids == 0 && front_.triangle_count() <= triangles) plan_polytope();
  }

  bool bridge() {
    passes_.report_begin(BuildStage::bridge, front_.triangle_count());
    const bool accepted = bridge_pockets();
    passes_.report_end({.front_faces = front_.triangle_count()});
    if (!accepted) return false;
    end_pass();
    return true;
  }

  bool bridge_pockets() {
    // The convex hull of n points in one plane takes O(n^2) steps.
    for (Slot s = 0; s < front_.slot_count(); ++s)
      if (front_.alive(s) && front_.is_crowded(s)) {
        report_whole_cap(0, outer_size(), CapVerdict::too_crowded);
        return false;
      }
    std::vector<bool> joined(front_.component_count());
    for (std::uint32_t c = 0; c < joined.size(); ++c) joined[c] = home_[c] == kNull;
    if (options_.max_lids == 0) plan_polytope();
    return bridge_concavities(front_, complex_, joined, passes_.layer(), options_.probe) ==
           CapVerdict::accepted;
  }

  /// Plans the outermost wrapper; from now on all fronts stay inside it.
  void plan_polytope() {
    if (wrapper_size() > 0) return;
    wrapper_ = wrapper_around(outer_points());
    if (wrapper_size() == 0) return;
    // The front keeps a margin from the wrapper, so that the exact confirmation in find_closing() succeeds.
    Eigen::AlignedBox3d box;
    for (const auto& v : wrapper_.vertices) box.extend(v);
    bounds_ = BodyBounds(wrapper_, kFrontDistance * box.sizes().maxCoeff());
  }

  /// Maximum number of triangles in a plane that become one polygon. Measured on two bodies and six seeds:
  /// with 16, gear.obj has a looser wrapper within 10 % of its size; with 128, fandisk from 0.5 % on.
  static constexpr std::uint32_t kPlanarTriangles = 8;
  /// Fitting ends when the front has no more triangles than this.
  static constexpr std::uint32_t kFitDownTo = 200;
  /// The outermost wrapper is planned when the front has no more triangles than this: few enough to be quick,
  /// and still close to the mesh.
  static constexpr std::uint32_t kPolytopeFrom = 30000;
  /// The same while fitting, where the front is close to the mesh for longer.
  static constexpr std::uint32_t kFittedPolytopeFrom = 2000;

  Workers workers_;
  BodyBounds bounds_;
};

/// Builds an LRB-rep from a 3D mesh that is MeshReport::buildable() and oriented outward. `meeting`: the
/// faces that intersect others in more than shared vertices and edges, ascending; only the outermost region
/// covers these.
LrbData build_by_collapses(const Mesh& mesh, const std::vector<FaceId>& meeting,
                           const BuildOptions& options) {
  return CollapseBuilder(mesh, meeting, options).run();
}

}  // namespace
}  // namespace lrb::construct

namespace lrb {
namespace {

/// Returns all reasons why an LRB-rep cannot be built, on one line.
std::string rejection(const Mesh& mesh, const MeshReport& report) {
  // All obstacles at once, so that the user can fix them in one go.
  std::string text;
  for (const std::string& line : report.obstacles(mesh)) text += (text.empty() ? "" : " | ") + line;
  return text;
}

void check_options(const Mesh& mesh, const BuildOptions& options) {
  if (options.merge_planes && (options.lean || mesh.dim == 2))
    throw InputError(printable_name(mesh.name) + ": cannot merge planes " +
                     (mesh.dim == 2 ? "of a 2D body" : "in a lean LRB-rep"));
}

/// `meeting`: the faces that intersect others in more than shared vertices and edges.
LrbRep build(const Mesh& mesh, const std::vector<FaceUse>& use, const std::vector<FaceId>& meeting,
             const BuildOptions& options) {
  // Step 1: the faces that intersect others. Do interiors of the body overlap, or do its faces only touch?
  const auto meets = [&](FaceId f) { return std::binary_search(meeting.begin(), meeting.end(), f); };
  const bool overlapping = !meeting.empty() && overlaps_itself(mesh, use, [&](FaceId f, FaceId g) {
    return meets(f) && meets(g);
  });
  // Step 2: the regions, from the mesh outward.
  LrbData data = mesh.dim == 2 ? construct::build_by_chains(mesh, meeting, options)
                               : construct::build_by_collapses(mesh, meeting, options);
  // Step 3: the trees for queries are built by the LrbRep itself.
  data.self_intersecting = overlapping;
  return LrbRep(std::move(data), options.threads);
}

}  // namespace

LrbRep build_lrb(const CheckedMesh& checked, const BuildOptions& options) {
  const FloatMode float_mode;
  // The mesh was checked before; its results are reused.
  if (!checked.report().buildable()) throw InputError(rejection(checked.mesh(), checked.report()));
  check_options(checked.mesh(), options);
  Workers workers(options.threads);
  return build(checked.mesh(), checked.use(), checked.self_intersecting_faces(workers), options);
}

LrbRep build_lrb(const Mesh& mesh, const BuildOptions& options) {
  const FloatMode float_mode;
  // Reject meshes that cannot be built before the more expensive search for self-intersections.
  const MeshFindings found = examine(mesh);
  if (!found.report.buildable()) throw InputError(rejection(mesh, found.report));
  check_options(mesh, options);
  Workers workers(options.threads);
  return build(mesh, found.use, self_intersecting_faces(mesh, found.use, workers), options);
}

}  // namespace lrb

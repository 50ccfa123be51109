// CGAL, with its kernel of exact predicates and inexact constructions, as in its manual: the collision
// detection of rigid triangle meshes, and the AABB tree queried with each triangle of the other body.
#include <algorithm>
#include <map>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include <lrbscope/error.hpp>

#ifdef LRB_HAS_CGAL
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <CGAL/Surface_mesh.h>
#define LRB_CGAL "CGAL " CGAL_VERSION_STR
#else
#define LRB_CGAL "CGAL"
#endif

namespace lrb::methods {
namespace {

class Rigid;
class Pairs;

#ifdef LRB_HAS_CGAL

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Detection = CGAL::Rigid_triangle_mesh_collision_detection<SurfaceMesh>;
using TriangleIterator = std::vector<Triangle>::const_iterator;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, TriangleIterator>>>;

Kernel::Aff_transformation_3 transform(const Pose& p) {
  return {p.r(0, 0), p.r(0, 1), p.r(0, 2), p.t.x(),   p.r(1, 0), p.r(1, 1),
          p.r(1, 2), p.t.y(),   p.r(2, 0), p.r(2, 1), p.r(2, 2), p.t.z()};
}

std::vector<Point> points_of(const Triangles& t) {
  std::vector<Point> points;
  for (const Eigen::Vector3d& v : t.vertices) points.emplace_back(v.x(), v.y(), v.z());
  return points;
}

/// Runs CGAL, and turns a violated precondition into a rejection.
template <class Run>
auto run_cgal(const Run& run) {
  try {
    return run();
  } catch (const CGAL::Failure_exception& e) {
    throw InputError("CGAL rejected the input: " + e.expression());
  }
}

/// All bodies are in one set of meshes, as CGAL intends.
struct MeshSet {
  std::map<std::size_t, std::unique_ptr<SurfaceMesh>> meshes;  // trees point into them
  Detection detection;
};

struct MeshBody : MethodBody {
  explicit MeshBody(std::shared_ptr<MeshSet> s, std::unique_ptr<SurfaceMesh> mesh)
      : set(std::move(s)), id(set->detection.add_mesh(*mesh)) {
    set->meshes[id] = std::move(mesh);
  }
  ~MeshBody() override {
    set->detection.remove_mesh(id);
    set->meshes.erase(id);
  }
  std::shared_ptr<MeshSet> set;
  std::size_t id;
};

class Rigid : public MethodOf<MeshBody, false> {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    const Triangles t = triangles_of(rep);
    std::vector<std::array<std::size_t, 3>> faces;
    for (const auto& c : t.triangles) faces.push_back({c[0], c[1], c[2]});
    namespace pmp = CGAL::Polygon_mesh_processing;
    if (!pmp::is_polygon_soup_a_polygon_mesh(faces))
      throw InputError("not manifold, or not oriented: CGAL's Surface_mesh cannot represent it");
    return run_cgal([&] {
      auto mesh = std::make_unique<SurfaceMesh>();
      pmp::polygon_soup_to_polygon_mesh(points_of(t), faces, *mesh);
      return std::make_unique<MeshBody>(set_, std::move(mesh));
    });
  }

  Answer ask(const Posed& a, const Posed& b, Mode) override {
    const std::size_t id_a = a.body.id;
    const std::array<std::size_t, 1> id_b = {b.body.id};
    return run_cgal([&] {
      const Stopwatch watch;
      set_->detection.set_transformation(id_a, transform(a.pose));
      set_->detection.set_transformation(id_b[0], transform(b.pose));
      const auto found = set_->detection.get_all_intersections_and_inclusions(id_a, id_b);
      Answer answer;
      answer.microseconds = watch.microseconds();
      answer.contact = !found.empty() && !found.front().second;
      answer.inside = !found.empty() && found.front().second;
      return answer;
    });
  }

 private:
  std::shared_ptr<MeshSet> set_ = std::make_shared<MeshSet>();
};

struct TreeBody : MethodBody {
  std::vector<Triangle> triangles;
  Tree tree;
};

class Pairs : public MethodOf<TreeBody, false> {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    const Triangles t = triangles_of(rep);
    const std::vector<Point> points = points_of(t);
    auto body = std::make_unique<TreeBody>();
    for (const auto& c : t.triangles) body->triangles.emplace_back(points[c[0]], points[c[1]], points[c[2]]);
    run_cgal([&] {
      body->tree.insert(body->triangles.cbegin(), body->triangles.cend());
      body->tree.build();
      return 0;
    });
    return body;
  }

  /// Moves A's triangles into B's frame and queries B's tree with each.
  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    return run_cgal([&] {
      const Stopwatch watch;
      const auto relative = transform(b.pose).inverse() * transform(a.pose);
      Answer answer;
      std::vector<TriangleIterator> met;
      for (std::size_t i = 0; i < a.body.triangles.size(); ++i) {
        const Triangle t = a.body.triangles[i].transform(relative);
        if (mode == Mode::first_pair) {
          const auto any = b.body.tree.any_intersected_primitive(t);
          if (any) met.push_back(*any);
        } else {
          b.body.tree.all_intersected_primitives(t, std::back_inserter(met));
        }
        for (const TriangleIterator j : met)
          answer.pairs.push_back(
              {static_cast<SimplexId>(i), static_cast<SimplexId>(j - b.body.triangles.cbegin())});
        met.clear();
        if (mode == Mode::first_pair && !answer.pairs.empty()) break;
      }
      answer.microseconds = watch.microseconds();
      std::sort(answer.pairs.begin(), answer.pairs.end());
      answer.contact = !answer.pairs.empty();
      return answer;
    });
  }
};

#endif

}  // namespace

std::vector<MethodEntry> cgal_methods() {
  return {
      entry_of<Rigid>(
          {.name = "cgal",
           .title = LRB_CGAL ", Rigid_triangle_mesh_collision_detection",
           .remark =
               "Yes or no, and whether one body is inside the other: get_all_intersections_and_inclusions() of two "
               "Surface_meshes, exact predicates. Lists no pairs; manifold meshes and 3D only. Judged by contact, "
               "inside or separate.",
           .pairs = false,
           .says = Says::inside,
           .style = {"CGAL, yes or no", "#009e73", "triangleOpen"},
           .rank = 40},
          "libcgal-dev"),
      entry_of<Pairs>(
          {.name = "cgal-pairs",
           .title = LRB_CGAL ", AABB_tree, triangle by triangle",
           .remark =
               "All pairs: all_intersected_primitives() of B's tree for each triangle of A, exact predicates. CGAL "
               "requires triangles of non-zero area. Does not look for bodies inside bodies; 3D only.",
           .style = {"CGAL, pairs", "#009e73", "triangle"},
           .rank = 41},
          "libcgal-dev")};
}

}  // namespace lrb::methods

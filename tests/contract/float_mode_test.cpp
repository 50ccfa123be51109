// Doors to the engine in threads whose floating-point mode is not the default, as between two operations of
// an interval arithmetic. Other tests ask in these modes as well: of contracts, scenes, threads.
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/answer_content.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/faulty_meshes.hpp"
#include "tests/support/float_modes.hpp"
#include "tests/support/lrb_files.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/broad_phase.hpp>
#include <lrbscope/build.hpp>
#include <lrbscope/coherent.hpp>
#include <lrbscope/core/random.hpp>
#include <lrbscope/explain.hpp>
#include <lrbscope/mesh_repair.hpp>
#include <lrbscope/self_intersections.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/workspace.hpp>
#include <lrbscope/world_box.hpp>

namespace lrb::float_modes {
namespace {

using Eigen::Vector3d;
using test::content;

template <class Ask>
void check_modes(const Ask& ask) {
  const auto expected = ask();
  for (int i = 0; i < 5; ++i) {
    CAPTURE(i);
    CHECK((test::in_mode(i, ask) == expected));
  }
}

template <class List>
std::string bytes(const List& list) {
  return {reinterpret_cast<const char*>(list.data()), list.size() * sizeof(*list.data())};
}

void check_queries(const LrbRep& a, const Pose& at, const LrbRep& b, const Pose& to, double size_of_bodies) {
  const double near = 0.5 * size_of_bodies;
  check_modes([&] {
    return std::tuple(content(collide(a, at, b, to)), content(distance(a, at, b, to)),
                      content(near_pairs(a, at, b, to, {.within = near})),
                      content(contact_manifolds(a, at, b, to, {.margin = near})),
                      content(clash(a, at, b, to)), brute_force(a, at, b, to).pairs);
  });
  const Vector3d way = Vector3d(2, 1, 0) * size_of_bodies;
  check_modes([&] { return content(first_contact(a, Motion::still(at), b, Motion::linear(to, way))); });
  check_modes([&] {
    CoherentQuery query(a, b, {}, CoherentQuery::CacheUse::always);
    CoherentDistance distances(a, b);
    const auto first = content(query.collide(at, to));
    return std::tuple(first, content(query.collide(at, to)), content(distances.distance(at, to)));
  });
  std::vector<Pose> motion;
  for (int k = 0; k < 16; ++k) motion.push_back({to.r, to.t + 0.1 * k * way});
  check_modes([&] {
    CollideAnswers answers;
    Batch(1).collide(a, at, b, motion, {.mode = Mode::any_pair}, answers);
    std::vector<decltype(content(*answers[0]))> out;
    for (const auto& answer : answers) out.push_back(content(answer.value()));
    return out;
  });
  const std::array<Vector3d, 2> points = {0.1 * way, way};
  check_modes([&] {
    const WorldBox box_a = box_of(a.tree(), 0, kWhole, at), box_b = box_of(b.tree(), 0, kWhole, to);
    BoxPair boxes;
    compare_boxes(box_a, box_b, boxes);
    return std::tuple(explain_pair(a, at, b, to, {SimplexId(0), SimplexId(0)}).distance, boxes.gap,
                      content(explain_walk(a, at, b, to).result), content(box_a.half[0]),
                      content(point_distances(a, at, points, {}, 2)));
  });
  check_modes([&] {
    SweepAndPrune sweep;
    const std::array boxes = {world_box(a, at), BodyExtent(b).in_world(to)};
    const auto pairs = sweep.update(boxes);
    return std::tuple(pairs, sweep.update(boxes, std::array{1U}), content(boxes[0].max()),
                      content(boxes[1].min()), world_boxes_are_disjoint(a, at, b, to));
  });
}

/// What makes and checks bodies.
void check_bodies(const Mesh& mesh) {
  check_modes([&] {
    Mesh joined = mesh;
    join_corners(joined);
    CheckedMesh checked = check(mesh);
    Workers workers(2);
    const auto crossing = checked.self_intersecting_faces(workers);
    checked.find_self_intersections();
    MeshReport report;
    check_vertices(mesh, report);
    const auto use = check_faces(mesh, report);
    std::vector<std::array<VertexId, 3>> cut;
    cut_polygon(mesh, FaceId(0), cut);
    return std::tuple(checked.report().lines(mesh), report.lines(mesh), use, cut, crossing, joined.joined,
                      bytes(self_intersections(checked).segments), close_holes(checked).mesh.face_vertices,
                      bytes(convex_hull_mesh(mesh.vertices).vertices), convex_outline(mesh.vertices));
  });
  Mesh slit = test::as_soup(mesh);
  for (std::uint32_t v = 0; v < slit.vertices.size(); ++v)
    slit.vertices[v] += 1e-9 * Vector3d(v % 3, v % 5, v % 7);
  check_modes([&] {
    WeldedCorners done;
    const auto corners = weld_corners(check(slit), 1e-8, done).mesh().face_vertices;
    return std::tuple(corners, done.farthest);
  });
  check_modes([&] {
    const test::Folder folder;
    write_mesh(mesh, folder / "m.obj");
    const Body body = Body::load(folder / "m.obj").value();
    const std::string saved = test::lrb_bytes(body);
    return std::tuple(saved, test::lrb_bytes(load_lrb(saved, "b")), body.rep().overlaps_itself());
  });
  check_modes([&] {
    const LrbRep rep = build_lrb(mesh);
    std::vector<double> numbers = region_thickness(rep, 2);
    numbers.push_back(lid_height(rep));
    for (RegionId r = 0; r < rep.region_count(); ++r) numbers.push_back(region_volume(rep, r));
    for (const WrapperLevel& level : rep.levels(2).all()) numbers.push_back(level.bound);
    return std::tuple(numbers, validate(rep).violations, validate_cells(rep).violations);
  });
}

LrbRep triangle(const std::array<Vector3d, 3>& corners) {
  Mesh mesh;
  mesh.vertices.assign(corners.begin(), corners.end());
  mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
  return test::open_body(mesh);
}

}  // namespace

TEST_CASE("answers and bodies do not depend on the thread's rounding mode, nor on flushing to zero") {
  // With directed rounding, these triangles seem to intersect.
  check_queries(
      triangle({{{3, 0x1.0000000001p+0, 1}, {0, 1, 1}, {-0x1p-80, -1, 3}}}), {},
      triangle({{{-1, 0x1.0000000002p+0, 0x1.0000000001p+0}, {-0x1p-80, 0, 2}, {-0x1.fffffffffep-1, 1, 3}}}),
      {}, 1);
  const LrbRep small = test::closed(shapes::scaled(shapes::icosphere(0), 0x1p-1060));
  const Pose at = Pose::rotation({3, 1, 1}, 0.4), to = Pose::rotation({1, 2, 3}, 0.7, {2.6, 0.1, 0.2});
  check_queries(small, at, small, Pose::translation({0x1p-1060, 0, 0}), 0x1p-1060);
  const Mesh sphere = shapes::bumpy_sphere(2, 1);
  const LrbRep a = build_lrb(sphere), b = build_lrb(shapes::torus(12, 8));
  check_queries(a, at, b, to, 1);
  check_queries(a, at, b, {to.r, {0.8, 0.1, 0.2}}, 1);
  check_bodies(sphere);
  check_bodies(shapes::quad_torus(6, 5));
  check_modes([&] {
    const Pose end = Pose::rotation({3, 1, 0.3}, 1.1, {1, 2, 3});
    const Motion::KeyFrame frames[] = {{0, to}, {0.3, end}, {1, to}};
    std::string out = bytes(deterministic::rotation_between({1, 0, 0}, 0.3, {0, 0.6, 0.8}, 0.7, 0.3));
    for (const Motion& motion : {Motion::screw(to, end), Motion::key_frames(frames),
                                 Motion::turning(to, {0.1, 0.2, 1}, {0.3, 0.1, 0.7}, {1, 0.1, 0.2})})
      out += bytes(motion.at(0.37).r) + bytes(motion.at(0.37).t);
    return out;
  });
}

}  // namespace lrb::float_modes

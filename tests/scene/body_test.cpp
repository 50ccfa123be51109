// Bodies made in one call from matrices, arrays, meshes and files: errors and notes.
#include <array>
#include <limits>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/folder.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

using namespace lrb;

namespace {

Eigen::MatrixX3d vertices_of(const Mesh& mesh) {
  Eigen::MatrixX3d v(mesh.vertices.size(), 3);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    v.row(static_cast<Eigen::Index>(i)) = mesh.vertices[i];
  return v;
}

template <class Integer, int Order = Eigen::ColMajor>
Eigen::Matrix<Integer, Eigen::Dynamic, 3, Order> triangles_of(const Mesh& mesh) {
  Eigen::Matrix<Integer, Eigen::Dynamic, 3, Order> f(mesh.face_count(), 3);
  for (FaceId face = 0; face < mesh.face_count(); ++face)
    for (int k = 0; k < 3; ++k)
      f(face.value(), k) = static_cast<Integer>(mesh.face(face)[static_cast<std::size_t>(k)].value());
  return f;
}

template <class Integer>
std::vector<Integer> corners_of(const Mesh& mesh) {
  std::vector<Integer> out;
  for (const VertexId v : mesh.face_vertices) out.push_back(static_cast<Integer>(v.value()));
  return out;
}

std::vector<double> coordinates_of(const Mesh& mesh) {
  std::vector<double> out;
  for (const Eigen::Vector3d& v : mesh.vertices) out.insert(out.end(), v.data(), v.data() + 3);
  return out;
}

/// Returns the reason why a body is refused; empty: it is not.
std::string reason(const Expected<Body>& body) {
  return body ? std::string() : body.error().reason;
}

}  // namespace

TEST_CASE("a body is the same when made from matrices, arrays, a mesh and files") {
  const Mesh mesh = shapes::bumpy_sphere(2, 3);
  BodyOptions options;
  options.name = "rock";
  const Body whole = Body::from(mesh, options).value();
  CHECK(whole.name() == "bumpy sphere 3");
  CHECK(Body::from(vertices_of(mesh), triangles_of<int>(mesh), options).value().name() == "rock");
  CHECK(whole.is_solid());
  CHECK(whole.has_regions());
  CHECK(whole.notes().empty());
  const std::uint64_t hash = whole.rep().hash();

  const Eigen::MatrixX3d v = vertices_of(mesh);
  CHECK(Body::from(v, triangles_of<int>(mesh)).value().rep().hash() == hash);
  CHECK(Body::from(v, triangles_of<std::uint64_t, Eigen::RowMajor>(mesh)).value().rep().hash() == hash);
  CHECK(Body::from(v.topRows(v.rows()), triangles_of<std::uint8_t>(mesh))
            .has_value());  // a block; 162 vertices
  const std::vector<double> x = coordinates_of(mesh);
  CHECK(Body::from(x, corners_of<std::uint32_t>(mesh)).value().rep().hash() == hash);
  CHECK(Body::from(x, corners_of<std::int32_t>(mesh)).value().rep().hash() == hash);
  CHECK(Body::from(x, corners_of<std::int64_t>(mesh)).value().rep().hash() == hash);

  const test::Folder folder;
  save_lrb(whole, folder / "rock.lrb");
  CHECK(Body::load(folder / "rock.lrb").value().rep().hash() == hash);
  write_mesh(mesh, folder / "rock.ply");
  CHECK(Body::load(folder / "rock.ply").value().rep().hash() == hash);
  CHECK(Body::from(LrbRep(whole.rep().data())).rep().hash() == hash);
}

TEST_CASE("copies of a body share its data, and it converts to an LRB-rep") {
  const Body body = Body::from(shapes::box()).value();
  const Body copy = body;
  CHECK(copy == body);
  CHECK(&copy.rep() == &body.rep());
  CHECK(!(Body::from(shapes::box()).value() == body));
  CHECK(collide(body, Pose{}, copy, Pose::translation({0.5, 0.5, 0.5})).relation == Relation::crossing);
}

TEST_CASE("inward-oriented bodies are flipped with a note, or kept on request") {
  const Mesh mesh = shapes::turned_inside_out(shapes::box());
  const Body turned = Body::from(mesh).value();
  CHECK(turned.turned() == 1);
  REQUIRE(turned.notes().size() == 1);
  CHECK(turned.notes()[0].find("flipped 1 inside-out component") != std::string::npos);
  CHECK(turned.rep().face(0)[1] == mesh.face(0)[2]);
  const Pose inside = Pose::translation({0.25, 0.25, 0.25});
  const Body small = Body::from(shapes::scaled(shapes::box(), 0.5)).value();
  CHECK(collide(small, inside, turned, Pose{}).relation == Relation::a_inside_b);

  BodyOptions options;
  options.turn = false;
  const Body left = Body::from(mesh, options).value();
  CHECK(left.turned() == 0);
  CHECK(left.rep().face(0)[1] == mesh.face(0)[1]);
  CHECK(!left.has_regions());
  CHECK(left.notes()[0].find("a component is inside out") != std::string::npos);

  // Normals and depths of contacts of LRB-reps without regions, and of meshes with a fault, depend on it,
  // too.
  const LrbRep inward = LrbRep::without_regions(mesh, true, false);
  const test::Folder folder;
  save_lrb(inward, folder / "inward.lrb");
  Mesh faulty = mesh;
  faulty.add_face(std::array<VertexId, 3>{0, 0, 1});
  BodyOptions plain;
  plain.regions = false;
  for (const Body& body : {Body::from(inward), Body::load(folder / "inward.lrb").value(),
                           Body::from(faulty).value(), Body::from(faulty, plain).value()}) {
    CHECK(body.turned() == 1);
    const ManifoldResult found = contact_manifolds(body, {}, turned, Pose::translation({0.75, 0.25, 0.25}));
    REQUIRE(found.manifolds.size() == 1);
    CHECK(found.manifolds[0].points[0].depth == 0.25);
  }
  CHECK(Body::load(folder / "inward.lrb", options).value().rep().face(0)[1] == mesh.face(0)[1]);
  CHECK(Body::from(std::make_shared<const LrbRep>(inward)).turned() == 0);
}

TEST_CASE("an open mesh is a body with a note on unavailable queries") {
  const Body tube = Body::from(shapes::open_cylinder(12)).value(), box = Body::from(shapes::box()).value();
  CHECK(!tube.is_solid());
  REQUIRE(tube.notes().size() == 2);
  CHECK(tube.notes()[0].find("an edge has only one face") != std::string::npos);
  CHECK(tube.notes()[1].find("not a closed solid") != std::string::npos);
  CHECK(collide(tube, Pose{}, box, Pose::translation({5, 5, 5})).relation == Relation::separate);
  CHECK(collide(tube, Pose{}, Body::from(shapes::box({-0.1, -0.1, 0.4}, {0.1, 0.1, 0.6})).value(), Pose{})
            .relation == Relation::undefined);
  CHECK(collide(tube, Pose{}, box, Pose::translation({0.5, 0, 0})).relation == Relation::crossing);
  CHECK(Body::from(LrbRep::without_regions(shapes::open_cylinder(12), false, false)).notes().size() == 1);
}

TEST_CASE("polygons and 2D bodies are made from matrices") {
  Eigen::MatrixXd corners(4, 2);
  corners << 0, 0, 1, 0, 1, 1, 0, 1;
  Eigen::MatrixXi sides(4, 2);
  sides << 0, 1, 1, 2, 2, 3, 3, 0;
  const Body square = Body::from(corners, sides).value();
  CHECK(square.dim() == 2);
  CHECK(square.is_solid());
  CHECK(collide(square, Pose{}, square, Pose::translation({0.5, 0.5, 0})).pairs.size() == 2);

  const Mesh box = shapes::quad_box();
  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> quads(6, 4);
  for (int i = 0; i < 24; ++i)
    quads.data()[i] = static_cast<int>(box.face_vertices[static_cast<std::size_t>(i)]);
  CHECK(Body::from(vertices_of(box), quads).value().rep().real_face_count() == 6);
}

TEST_CASE("invalid bodies are rejected with a reason that names the element") {
  const Mesh box = shapes::box();
  Eigen::MatrixX3d v = vertices_of(box);
  Eigen::Matrix<int, Eigen::Dynamic, 3> f = triangles_of<int>(box);
  BodyOptions options;
  options.name = "my\nbox";
  f(3, 1) = -1;
  CHECK(reason(Body::from(v, f, options)) == "my\\x0abox: face 3: expected a vertex index below 8, found -1");
  f(3, 1) = 8;
  CHECK(reason(Body::from(v, f)) == "body: face 3: expected a vertex index below 8, found 8");
  f = triangles_of<int>(box);
  v(5, 2) = std::numeric_limits<double>::quiet_NaN();
  CHECK(
      reason(Body::from(v, f)) ==
      "body: cannot be queried: a coordinate is not finite (1 time): vertex 5, counted from 0 in file order; "
      "replace it by a finite number");
  CHECK(reason(Body::from(vertices_of(box), Eigen::MatrixX3i(0, 3))).find("the mesh has no faces") !=
        std::string::npos);
  CHECK(reason(Body::from(Eigen::MatrixXd(Eigen::MatrixXd::Zero(8, 2)), f)) ==
        "body: expected 3 coordinates per vertex, found 2");
  CHECK(reason(Body::from(vertices_of(box), Eigen::MatrixXi(Eigen::MatrixXi::Zero(4, 1)))) ==
        "body: expected 3 or more corners per face (2 for 2D bodies), found 1");
  Eigen::MatrixXi side(1, 2);
  side << 0, 1;
  CHECK(reason(Body::from(Eigen::MatrixXd(Eigen::MatrixXd::Ones(2, 3)), side)) ==
        "body: vertex 0: expected z = 0 in a 2D body, found 1");
  const std::vector<double> x(8);
  CHECK(reason(Body::from(x, std::vector<int>{0, 0, 0})) ==
        "body: expected a multiple of 3 coordinates, found 8");
  CHECK(reason(Body::from(std::vector<double>(9), std::vector<int>{0, 1})) ==
        "body: expected a multiple of 3 corners, found 2");
  CHECK(reason(Body::from(std::vector<double>(9), std::vector<std::int64_t>{0, 1, std::int64_t{1} << 32})) ==
        "body: face 0: expected a vertex index below 3, found 4294967296");
  CHECK(reason(Body::load("/nowhere/at.obj")) == "/nowhere/at.obj: no such file; check the path");
  CHECK_THROWS_WITH_AS((void)Body::load("/nowhere/at.obj").value(),
                       "/nowhere/at.obj: no such file; check the path", InputError);
}

TEST_CASE("an LRB-rep with open cells is queried by its faces, with a note on the location") {
  const Mesh rock = shapes::bumpy_sphere(3, 1);
  const Body sound = Body::from(rock).value();
  REQUIRE(sound.has_regions());
  LrbData data = sound.rep().data();
  data.outer_cell[0] = data.outer_cell[0] == kOutside ? CellId(RegionId(0)) : kOutside;
  const test::Folder folder;
  save_lrb(LrbRep(data), folder / "open.lrb");
  for (const Body& body : {Body::from(LrbRep(data)), Body::from(std::make_shared<const LrbRep>(data)),
                           Body::load(folder / "open.lrb").value()}) {
    CHECK(body.is_solid());
    CHECK_FALSE(body.has_regions());
    REQUIRE(body.notes().size() == 1);
    CHECK(body.notes()[0].starts_with(
        body.name() + ": queries will not use regions, because the validation of its LRB-rep failed: "));
    CHECK(body.notes()[0].find("is open at edge (") != std::string::npos);
    const Pose pose = Pose::translation({0.7, 0.2, 0.1});
    CHECK(collide(body, Pose{}, sound, pose).pairs == collide(sound, Pose{}, sound, pose).pairs);
    CHECK(collide(body, Pose{}, sound, pose).relation == Relation::crossing);
  }
}

TEST_CASE("a self-intersecting body has a note that it has no approximate answers") {
  const Mesh rock = shapes::bumpy_sphere(2, 1);
  const Body body = Body::from(shapes::several({rock, shapes::translated(rock, {0.3, 0.1, 0.05})})).value();
  REQUIRE(body.notes().size() == 1);
  CHECK(
      body.notes()[0].find("approximate queries are not supported, because its surface intersects itself") !=
      std::string::npos);
}

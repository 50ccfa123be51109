// FCL's interface on this engine against FCL; brute force decides if they differ.
#include <algorithm>
#include <limits>
#include <thread>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/float_modes.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/fcl.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

template <class BV>
std::shared_ptr<::fcl::BVHModel<BV>> model_of(const Mesh& mesh) {
  using S = typename BV::S;
  std::vector<::fcl::Vector3<S>> vertices;
  std::vector<::fcl::Triangle> triangles;
  for (const Eigen::Vector3d& v : mesh.vertices) vertices.push_back(v.cast<S>());
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    triangles.emplace_back(mesh.face(f)[0], mesh.face(f)[1], mesh.face(f)[2]);
  auto model = std::make_shared<::fcl::BVHModel<BV>>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

template <class S>
::fcl::Transform3<S> transform_of(const Pose& pose) {
  ::fcl::Transform3<S> t = ::fcl::Transform3<S>::Identity();
  t.linear() = pose.r.template cast<S>();
  t.translation() = pose.t.template cast<S>();
  return t;
}

template <class S>
std::vector<SimplexPair> pairs_of(const ::fcl::CollisionResult<S>& result) {
  std::vector<SimplexPair> pairs;
  for (std::size_t i = 0; i < result.numContacts(); ++i)
    pairs.push_back({SimplexId(result.getContact(i).b1), SimplexId(result.getContact(i).b2)});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// How often FCL gave the answer that brute force gives.
struct Agreement {
  int checked = 0, same_pairs = 0, same_verdict = 0;
};

/// Asks FCL and this engine for two meshes at random poses; brute force says who is right.
template <class BV>
Agreement ask_both(const Mesh& mesh_a, const Mesh& mesh_b, int poses, std::uint64_t seed) {
  using S = typename BV::S;
  const auto a = model_of<BV>(mesh_a), b = model_of<BV>(mesh_b);
  const Body exact_a = lrb::fcl::body_of(*a).value(), exact_b = lrb::fcl::body_of(*b).value();
  RandomEngine random(seed);
  Agreement agreement;
  for (int i = 0; i < poses; ++i) {
    const ::fcl::Transform3<S> place =
        transform_of<S>(shapes::random_pose(random, exact_a, exact_b, shapes::uniform(random, 0.2, 1.1)));
    const ::fcl::Transform3<S> home = ::fcl::Transform3<S>::Identity();
    const BruteForceResult truth = brute_force(exact_a, Pose{}, exact_b, lrb::fcl::pose_of<S>(place));
    const ::fcl::CollisionRequest<S> all(std::size_t{1} << 20);
    ::fcl::CollisionResult<S> ours, theirs;
    CHECK(lrb::fcl::collide(a.get(), home, b.get(), place, all, ours) == truth.pairs.size());
    CHECK(pairs_of(ours) == truth.pairs);
    ::fcl::collide(a.get(), home, b.get(), place, all, theirs);
    ++agreement.checked;
    agreement.same_pairs += pairs_of(theirs) == truth.pairs;
    agreement.same_verdict += theirs.isCollision() == !truth.pairs.empty();

    const ::fcl::CollisionRequest<S> one;
    ::fcl::CollisionResult<S> single;
    CHECK(lrb::fcl::collide(a.get(), home, b.get(), place, one, single) == (truth.pairs.empty() ? 0U : 1U));
  }
  return agreement;
}

}  // namespace

TEST_CASE_TEMPLATE("collide() of meshes returns exactly the intersecting pairs, mostly the same as FCL", BV,
                   ::fcl::AABBd, ::fcl::OBBd, ::fcl::RSSd, ::fcl::OBBRSSd, ::fcl::kIOSd,
                   ::fcl::KDOP<double, 18>, ::fcl::OBBRSSf) {
  const Agreement round = ask_both<BV>(shapes::bumpy_sphere(2, 4), shapes::torus(20, 10), 40, 1);
  MESSAGE("FCL gives all pairs of ", round.same_pairs, " of ", round.checked, " poses, and the verdict of ",
          round.same_verdict);
  CHECK(round.same_verdict >= round.checked - 2);
}

TEST_CASE("touching faces: this engine is exact, FCL need not be") {
  const auto a = model_of<::fcl::OBBRSSd>(shapes::box());
  const ::fcl::Transform3d home = ::fcl::Transform3d::Identity();
  for (const Eigen::Vector3d& t :
       {Eigen::Vector3d(1, 0.25, 0.25), Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 1, 1),
        Eigen::Vector3d(1 + 0x1p-52, 0, 0), Eigen::Vector3d(0, 0, 0)}) {
    ::fcl::Transform3d place = home;
    place.translation() = t;
    const ::fcl::CollisionRequestd all(1000);
    ::fcl::CollisionResultd ours;
    lrb::fcl::collide(a.get(), home, a.get(), place, all, ours);
    const Body body = lrb::fcl::body_of(*a).value();
    CHECK(pairs_of(ours) == brute_force(body, Pose{}, body, Pose::translation(t)).pairs);
  }
}

TEST_CASE("distances equal lrb::distance() and agree with FCL up to rounding") {
  RandomEngine random(3);
  const auto a = model_of<::fcl::OBBRSSd>(shapes::bumpy_sphere(2, 4)),
             b = model_of<::fcl::OBBRSSd>(shapes::torus(20, 10));
  const Body exact_a = lrb::fcl::body_of(*a).value(), exact_b = lrb::fcl::body_of(*b).value();
  int apart = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose pose = shapes::random_pose(random, exact_a, exact_b, shapes::uniform(random, 0.8, 2));
    const ::fcl::CollisionObjectd o1(a), o2(b, transform_of<double>(pose));
    const ::fcl::DistanceRequestd request(true);
    ::fcl::DistanceResultd ours, theirs;
    const double d = lrb::fcl::distance(&o1, &o2, request, ours);
    const lrb::DistanceResult truth = lrb::distance(exact_a, Pose{}, exact_b, pose);
    CHECK(d == truth.upper);
    CHECK(ours.min_distance == d);
    CHECK(ours.o1 == a.get());
    if (d == 0) continue;
    ++apart;
    CHECK((ours.nearest_points[0] - ours.nearest_points[1]).norm() == doctest::Approx(d));
    CHECK(SimplexId(ours.b1) == truth.witness[0].simplex);
    CHECK(::fcl::distance(&o1, &o2, request, theirs) == doctest::Approx(d).epsilon(1e-9));
    CHECK(lrb::fcl::distance(&o1, &o2, ::fcl::DistanceRequestd(), ours) == d);  // no worse than the result
  }
  CHECK(apart > 20);
}

// Unit cubes that overlap by 0.25 along x; with sides in one plane, nearly, and far from it. Cf. FCL #106,
// #503, #491, and a box in the corner of two walls.
TEST_CASE("contacts have points in both meshes, and the normal and depth of the overlap") {
  const auto outward = model_of<::fcl::OBBRSSd>(shapes::box()),
             inward = model_of<::fcl::OBBRSSd>(shapes::turned_inside_out(shapes::box()));
  for (int i = 0; i < 16; ++i) {
    const auto& box = i % 2 == 0 ? outward : inward;
    const Eigen::Vector3d t =
        std::array{Eigen::Vector3d(0.75, 0, 0), Eigen::Vector3d(0.75, 0.001, 0),
                   Eigen::Vector3d(0.75, 0.001, 0.002), Eigen::Vector3d(0.75, 0.25, 0.25)}[i / 4];
    const ::fcl::CollisionObjectd o1(box);
    ::fcl::CollisionObjectd o2(i % 4 < 2 ? outward : inward);
    o2.setTranslation(t);
    ::fcl::CollisionResultd result;
    lrb::fcl::collide(&o1, &o2, ::fcl::CollisionRequestd(1000, true), result);
    const Body body = lrb::fcl::body_of(*box).value();
    CHECK(pairs_of(result) == brute_force(body, Pose{}, body, Pose::translation(t)).pairs);
    for (std::size_t k = 0; k < result.numContacts(); ++k) {
      const ::fcl::Contactd& c = result.getContact(k);
      CHECK(c.o1 == box.get());
      CHECK(c.normal == Eigen::Vector3d(1, 0, 0));
      CHECK(c.penetration_depth == 0.25);
      CHECK(c.pos.x() > 0.75 - 1e-12);
      CHECK(c.pos.x() < 1 + 1e-12);
    }
    CHECK(lrb::fcl::collide(&o1, &o2, ::fcl::CollisionRequestd(3), result) == result.numContacts());
    ::fcl::CollisionResultd few;
    CHECK(lrb::fcl::collide(&o1, &o2, ::fcl::CollisionRequestd(3), few) == 3);
    ::fcl::CollisionResultd upward;  // by an interval arithmetic
    test::in_mode(0, [&] { lrb::fcl::collide(&o1, &o2, ::fcl::CollisionRequestd(1000, true), upward); });
    for (std::size_t k = 0; k < result.numContacts(); ++k)
      CHECK(upward.getContact(k).pos == result.getContact(k).pos);
  }
  CHECK(lrb::fcl::known_bodies().of(inward.get(), lrb::fcl::arrays_of(*inward)) ==
        lrb::fcl::known_bodies().of(inward.get(), lrb::fcl::arrays_of(*inward)));
  const Body before = lrb::fcl::known_bodies().of(inward.get(), lrb::fcl::arrays_of(*inward));
  inward->tri_indices[0][0] = inward->tri_indices[0][0] == 7 ? 6 : 7;  // another first corner
  CHECK_FALSE(before == lrb::fcl::known_bodies().of(inward.get(), lrb::fcl::arrays_of(*inward)));
}

TEST_CASE("FCL's names work without qualification; other shapes and moving objects are passed to FCL") {
  using namespace lrb::fcl;
  const auto box = std::make_shared<Boxd>(1, 1, 1);
  const auto mesh = model_of<OBBRSSd>(shapes::box());
  const CollisionObjectd o1(box), o2(mesh);
  CollisionResultd result;
  CHECK(collide(&o1, &o2, CollisionRequestd(), result) == 1);
  const std::size_t found = collide(mesh.get(), Transform3d(Transform3d::Identity()), mesh.get(),
                                    o2.getTransform(), CollisionRequestd(1000), result);
  CHECK(found == result.numContacts());
  const auto vacant = model_of<OBBRSSd>(shapes::box());
  vacant->cost_density = 0;  // not occupied
  const CollisionObjectd o3(vacant);
  CollisionResultd none;
  CHECK(collide(&o2, &o3, CollisionRequestd(), none) == 0);
  DistanceResultd nearest;
  CollisionObjectd far(box);
  far.setTranslation({5, 0, 0});
  CHECK(distance(&o1, &far, DistanceRequestd(), nearest) == doctest::Approx(4));
  Transform3d begin = Transform3d::Identity(), end = begin;
  begin.translation().x() = 2;
  const ContinuousCollisionObjectd still(mesh, std::make_shared<TranslationMotiond>(end, end)),
      moving(mesh, std::make_shared<TranslationMotiond>(begin, end));
  ContinuousCollisionResultd impact;
  collide(&still, &moving, ContinuousCollisionRequestd(), impact);
  CHECK(impact.is_collide);
}

TEST_CASE("a changed mesh, or another one at its address, is not served from the cache") {
  lrb::fcl::known_bodies().clear();
  auto model = model_of<::fcl::OBBRSSd>(shapes::box());
  const auto other = model_of<::fcl::OBBRSSd>(shapes::box({2, 0, 0}, {3, 1, 1}));
  const ::fcl::Transform3d home = ::fcl::Transform3d::Identity();
  const auto meets = [&] {
    ::fcl::CollisionResultd result;
    return lrb::fcl::collide(model.get(), home, other.get(), home, ::fcl::CollisionRequestd(), result) == 1;
  };
  CHECK(!meets());
  std::vector<::fcl::Vector3d> moved(model->vertices, model->vertices + model->num_vertices);
  for (::fcl::Vector3d& v : moved)
    if (v.x() == 1) v.x() = 2;
  model->beginReplaceModel();
  model->replaceSubModel(moved);
  model->endReplaceModel();
  CHECK(meets());
  CHECK(lrb::fcl::known_bodies().size() == 2);
  std::vector<std::shared_ptr<::fcl::BVHModel<::fcl::OBBRSSd>>> kept;  // so that all addresses differ
  for (int i = 0; i < 300; ++i) {
    kept.push_back(model = model_of<::fcl::OBBRSSd>(shapes::box({0, 0, 0}, {i % 2 == 0 ? 1.0 : 2.5, 1, 1})));
    CHECK(meets() == (i % 2 != 0));
  }
  CHECK(lrb::fcl::known_bodies().size() == 256);
  CHECK(lrb::fcl::known_bodies().of(model.get(), lrb::fcl::arrays_of(*model)) ==  // kept: the last one used
        lrb::fcl::known_bodies().of(model.get(), lrb::fcl::arrays_of(*model)));
}

TEST_CASE("threads query the same meshes concurrently") {
  lrb::fcl::known_bodies().clear();
  const auto a = model_of<::fcl::OBBRSSd>(shapes::bumpy_sphere(2, 4));
  std::vector<std::thread> threads;
  std::vector<std::size_t> found(4);
  for (std::size_t t = 0; t < found.size(); ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 20; ++i) {
        ::fcl::Transform3d place = ::fcl::Transform3d::Identity();
        place.translation().x() = 0.05 * i;
        ::fcl::CollisionResultd result;
        found[t] += lrb::fcl::collide(a.get(), ::fcl::Transform3d(::fcl::Transform3d::Identity()), a.get(),
                                      place, ::fcl::CollisionRequestd(100000), result);
      }
    });
  for (std::thread& t : threads) t.join();
  CHECK(found[0] > 0);
  CHECK(found == std::vector<std::size_t>(4, found[0]));
}

TEST_CASE("invalid bodies are rejected") {
  Mesh mesh = shapes::box();
  mesh.vertices[3].y() = std::numeric_limits<double>::infinity();
  const auto model = model_of<::fcl::AABBd>(mesh);
  const ::fcl::Transform3d home = ::fcl::Transform3d::Identity();
  ::fcl::CollisionResultd result;
  CHECK_THROWS_AS(lrb::fcl::collide(model.get(), home, model.get(), home, ::fcl::CollisionRequestd(), result),
                  InputError);
  CHECK(lrb::fcl::body_of(*model).error().reason.find("vertex 3") != std::string::npos);
}

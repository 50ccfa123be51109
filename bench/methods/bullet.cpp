// Bullet's GImpact meshes in a collision world: contactPairTest() calls back for each contact point, with its
// two triangles. Compiled for the precision of the linked library.
#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"

#ifdef LRB_HAS_BULLET
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#endif

namespace lrb::methods {
namespace {

class Bullet;
#ifdef BT_USE_DOUBLE_PRECISION
constexpr bool kSingle = false;
#define LRB_BULLET_METHODS bullet_double_methods
#else
constexpr bool kSingle = true;
#define LRB_BULLET_METHODS bullet_methods
#endif

#ifdef LRB_HAS_BULLET

struct BulletBody : MethodBody {
  std::vector<btScalar> vertices;
  std::vector<int> corners;
  std::unique_ptr<btTriangleIndexVertexArray> arrays;
  std::unique_ptr<btGImpactMeshShape> shape;
  std::unique_ptr<btCollisionObject> object;
};

btTransform transform(const Pose& p) {
  const auto s = [](double x) { return static_cast<btScalar>(x); };
  return btTransform(btMatrix3x3(s(p.r(0, 0)), s(p.r(0, 1)), s(p.r(0, 2)), s(p.r(1, 0)), s(p.r(1, 1)),
                                 s(p.r(1, 2)), s(p.r(2, 0)), s(p.r(2, 1)), s(p.r(2, 2))),
                     btVector3(s(p.t.x()), s(p.t.y()), s(p.t.z())));
}

/// Collects the triangles of contact points.
struct Gatherer : btCollisionWorld::ContactResultCallback {
  explicit Gatherer(const btCollisionObject* first) : a(first) {}
  btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper* object0, int, int index0,
                           const btCollisionObjectWrapper*, int, int index1) override {
    const bool in_order = object0->getCollisionObject() == a;
    pairs.push_back({static_cast<SimplexId>(in_order ? index0 : index1),
                     static_cast<SimplexId>(in_order ? index1 : index0)});
    return 0;
  }
  const btCollisionObject* a;
  std::vector<SimplexPair> pairs;
};

class Bullet : public MethodOf<BulletBody> {
 public:
  Bullet() : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    // Also required: contactPairTest() uses a second table, and reports no contact without an entry there.
    dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE, GIMPACT_SHAPE_PROXYTYPE, &create_);
  }

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    const Triangles t = triangles_of(rep);
    if (kSingle) check_fits_float(t);
    auto body = std::make_unique<BulletBody>();
    for (const Eigen::Vector3d& v : t.vertices)
      for (int k = 0; k < 3; ++k) body->vertices.push_back(static_cast<btScalar>(v[k]));
    for (const auto& c : t.triangles)
      for (const VertexId v : c) body->corners.push_back(static_cast<int>(v));
    body->arrays = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(t.triangles.size()), body->corners.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(t.vertices.size()), body->vertices.data(), static_cast<int>(3 * sizeof(btScalar)));
    body->shape = std::make_unique<btGImpactMeshShape>(body->arrays.get());
    body->shape->setMargin(0);
    body->shape->updateBound();
    body->object = std::make_unique<btCollisionObject>();
    body->object->setCollisionShape(body->shape.get());
    return body;
  }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    btCollisionObject *object_a = a.body.object.get(), *object_b = b.body.object.get();
    object_a->setWorldTransform(transform(a.pose));
    object_b->setWorldTransform(transform(b.pose));
    Answer answer;
    const Stopwatch watch;
    Gatherer gatherer(object_a);
    world_.contactPairTest(object_a, object_b, gatherer);
    answer.microseconds = watch.microseconds();
    sort_pairs(gatherer.pairs);
    answer.pairs = std::move(gatherer.pairs);
    answer.contact = !answer.pairs.empty();
    if (mode == Mode::first_pair && answer.contact) answer.pairs.resize(1);
    return answer;
  }

 private:
  btGImpactCollisionAlgorithm::CreateFunc create_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_;
};

#endif

}  // namespace

std::vector<MethodEntry> LRB_BULLET_METHODS() {
  std::string version;
#ifdef LRB_HAS_BULLET
  version = " " + std::to_string(BT_BULLET_VERSION / 100) + "." + std::to_string(BT_BULLET_VERSION % 100);
#endif
  const std::string precision =
      kSingle ? "Single precision, Bullet's default; cases beyond its range are skipped. "
              : "Debian's build in double precision. ";
  return {entry_of<Bullet>(
      {.name = kSingle ? "bullet" : "bullet-double",
       .title = "Bullet" + version + ", GImpact, " + (kSingle ? "float" : "double"),
       .remark =
           "All pairs: contactPairTest() of two btGImpactMeshShapes with margin 0; one pair per contact point. It "
           "treats contact as penetration and therefore also lists triangles behind each other: these are "
           "counted, but wrong only if the bodies are disjoint. " +
           precision + "Does not look for bodies inside bodies; 3D only.",
       .traits = {Trait::hard_cases, Trait::loose},
       .style = {"Bullet", "#cc79a7", "rectRot"},
       .rank = kSingle ? 50 : 100},
      "libbullet-dev")};
}

}  // namespace lrb::methods

// FCL's BVHModel with OBBRSS nodes, as its README recommends for the collision of two meshes: collide() with
// unlimited contacts, without their positions. It is compiled twice: against the packaged library, with the
// packages' flags, and (LRB_FCL_HEADERS) with all of FCL's templates instantiated here, with lrbscope's
// flags.
#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"

#ifdef LRB_HAS_FCL
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>

#include "bench/methods/fcl_models.hpp"
#define LRB_FCL "FCL " FCL_VERSION ", OBBRSS, "
#else
#define LRB_FCL "FCL, OBBRSS, "
#endif

namespace lrb::methods {
namespace {

template <class S>
class Fcl;

#ifdef LRB_HAS_FCL

template <class S>
struct FclBody : MethodBody {
  explicit FclBody(const Triangles& t) : model(model_of<fcl::OBBRSS<S>>(t)) {}
  fcl::BVHModel<fcl::OBBRSS<S>> model;
};

template <class S>
class Fcl : public MethodOf<FclBody<S>> {
 public:
  using typename MethodOf<FclBody<S>>::Posed;

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    const Triangles t = triangles_of(rep);
    if constexpr (std::is_same_v<S, float>) check_fits_float(t);
    return std::make_unique<FclBody<S>>(t);
  }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    const fcl::CollisionRequest<S> request(mode == Mode::all_pairs ? kAll : 1, false);
    const Stopwatch watch;
    fcl::CollisionResult<S> result;
    fcl::collide(&a.body.model, transform<S>(a.pose), &b.body.model, transform<S>(b.pose), request, result);
    Answer answer;
    answer.microseconds = watch.microseconds();
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      const fcl::Contact<S>& c = result.getContact(i);
      answer.pairs.push_back({static_cast<SimplexId>(c.b1), static_cast<SimplexId>(c.b2)});
    }
    sort_pairs(answer.pairs);
    answer.contact = result.isCollision();
    return answer;
  }

  /// Runs the traversal as fcl::collide() does, with FCL's own statistics.
  std::optional<TestCounts> tests_of(const Posed& a, const Posed& b) override {
    const fcl::CollisionRequest<S> request(kAll, false);
    fcl::CollisionResult<S> result;
    fcl::detail::MeshCollisionTraversalNodeOBBRSS<S> node;
    if (!fcl::detail::initialize(node, a.body.model, transform<S>(a.pose), b.body.model, transform<S>(b.pose),
                                 request, result))
      return std::nullopt;
    node.enableStatistics(true);
    fcl::detail::collide(&node);
    return TestCounts{static_cast<std::uint64_t>(node.num_bv_tests),
                      static_cast<std::uint64_t>(node.num_leaf_tests)};
  }

 private:
  static constexpr std::size_t kAll = std::size_t{1} << 40;  // contacts
};

#endif

MethodInfo fcl_info(const char* name, const char* title, const char* remark, int rank) {
  return {.name = name, .title = title, .remark = remark, .style = {"FCL", "#d55e00", "rect"}, .rank = rank};
}

}  // namespace

#ifdef LRB_FCL_HEADERS

std::vector<MethodEntry> fcl_headers_methods() {
  MethodInfo info =
      fcl_info("fcl-headers", LRB_FCL "double, compiled with our flags",
               "As fcl, but instantiated from its headers with lrbscope's compiler flags.", 110);
  info.traits = {};
  info.role = Role::aim;
  return {entry_of<Fcl<double>>(info, "libfcl-dev")};
}

#else

std::vector<MethodEntry> fcl_methods() {
  return {
      entry_of<Fcl<double>>(
          fcl_info(
              "fcl", LRB_FCL "double",
              "All pairs: collide() of two BVHModel<OBBRSS>, contacts unlimited, without their positions. Does not "
              "look for bodies inside bodies; 3D only.",
              30),
          "libfcl-dev"),
      entry_of<Fcl<float>>(
          fcl_info("fcl-float", LRB_FCL "float",
                   "As fcl, with coordinates rounded to float; cases beyond its range are skipped.", 31),
          "libfcl-dev")};
}

#endif

}  // namespace lrb::methods

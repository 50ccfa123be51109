// Embree's rtcCollide: a dual traversal of two trees of triangle boxes. A callback gets the contents of
// overlapping leaves and tests the triangles, as in Embree's own example. Its boxes are in world coordinates,
// so the tree of a moved body must be refitted or rebuilt before the query.
#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include <lrbscope/error.hpp>

#ifdef LRB_HAS_EMBREE
#include <embree3/rtcore.h>
#define LRB_EMBREE "Embree " RTC_VERSION_STRING
#else
#define LRB_EMBREE "Embree"
#endif

namespace lrb::methods {
namespace {

template <bool kRebuilds>
class Embree;

#ifdef LRB_HAS_EMBREE

class Device {
 public:
  Device() : device_(rtcNewDevice("threads=1,set_affinity=0")) {
    if (device_ == nullptr) throw EnvironmentError("Embree cannot create a device");
  }
  ~Device() { rtcReleaseDevice(device_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  operator RTCDevice() const { return device_; }

 private:
  RTCDevice device_;
};

struct EmbreeBody : MethodBody {
  EmbreeBody(std::shared_ptr<Device> d, Triangles t, RTCBuildQuality quality)
      : device(std::move(d)), shape(std::move(t)), moved(shape.vertices) {
    scene = rtcNewScene(*device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_DYNAMIC);
    geometry = rtcNewGeometry(*device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(shape.triangles.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcCommitScene(scene);
  }
  ~EmbreeBody() override {
    rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
  }

  void move(const Pose& pose) {
    for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = pose.apply(shape.vertices[v]);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
    rtcCommitScene(scene);
    at = pose;
  }
  /// A body that has not moved needs no update.
  void move_to(const Pose& pose) {
    if (at.r != pose.r || at.t != pose.t) move(pose);
  }
  void corners(unsigned s, Eigen::Vector3d out[3]) const {
    for (int k = 0; k < 3; ++k) out[k] = moved[shape.triangles[s][static_cast<std::size_t>(k)]];
  }

  static void bounds(const RTCBoundsFunctionArguments* a) {
    const auto& body = *static_cast<const EmbreeBody*>(a->geometryUserPtr);
    Eigen::Vector3d c[3];
    body.corners(a->primID, c);
    const Eigen::Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]);
    const Eigen::Vector3d high = c[0].cwiseMax(c[1]).cwiseMax(c[2]);
    RTCBounds& b = *a->bounds_o;
    b.lower_x = static_cast<float>(low.x());
    b.lower_y = static_cast<float>(low.y());
    b.lower_z = static_cast<float>(low.z());
    b.upper_x = static_cast<float>(high.x());
    b.upper_y = static_cast<float>(high.y());
    b.upper_z = static_cast<float>(high.z());
  }

  std::shared_ptr<Device> device;
  Triangles shape;
  std::vector<Eigen::Vector3d> moved;
  Pose at;
  RTCScene scene = nullptr;
  RTCGeometry geometry = nullptr;
};

/// Input and output of the callback.
struct Candidates {
  const EmbreeBody *a, *b;
  std::vector<SimplexPair> pairs;
  std::uint64_t tests = 0;

  static void add(void* user, RTCCollision* found, unsigned count) {
    auto& self = *static_cast<Candidates*>(user);
    self.tests += count;
    Eigen::Vector3d p[3], q[3];
    for (unsigned i = 0; i < count; ++i) {
      const SimplexPair pair{SimplexId(found[i].primID0), SimplexId(found[i].primID1)};
      self.a->corners(pair.a, p);
      self.b->corners(pair.b, q);
      if (plain_triangles_meet(p, q)) self.pairs.push_back(pair);
    }
  }
};

template <bool kRebuilds>
class Embree : public MethodOf<EmbreeBody, false> {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    Triangles t = triangles_of(rep);
    check_fits_float(t);
    return std::make_unique<EmbreeBody>(device_, std::move(t),
                                        kRebuilds ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_REFIT);
  }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    // Only the method's own copies of the bodies are moved.
    auto& body_a = const_cast<EmbreeBody&>(a.body);
    auto& body_b = const_cast<EmbreeBody&>(b.body);
    body_a.move_to(a.pose);
    Answer answer;
    Candidates candidates{&body_a, &body_b, {}};
    const Stopwatch watch;
    body_b.move(b.pose);
    rtcCollide(body_a.scene, body_b.scene, Candidates::add, &candidates);
    answer.microseconds = watch.microseconds();
    sort_pairs(candidates.pairs);
    answer.pairs = std::move(candidates.pairs);
    answer.face_tests = candidates.tests;
    answer.contact = !answer.pairs.empty();
    if (mode == Mode::first_pair && answer.contact) answer.pairs.resize(1);
    return answer;
  }

 private:
  std::shared_ptr<Device> device_ = std::make_shared<Device>();
};

#endif

template <bool kRebuilds>
MethodEntry entry(const char* name) {
  const std::string how = kRebuilds ? "rebuilt by the fastest builder" : "refitted";
  return entry_of<Embree<kRebuilds>>(
      {.name = name,
       .title = std::string(LRB_EMBREE ", rtcCollide, ") + (kRebuilds ? "rebuilt" : "refitted"),
       .remark =
           "All pairs: rtcCollide() of two scenes of triangles' boxes, the triangles tested in the callback in double "
           "with an epsilon; it cannot stop at the first pair. Body B moves at every query, and its tree is " +
           how + ", which is part of the time.",
       .traits = {},
       .style = {"Embree", "#b58900", "rectOpen"},
       .rank = kRebuilds ? 61 : 60},
      "libembree-dev");
}

}  // namespace

std::vector<MethodEntry> embree_methods() {
  return {entry<false>("embree"), entry<true>("embree-rebuilt")};
}

}  // namespace lrb::methods

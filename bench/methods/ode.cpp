// ODE's triangle meshes: dCollide() of two of them returns contact points, each with its two triangles.
#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"

#ifdef LRB_HAS_ODE
#include <ode/ode.h>
#endif

namespace lrb::methods {
namespace {

class Ode;

#ifdef LRB_HAS_ODE

constexpr int kMaxContacts = 0xffff;  // the maximum that its flags can request

struct OdeBody : MethodBody {
  explicit OdeBody(const Triangles& t) {
    for (const Eigen::Vector3d& v : t.vertices)
      for (int k = 0; k < 3; ++k) vertices.push_back(static_cast<float>(v[k]));
    for (const auto& c : t.triangles)
      for (const VertexId v : c) corners.push_back(v);
    data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data, vertices.data(), 3 * sizeof(float), static_cast<int>(t.vertices.size()),
                                corners.data(), static_cast<int>(corners.size()), 3 * sizeof(dTriIndex));
    geom = dCreateTriMesh(nullptr, data, nullptr, nullptr, nullptr);
  }
  ~OdeBody() override {
    dGeomDestroy(geom);
    dGeomTriMeshDataDestroy(data);
  }
  void move(const Pose& p) const {
    dMatrix3 r;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) r[4 * i + j] = static_cast<dReal>(p.r(i, j));
      r[4 * i + 3] = 0;
    }
    dGeomSetRotation(geom, r);
    dGeomSetPosition(geom, static_cast<dReal>(p.t.x()), static_cast<dReal>(p.t.y()),
                     static_cast<dReal>(p.t.z()));
  }
  std::vector<float> vertices;
  std::vector<dTriIndex> corners;
  dTriMeshDataID data = nullptr;
  dGeomID geom = nullptr;
};

class Ode : public MethodOf<OdeBody> {
 public:
  Ode() : contacts_(kMaxContacts) { dInitODE2(0); }
  ~Ode() override { dCloseODE(); }

  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    const Triangles t = triangles_of(rep);
    check_fits_float(t);
    return std::make_unique<OdeBody>(t);
  }

  Answer ask(const Posed& a, const Posed& b, Mode mode) override {
    a.body.move(a.pose);
    const int flags = mode == Mode::all_pairs ? kMaxContacts : static_cast<int>(CONTACTS_UNIMPORTANT | 1U);
    Answer answer;
    const Stopwatch watch;
    b.body.move(b.pose);
    const int n = dCollide(a.body.geom, b.body.geom, flags, contacts_.data(), sizeof(dContactGeom));
    answer.microseconds = watch.microseconds();
    for (int i = 0; i < n; ++i) {
      const dContactGeom& c = contacts_[static_cast<std::size_t>(i)];
      const bool in_order = c.g1 == a.body.geom;
      if (c.side1 < 0 || c.side2 < 0) continue;  // represents several pairs
      answer.pairs.push_back({static_cast<SimplexId>(in_order ? c.side1 : c.side2),
                              static_cast<SimplexId>(in_order ? c.side2 : c.side1)});
    }
    sort_pairs(answer.pairs);
    answer.contact = n > 0;
    return answer;
  }

 private:
  std::vector<dContactGeom> contacts_;
};

#endif

}  // namespace

std::vector<MethodEntry> ode_methods() {
  MethodInfo info = {
      .name = "ode",
      .title = "ODE, triangle meshes",
      .remark =
          "Pairs of the contact points of dCollide(), at most 65535; a contact point may represent several "
          "pairs, so the list is not meant to be complete. Trees and vertices in float.",
      .traits = {Trait::loose},
      .style = {"ODE", "#7f3c8d", "cross"},
      .rank = 70};
#ifdef LRB_HAS_ODE
  info.title += sizeof(dReal) == sizeof(double) ? ", double" : ", float";
#endif
  return {entry_of<Ode>(info, "libode-dev")};
}

}  // namespace lrb::methods

#include "engine/core/error.hpp"
#include "scenarios/methods/body_parts.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/plain_tests.hpp"

namespace lrb::methods {
namespace {

struct PlainBody : MethodBody {
  int dim = 3;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<VertexId> corners;  ///< (|simplices| x dim)
};

/// Returns the corners in the world, simplex by simplex.
std::vector<Eigen::Vector3d> in_world(const PlainBody& body, const Pose& pose) {
  std::vector<Eigen::Vector3d> moved, out;
  for (const Eigen::Vector3d& v : body.vertices) moved.push_back(pose.apply(v));
  for (const VertexId v : body.corners) out.push_back(moved[v]);
  return out;
}

class PlainDouble : public Method {
 public:
  std::unique_ptr<MethodBody> build(const LrbRep& rep) override {
    auto body = std::make_unique<PlainBody>();
    body->dim = rep.dim();
    body->vertices.assign(rep.vertices().begin(), rep.vertices().end());
    VertexId v[3];
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      rep.simplex(s, v);
      body->corners.insert(body->corners.end(), v, v + rep.simplex_size());
    }
    return body;
  }

  MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                     Mode mode) override {
    const auto& body_a = static_cast<const PlainBody&>(a);
    const auto& body_b = static_cast<const PlainBody&>(b);
    const std::size_t n = static_cast<std::size_t>(body_a.dim);
    MethodAnswer answer;
    const Stopwatch watch;
    const std::vector<Eigen::Vector3d> p = in_world(body_a, pose_a), q = in_world(body_b, pose_b);
    for (std::size_t i = 0; i < p.size() && !(mode == Mode::first_pair && answer.contact); i += n)
      for (std::size_t j = 0; j < q.size(); j += n) {
        const bool meet = n == 3 ? plain_triangles_meet(&p[i], &q[j]) : plain_segments_meet(&p[i], &q[j]);
        if (!meet) continue;
        answer.contact = true;
        answer.pairs.push_back({static_cast<SimplexId>(i / n), static_cast<SimplexId>(j / n)});
        if (mode == Mode::first_pair) break;
      }
    answer.microseconds = watch.microseconds();
    return answer;
  }
};

}  // namespace

std::vector<MethodEntry> plain_double_methods() {
  MethodInfo info;
  info.rank = 20;
  info.style = {"brute force", "#6b6b6b", "crossRot", 2};
  info.name = "plain";
  info.role = Role::no_peer;  // takes minutes
  info.title = "brute force, double, epsilon 1e-6";
  info.remark =
      "Every pair of triangles by Moeller's test of intervals (1997) with its usual epsilon; 2D: by sides. "
      "No "
      "boxes, no relation.";
  info.plane = info.moves_exactly = true;
  return {{info, []() -> std::unique_ptr<Method> { return std::make_unique<PlainDouble>(); }}};
}

}  // namespace lrb::methods

#include <iostream>

#include "engine/construct/build.hpp"
#include "engine/query/collide.hpp"
#include "engine/query/collide_probe.hpp"

lrb::LrbRep body(const Eigen::MatrixX3d& v, const Eigen::MatrixX3i& f) {  // vertices, triangles
  lrb::Mesh mesh;
  for (Eigen::Index i = 0; i < v.rows(); ++i) mesh.vertices.push_back(v.row(i).transpose());
  for (Eigen::Index i = 0; i < f.rows(); ++i) {
    const lrb::VertexId corners[3] = {lrb::VertexId(f(i, 0)), lrb::VertexId(f(i, 1)), lrb::VertexId(f(i, 2))};
    mesh.add_face(corners);
  }
  return lrb::build_lrb(mesh);
}

/// Counts what it is told.
struct Counter : lrb::CollideProbe {
  void contact(lrb::SimplexId, lrb::SimplexId, lrb::exact::Meet) override { ++contacts; }
  std::size_t contacts = 0;
};

int main() {
  Eigen::MatrixX3d v(4, 3);
  v << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  Eigen::MatrixX3i f(4, 3);
  f << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  const lrb::LrbRep a = body(v, f), b = body(v, f);
  lrb::CollideRequest request;
  request.contacts = true;
  const lrb::CollideResult r =
      lrb::collide(a, lrb::Pose{}, b, lrb::Pose::translation({0.25, 0.1, 0.05}), request);
  std::cout << lrb::to_string(r.relation) << " " << r.pairs.size() << " " << r.regions.size() << "\n";
  Counter probe;
  lrb::collide(a, lrb::Pose{}, b, lrb::Pose::translation({0.25, 0.1, 0.05}), request, probe);
  if (probe.contacts != r.pairs.size()) return 2;
  return r.relation == lrb::Relation::crossing && !r.regions.empty() ? 0 : 1;
}

#include <iostream>
#include <vector>

#include <lrbscope/body.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/scene.hpp>
#include <lrbscope/workspace.hpp>

namespace {

/// Counts reports.
struct Counter : lrb::CollideProbe {
  void contact(lrb::SimplexId, lrb::SimplexId, lrb::exact::Meet) override { ++contacts; }
  std::size_t contacts = 0;
};

}  // namespace

int main() {
  Eigen::MatrixX3d v(4, 3);
  v << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  Eigen::MatrixX3i f(4, 3);
  f << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  const lrb::Expected<lrb::Body> made = lrb::Body::from(v, f);
  if (!made) return 1;
  const lrb::Body& body = *made;
  const lrb::Pose pose = lrb::pose_of(Eigen::Isometry3d(Eigen::Translation3d(0.25, 0.1, 0.05)));

  lrb::CollideRequest request;
  request.contacts = true;
  lrb::Workspace workspace;
  const auto r = lrb::collide(body, lrb::Pose{}, body, pose, request, workspace);
  if (!r || r->relation != lrb::Relation::crossing || r->regions.empty()) return 2;
  Counter probe;
  lrb::collide(body, lrb::Pose{}, body, pose, request, probe);
  if (probe.contacts != r->pairs.size()) return 3;
  const auto answers = lrb::collide(body, lrb::Pose{}, body, std::vector<lrb::Pose>(100, pose));
  if (answers.size() != 100 || answers[99]->pairs != r->pairs) return 4;
  lrb::Scene scene;
  scene.add(body);
  scene.add(body, pose);
  if (scene.collide().size() != 1) return 5;
  f(2, 2) = 7;
  std::cout << lrb::Body::from(v, f).error().reason << "\n";
}

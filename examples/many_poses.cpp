// many_poses A B RADIUS: queries 1000 poses of B on a circle around A, on all cores and one by one.
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <numbers>
#include <vector>

#include <lrbscope/body.hpp>
#include <lrbscope/workspace.hpp>

int main(int argc, char** argv) try {
  if (argc != 4) throw lrb::InputError("usage: many_poses A B RADIUS");
  const lrb::Body a = lrb::Body::load(argv[1]).value();
  const lrb::Body b = lrb::Body::load(argv[2]).value();
  const lrb::Pose pose_a;
  std::vector<lrb::Pose> poses_b;
  for (int i = 0; i < 1000; ++i) {
    const double r = std::atof(argv[3]), angle = 2 * std::numbers::pi * i / 1000;
    poses_b.push_back(lrb::Pose::rotation({0, 0, 1}, angle, {r * std::cos(angle), r * std::sin(angle), 0}));
  }

  // All cores. Results are in the order of the poses and do not depend on the number of threads.
  const lrb::CollideAnswers batch = lrb::collide(a, pose_a, b, poses_b);

  // One thread. The workspace keeps its memory, so that later queries do not allocate. The result stays in
  // it.
  lrb::Workspace workspace;
  int collisions = 0, equal = 0;
  for (std::size_t i = 0; i < poses_b.size(); ++i) {
    const lrb::CollideResult& result = lrb::collide(a, pose_a, b, poses_b[i], {}, workspace).value();
    if (!result.pairs.empty()) ++collisions;
    if (result.pairs == batch[i].value().pairs) ++equal;
  }
  std::cout << collisions << " of " << batch.size() << " poses collide, " << equal << " results are equal\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 1;
}

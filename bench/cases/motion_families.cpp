// Families of bodies that move in steps, with rounding in each step: sliding and resting contact, passing
// through a thin sheet, moving away and back.
#include <Eigen/Geometry>

#include "bench/cases/families.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::cases {
namespace {

using Eigen::Vector3d;

/// B slides along A's upper side, and perhaps turns on it: one of the first 10,000 steps. Each step is added
/// to the pose of the last one.
Case make_slide(RandomEngine& random, double difficulty) {
  // A slab, and tiles side by side, whose edges B passes.
  static const Body kFloors[] = {
      body(shapes::box({-4, -4, -4}, {4, 4, 0})),
      body(shapes::translated(shapes::voxels(6, 6, 1, [](int, int, int) { return true; }), {-3, -3, -1}))};
  static const Body kSliders[] = {body(shapes::box()), body(shapes::quad_box()), body(shapes::l_shape()),
                                  body(shapes::tetrahedron()), body(shapes::comb(3))};
  static constexpr int kSteps = 10'000;
  Case c;
  c.a = kFloors[random() % std::size(kFloors)];
  c.b = kSliders[random() % std::size(kSliders)];
  const int steps = pick(random, 1, kSteps);
  const double angle = uniform(random, 0, 6.3);
  Vector3d step = 4.0 / kSteps * Vector3d(deterministic::cos(angle), deterministic::sin(angle), 0);
  Vector3d begin(0, 0, 0);
  for (int k = 0; k < 2; ++k) begin[k] = uniform(random, -2, 2);
  if (pick(random, 0, 2) == 0) {  // along the edges of the tiles, on the grid
    step = {4.0 / kSteps, 0, 0};
    begin = {-2, static_cast<double>(pick(random, -2, 2)), 0};
  }
  const bool turns = pick(random, 0, 2) == 0, tilted = pick(random, 0, 2) == 0;
  const double deviation = random() % 2 ? slack(difficulty) : -slack(difficulty);
  begin.z() = deviation;
  const Pose scene = tilted ? any_pose(random) : Pose{};
  const Pose turn = Pose::rotation(scene.r * Vector3d(0, 0, 1), turns ? 1e-4 : 0);
  c.pose_a = scene;
  c.pose_b = {scene.r, scene.r * begin + scene.t};
  const Vector3d by = scene.r * step;
  for (int i = 0; i < steps; ++i) {
    c.pose_b.t += by;
    if (turns) c.pose_b.r = turn.r * c.pose_b.r;
  }
  return c;
}

/// B near a sheet that its motion (question_of() of numbers) passes through. B and the thickness shrink:
/// between two steps B is on either side.
Case make_tunnel(RandomEngine& random, double difficulty) {
  static const Mesh kBullets[] = {shapes::tetrahedron(), shapes::box(), shapes::icosphere(0, 0.5)};
  const double size = 0.3 * deterministic::pow10(-4 * difficulty);
  Case c;
  Mesh sheet = shapes::box({-1, -1, -0.5}, {1, 1, 0.5});
  for (Vector3d& v : sheet.vertices) v.z() *= size;
  c.a = body(sheet);
  c.b = body(shapes::scaled(kBullets[random() % std::size(kBullets)], size));
  c.pose_b.r = random() % 2 ? shapes::random_rotation(random) : grid_turn(random);
  for (int k = 0; k < 2; ++k) c.pose_b.t[k] = uniform(random, -0.3, 0.3);
  // Beyond the sheet, in it, or before it, by a few sizes.
  c.pose_b.t.z() = size * (random() % 2 ? pick(random, -3, 3) * 0.5 : uniform(random, -3, 3));
  if (pick(random, 0, 2) == 0) move_both(c, any_pose(random));
  return c;
}

/// Bodies in contact. B makes up to 1,000 moves, and then their inverses in reverse order.
Case make_drift(RandomEngine& random, double difficulty) {
  static constexpr int kMoves = 1000;
  Case c;
  c.a = any_body(random);
  const int kind = pick(random, 0, 2);
  if (kind == 0) {  // the same body
    c.b = c.a;
  } else {
    c.b = any_body(random);
    const Vector3d onto = c.a->vertices()[random() % c.a->vertices().size()];
    c.pose_b.r = kind == 1 ? grid_turn(random) : shapes::random_rotation(random);
    const Vector3d from = c.pose_b.r * c.b->vertices()[random() % c.b->vertices().size()];
    c.pose_b.t = onto - from;
  }
  loosen(random, c, slack(difficulty));
  std::vector<Pose> moves;
  for (int i = pick(random, 1, kMoves); i > 0; --i) moves.push_back(any_pose(random));
  Pose& b = c.pose_b;
  for (const Pose& m : moves) b = {m.r * b.r, m.r * b.t + m.t};
  while (!moves.empty()) {
    const Pose& m = moves.back();
    b = {m.r.transpose() * b.r, m.r.transpose() * (b.t - m.t)};
    moves.pop_back();
  }
  return c;
}

}  // namespace

std::vector<Family> motion_families() {
  return {
      {"slide", "a body that rests and slides on another: one of 10,000 steps", make_slide,
       "0.1 above or in the floor", "on the floor", false, 72, slack_value},
      {"tunnel", "a small body and a thin sheet that its motion passes through", make_tunnel, "size 0.3",
       "size 3e-5", false, 74,
       [](double difficulty) { return rounded_value(0.3 * deterministic::pow10(-4 * difficulty)); }},
      {"drift", "a body that is moved up to 1,000 times, and moved back", make_drift, "0.1 from contact",
       "in contact before the moves", false, 76, slack_value},
  };
}

}  // namespace lrb::cases

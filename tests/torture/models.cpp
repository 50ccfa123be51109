#include "tests/torture/models.hpp"

#include <algorithm>
#include <cmath>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::torture {
namespace {

using namespace cases;
using Eigen::Vector3d;

double diameter(const LrbRep& rep) {
  return shapes::box_of(rep).diagonal().norm();
}

bool in_contact(const cases::Case& c) {
  static QueryContext context;
  NullProbe probe;
  CollideRequest request;
  request.mode = Mode::first_pair;
  return !collide(*c.a, c.pose_a, *c.b, c.pose_b, request, context, probe).pairs.empty();
}

/// Moves B along a direction until a step decides between contact and none; at the end the distance is known
/// to reach / 2^steps.
void stop_at_contact(cases::Case& c, const Vector3d& away, double reach, int steps, bool inside) {
  const Vector3d start = c.pose_b.t;
  double near = 0, far = reach;
  if (!in_contact(c)) near = -reach;  // through and out on the other side
  for (int i = 0; i < steps; ++i) {
    const double midpoint = 0.5 * (near + far);
    c.pose_b.t = start + midpoint * away;
    (in_contact(c) ? near : far) = midpoint;
  }
  c.pose_b.t = start + (inside ? near : far) * away;
}

}  // namespace

void Models::load(const std::filesystem::path& folder) {
  for (const char* name : {"spot", "homer", "fandisk", "cheburashka", "rocker-arm", "nefertiti"}) {
    const auto file = folder / (std::string(name) + ".obj");
    if (!std::filesystem::exists(file)) continue;
    Mesh mesh = read_mesh(file.string());
    Eigen::AlignedBox3d box;
    for (const auto& v : mesh.vertices) box.extend(v);
    const double by = std::exp2(-std::ilogb(box.diagonal().norm()));
    mesh = shapes::scaled(shapes::translated(mesh, -box.center()), by);
    bodies_.push_back(std::make_shared<LrbRep>(build_lrb(mesh)));
    if (mesh.face_count() < 10000)
      bodies_.push_back(std::make_shared<LrbRep>(build_lrb(shapes::scaled(mesh, 1.0 / 16))));
  }
  std::stable_sort(bodies_.begin(), bodies_.end(), [](const cases::Body& a, const cases::Body& b) {
    return a->real_face_count() < b->real_face_count();
  });
}

cases::Case Models::make(RandomEngine& random, double difficulty) const {
  // The largest model costs ten times the others: seldom.
  const auto model = [&] {
    const std::size_t most = random() % 8 ? std::max<std::size_t>(1, bodies_.size() - 1) : bodies_.size();
    return bodies_[random() % most];
  };
  cases::Case c{model(), random() % 4 ? model() : cases::any_body(random), {}, {}, {}, {}};
  if (random() % 4 == 0) c.pose_a = cases::any_pose(random, 1);
  const Pose rough = shapes::random_pose(random, *c.a, *c.b, 0.5 * uniform(random));
  c.pose_b.r = c.pose_a.r * rough.r;
  c.pose_b.t = c.pose_a.apply(rough.t);
  const double size = diameter(*c.a) + diameter(*c.b);
  const Vector3d away = shapes::random_direction(random);
  const int kind = cases::pick(random, 0, 7);
  if (kind == 0) return c;  // as it comes: mostly deep
  stop_at_contact(c, away, size, static_cast<int>(8 + 48 * difficulty), random() % 2 != 0);
  const double little = size * std::pow(10, -2 - 12 * difficulty) * uniform(random);
  if (kind == 1) c.pose_b.t += little * away;
  if (kind == 2) c.pose_b.t -= little * away;
  // Not as far as where the answer becomes quadratic, as faces become points.
  if (kind == 3)
    cases::move_both(c, {shapes::random_rotation(random),
                         std::pow(10, 9 * difficulty) * shapes::random_direction(random)});
  return c;
}

}  // namespace lrb::torture

// Families with coordinates of very different magnitudes: thin, distant, tiny, huge, or transformed by
// unusual matrices.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "bench/cases/families.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::cases {
namespace {

using Eigen::Vector3d;

Body stretched(const LrbRep& rep, const Vector3d& by) {
  Mesh m = rep.real_mesh();
  for (Vector3d& v : m.vertices) v = v.cwiseProduct(by);
  return body(m);
}

Body moved(const LrbRep& rep, const Vector3d& by) {
  return body(shapes::translated(rep.real_mesh(), by));
}

/// Returns a vector in any direction, `low` to `high` long.
Vector3d random_step(RandomEngine& random, double low, double high) {
  const double length = uniform(random, low, high);
  return length * shapes::random_direction(random);
}

Vector3d random_sign_vector(RandomEngine& random, double size) {
  Vector3d v;
  for (int k = 0; k < 3; ++k) v[k] = size * pick(random, -1, 1);
  return v;
}

Case make_sliver(RandomEngine& random, double difficulty) {
  const double thin = deterministic::pow10(-8 * difficulty);
  const auto shape = [&] {
    const int kind = pick(random, 0, 2);
    return kind == 0 ? Vector3d(1, 1, thin) : kind == 1 ? Vector3d(1, thin, thin) : Vector3d(1, thin, 1);
  };
  const auto any_stretched = [&] {
    const Body straight = any_body(random);
    return stretched(*straight, shape());
  };
  Case c{any_stretched(), any_stretched(), {}, {}, {}, {}};
  const int kind = pick(random, 0, 2);
  if (kind == 0) c.pose_b = any_pose(random, 0.5);
  if (kind == 1) c.pose_b.t = random_step(random, 0, 3 * thin);
  if (kind == 2) c.pose_b = {grid_turn(random), random_sign_vector(random, 0.5)};
  loosen(random, c, 0.1 * thin);
  if (pick(random, 0, 2) == 0) move_both(c, any_pose(random));
  return c;
}

/// Boxes flat against each other, side by side, crossing or rotated, all by the scale of their thickness.
Case make_thin(RandomEngine& random, double difficulty) {
  const double thin = deterministic::pow10(-1 - 11 * difficulty);
  const LrbRep cube = *body(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  const Body sheet = stretched(cube, {1, 1, thin}), rod = stretched(cube, {1, thin, thin});
  const auto shape = [&] { return pick(random, 0, 1) == 0 ? sheet : rod; };
  Case c{shape(), shape(), {}, {}, {}, {}};
  const int kind = pick(random, 0, 3);
  if (kind == 0) c.b = stretched(cube, Vector3d(1, 1, 1));
  c.pose_b.r = kind == 3 ? shapes::random_rotation(random) : grid_turn(random);
  for (int k = 0; k < 3; ++k) c.pose_b.t[k] = uniform(random, -0.4, 0.4);
  if (kind == 1 || kind == 2) {
    // A few thicknesses separate or penetrating: over A's large face, or beside it.
    const int k = kind == 1 ? 2 : 0;
    const auto reach = [&] {
      double max_a = 0, max_b = 0;
      for (const Vector3d& v : c.a->vertices()) max_a = std::max(max_a, std::abs(v[k]));
      for (const Vector3d& v : c.b->vertices()) max_b = std::max(max_b, std::abs((c.pose_b.r * v)[k]));
      return max_a + max_b;
    };
    c.pose_b.t[k] = reach() + thin * uniform(random, -0.5, 2);
  }
  if (pick(random, 0, 3) == 0) move_both(c, any_pose(random));
  return c;
}

Case make_zero_area(RandomEngine& random, double difficulty) {
  const auto collapsed = [&](const LrbRep& rep) {
    Mesh m = rep.real_mesh();
    for (int times = pick(random, 1, 4); times > 0; --times) {
      const auto corners = m.face(static_cast<FaceId>(random() % m.face_count()));
      const std::size_t k = random() % corners.size();
      Vector3d& v = m.vertices[corners[k]];
      const Vector3d next = m.vertices[corners[(k + 1) % corners.size()]],
                     last = m.vertices[corners[(k + 2) % corners.size()]];
      const Vector3d onto = random() % 2 ? next : Vector3d((next + last) / 2);  // a point or a segment
      v = onto + slack(difficulty) * (v - onto);
    }
    return body(m, true);
  };
  Case c{collapsed(*any_body(random)), collapsed(*any_body(random)), {}, {}, {}, {}};
  if (random() % 2) c.pose_a = any_pose(random);
  c.pose_b.r = random() % 2 ? shapes::random_rotation(random) : grid_turn(random);
  // A vertex of one close to a vertex of the other.
  const Vector3d x = c.pose_a.apply(c.a->vertices()[random() % c.a->vertices().size()]);
  const Vector3d y = c.pose_b.r * c.b->vertices()[random() % c.b->vertices().size()];
  c.pose_b.t = x - y + slack(difficulty) * shapes::random_direction(random);
  if (random() % 2) c.pose_b.t += 0.3 * shapes::random_direction(random);
  return c;
}

Case make_far(RandomEngine& random, double difficulty) {
  const double offset = deterministic::pow10(16 * difficulty);
  Case c{any_body(random), any_body(random), {}, {}, {}, {}};
  const double size = random() % 2 ? 4 : 1;  // at 1e16 an ulp is 2: small faces collapse
  c.a = stretched(*c.a, Vector3d::Constant(size));
  c.b = stretched(*c.b, Vector3d::Constant(size));
  c.pose_b =
      random() % 2 ? any_pose(random, 2 * size) : Pose{grid_turn(random), random_sign_vector(random, size)};
  loosen(random, c, 0.1);  // the difficulty is the distance alone: rounding restores exact contact
  const Vector3d away =
      random() % 2 ? random_sign_vector(random, offset) : Vector3d(offset * shapes::random_direction(random));
  const int kind = pick(random, 0, 3);
  if (kind == 0) {
    c.pose_a.t += away;
    c.pose_b.t += away;
  } else if (kind == 1) {
    move_both(c, {shapes::random_rotation(random), away});
  } else if (kind == 2) {  // far from their own origins, near the world's
    c.a = moved(*c.a, away);
    c.b = moved(*c.b, away);
    c.pose_b.t += away - c.pose_b.r * away;
  } else {
    c.b = moved(*c.b, away);
    c.pose_b.t -= c.pose_b.r * away;
  }
  return c;
}

Case make_scale(RandomEngine& random, double difficulty) {
  const double exponent = 120 * difficulty * (random() % 2 ? 1 : -1);
  const double by =
      random() % 2 ? deterministic::pow10(exponent) : deterministic::exp2(std::floor(exponent * 3.3));
  Case c{any_body(random), any_body(random), {}, {}, {}, {}};
  c.pose_b = random() % 2 ? any_pose(random, 1.5) : Pose{grid_turn(random), random_sign_vector(random, 0.5)};
  loosen(random, c, std::max(1e-12, 0.1 * (1 - difficulty)));
  c.a = stretched(*c.a, Vector3d::Constant(by));
  c.b = stretched(*c.b, Vector3d::Constant(by));
  c.pose_b.t *= by;
  return c;
}

Case make_extreme(RandomEngine& random, double difficulty) {
  static constexpr double kSizes[] = {8,     1e-30,  1e30,  1e-90,  1e90,  1e-150, 1e150,  1e-200,
                                      1e200, 1e-290, 1e290, 1e-305, 1e305, 1e-308, 1e307,  1e-310,
                                      4e307, 1e-315, 8e307, 1e-319, 5e307, 4e-322, 1.6e308};
  static constexpr int kLast = static_cast<int>(std::size(kSizes)) - 1, kWindow = 6;
  const int most = static_cast<int>(kLast * difficulty);
  const auto size = [&] { return kSizes[pick(random, std::max(0, most - kWindow), most)]; };
  const double by = size(), by_b = pick(random, 0, 3) ? by : size();
  Case c{any_body(random), any_body(random), {}, {}, {}, {}};
  c.pose_b = random() % 2 ? any_pose(random, 1) : Pose{grid_turn(random), random_sign_vector(random, 0.5)};
  loosen(random, c, slack(difficulty));
  // The bodies are up to 7 wide; they are divided first, so that the meshes themselves stay finite.
  c.a = stretched(*stretched(*c.a, Vector3d::Constant(0.125)), Vector3d::Constant(by));
  c.b = stretched(*stretched(*c.b, Vector3d::Constant(0.125)), Vector3d::Constant(by_b));
  c.pose_b.t *= random() % 4 ? 0.125 * by : by;  // the second overflows sometimes: a rejection
  if (pick(random, 0, 2) == 0) c.pose_a.r = shapes::random_rotation(random);
  return c;
}

Case make_ratio(RandomEngine& random, double difficulty) {
  const double by = deterministic::pow10(-(random() % 3 ? 12 : 60) * difficulty);
  Case c{any_body(random), any_body(random), {}, {}, {}, {}};
  c.b = stretched(*c.b, Vector3d::Constant(by));
  VertexId v[3] = {};
  c.a->simplex(static_cast<SimplexId>(random() % c.a->real_simplex_count()), v);
  const Vector3d p = c.a->vertices()[v[0]], q = c.a->vertices()[v[1]], r = c.a->vertices()[v[2]];
  const double s = random() % 2 ? uniform(random) : 0, t = random() % 2 ? uniform(random, 0, 1 - s) : 0;
  c.pose_b.r = random() % 2 ? shapes::random_rotation(random) : grid_turn(random);
  c.pose_b.t = p + s * (q - p) + t * (r - p) + random_step(random, 0, 2 * by);
  if (pick(random, 0, 2) == 0) move_both(c, any_pose(random));
  if (random() % 2) {
    std::swap(c.a, c.b);
    std::swap(c.pose_a, c.pose_b);
  }
  return c;
}

/// Bodies of three parts whose sizes differ; smaller parts are on the surface of larger ones.
Case make_mixture(RandomEngine& random, double difficulty) {
  const double by = deterministic::pow10(-6 * difficulty);
  const auto mixed = [&] {
    static const Mesh kParts[] = {shapes::box(), shapes::quad_box(), shapes::icosphere(0, 0.5),
                                  shapes::l_shape()};
    std::vector<Mesh> parts = {kParts[random() % 2]};
    for (const double size : {deterministic::pow10(-3 * difficulty), by}) {
      const double x = uniform(random), y = uniform(random);
      const Vector3d at(x, y, random() % 2 ? 1 : 1 + size);
      parts.push_back(shapes::translated(shapes::scaled(kParts[random() % std::size(kParts)], size), at));
    }
    return body(shapes::several(parts), true);
  };
  Case c;
  c.a = mixed();
  c.b = mixed();
  c.pose_b.r = random() % 2 ? shapes::random_rotation(random) : grid_turn(random);
  // A vertex of one close to a vertex of the other.
  const Vector3d x = c.a->vertices()[random() % c.a->vertices().size()];
  const Vector3d y = c.pose_b.r * c.b->vertices()[random() % c.b->vertices().size()];
  c.pose_b.t = x - y + random_step(random, 0, 2 * by);
  if (pick(random, 0, 2) == 0) move_both(c, any_pose(random));
  return c;
}

Case make_matrix(RandomEngine& random, double difficulty) {
  Case c{any_body(random), any_body(random), {}, {}, {}, {}};
  const double strength = deterministic::pow10(6 * difficulty - 3);
  const auto matrix = [&]() -> Eigen::Matrix3d {
    const Eigen::Matrix3d r = shapes::random_rotation(random);
    const int kind = pick(random, 0, 5);
    if (kind == 0) return r * (1 + strength);
    if (kind == 1) return r * Vector3d(1, 1 + strength, 1 / (1 + strength)).asDiagonal() * r.transpose();
    if (kind == 2) return r + strength * Eigen::Matrix3d::Identity() * uniform(random);
    if (kind == 3) return r * Vector3d(1, 1, -1).asDiagonal();
    if (kind == 4) return r * Vector3d(1, 1, difficulty > 0.5 ? 0 : strength).asDiagonal();  // flattened
    return r / (1 + strength);
  };
  c.pose_a.r = matrix();
  c.pose_b.r = matrix();
  // Aims a vertex of one approximately at a vertex of the other.
  const Vector3d x = c.pose_a.r * c.a->vertices()[random() % c.a->vertices().size()];
  const Vector3d y = c.pose_b.r * c.b->vertices()[random() % c.b->vertices().size()];
  c.pose_b.t = x - y + (0.5 + x.norm()) * random_step(random, 0.02, 0.3);
  return c;
}

}  // namespace

std::vector<Family> scale_families() {
  return {
      {"sliver", "needles and sheets", make_sliver, "aspect 1", "aspect 1e8", false, 80,
       [](double difficulty) { return rounded_value(deterministic::pow10(8 * difficulty)); }},
      {"thin", "sheets and rods: flat on each other, side by side, crossing, rotated", make_thin,
       "thickness 0.1", "thickness 1e-12", false, 85,
       [](double difficulty) { return rounded_value(deterministic::pow10(-1 - 11 * difficulty)); }},
      {"zero-area", "faces that collapse to segments and points", make_zero_area, "corners 0.1 from collapse",
       "no area at all", false, 90, slack_value},
      {"far", "far from the origin of the world or of the bodies", make_far, "1 from the origin",
       "1e16 from the origin", false, 100,
       [](double difficulty) { return rounded_value(deterministic::pow10(16 * difficulty)); }},
      {"scale", "tiny and huge", make_scale, "size 1", "size 1e-120 or 1e120", false, 110,
       [](double difficulty) { return rounded_value(deterministic::pow10(120 * difficulty)); }},
      {"extreme", "tiny and huge up to the limits of double, and beyond", make_extreme, "size 1",
       "size 4e-322 or 1.6e308", false, 120},
      {"ratio", "bodies of different sizes", make_ratio, "equal sizes", "sizes 1e12 or 1e60 apart", false,
       130, [](double difficulty) { return rounded_value(deterministic::pow10(12 * difficulty)); }},
      {"mixture", "parts of different sizes in each body", make_mixture, "equal sizes", "sizes 1e6 apart",
       false, 135, [](double difficulty) { return rounded_value(deterministic::pow10(6 * difficulty)); }},
      {"matrix", "poses that scale, shear, reflect or flatten", make_matrix, "by 1e-3", "by 1e3, or flat",
       false, 140, [](double difficulty) { return rounded_value(deterministic::pow10(6 * difficulty - 3)); }},
  };
}

}  // namespace lrb::cases

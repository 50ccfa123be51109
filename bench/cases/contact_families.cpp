// Families in which bodies share points, edges or faces, or come as close to it as doubles allow.
#include <numbers>

#include <Eigen/Geometry>

#include "bench/cases/families.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::cases {
namespace {

using Eigen::Vector3d;

bool in_contact(const Case& c) {
  CollideRequest request;
  request.mode = Mode::first_pair;
  return !collide(*c.a, c.pose_a, *c.b, c.pose_b, request).pairs.empty();
}

/// The corners of a random real simplex.
std::array<Vector3d, 3> any_triangle(RandomEngine& random, const LrbRep& rep) {
  VertexId v[3] = {};
  rep.simplex(static_cast<SimplexId>(random() % rep.real_simplex_count()), v);
  return {rep.vertices()[v[0]], rep.vertices()[v[1]], rep.vertices()[v[2]]};
}

Mesh tetrahedron(const std::array<Vector3d, 4>& p) {
  Mesh m = shapes::tetrahedron();
  m.vertices.assign(p.begin(), p.end());
  const bool inside_out = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) < 0;
  return inside_out ? shapes::turned_inside_out(m) : m;
}

/// A prism of `layers` rotated slices about z, whose section is an `n`-gon of radius r: the core of a screw.
std::vector<Vector3d> twisted_rings(int n, int layers, double r, double twist, double height) {
  std::vector<Vector3d> x;
  for (int j = 0; j <= layers; ++j)
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n + twist * j / layers;
      x.emplace_back(r * deterministic::cos(angle), r * deterministic::sin(angle), height * j / layers);
    }
  return x;
}

void add_mantle(Mesh& m, int base, int n, int layers, bool inward) {
  const auto at = [&](int i, int j) { return static_cast<VertexId>(base + j * n + i % n); };
  const auto add = [&](VertexId p, VertexId q, VertexId r) {
    const VertexId f[3] = {p, inward ? r : q, inward ? q : r};
    m.add_face(f);
  };
  for (int j = 0; j < layers; ++j)
    for (int i = 0; i < n; ++i) {
      add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
}

Mesh screw(int n, int layers, double twist) {
  Mesh m;
  m.name = "screw";
  m.vertices = twisted_rings(n, layers, 0.5, twist, 2);
  add_mantle(m, 0, n, layers, false);
  std::vector<VertexId> low, high;
  for (int i = 0; i < n; ++i) {
    low.push_back(static_cast<VertexId>(n - 1 - i));
    high.push_back(static_cast<VertexId>(layers * n + i));
  }
  m.add_face(low);
  m.add_face(high);
  return m;
}

Mesh nut(int n, int layers, double twist) {
  Mesh m;
  m.name = "nut";
  m.vertices = twisted_rings(n, layers, 0.5, twist, 2);
  const std::vector<Vector3d> outer = twisted_rings(n, layers, 1, twist, 2);
  const auto count = static_cast<int>(outer.size());
  m.vertices.insert(m.vertices.end(), outer.begin(), outer.end());
  add_mantle(m, 0, n, layers, true);
  add_mantle(m, count, n, layers, false);
  for (const bool top : {false, true})
    for (int i = 0; i < n; ++i) {
      const int ring = top ? layers * n : 0;
      const VertexId p(ring + i), q(ring + (i + 1) % n), outer_p(count + p), outer_q(count + q);
      const VertexId low[4] = {p, q, outer_q, outer_p}, high[4] = {p, outer_p, outer_q, q};
      if (top)
        m.add_face(high);
      else
        m.add_face(low);
    }
  return m;
}

Mesh cone(int n, double height) {
  return shapes::revolve({{0, 0}, {1, height}, {0, height}}, n);
}

Case make_touch(RandomEngine& random, double difficulty) {
  Case c{any_body(random), any_body(random), {}, any_pose(random), {}, {}};
  if (pick(random, 0, 3) == 0) c.pose_a = any_pose(random);
  const Vector3d away = shapes::random_direction(random);
  const auto vertex = [&](const LrbRep& rep, const Pose& pose) {
    return pose.apply(rep.vertices()[random() % rep.vertices().size()]);
  };
  const Vector3d from = vertex(*c.b, c.pose_b), onto = vertex(*c.a, c.pose_a) - from;
  if (!in_contact(c)) c.pose_b.t += onto;  // vertex on vertex
  const Vector3d start = c.pose_b.t;
  double near = 0, far = 12;  // no body is wider
  const int steps = static_cast<int>(6 + 54 * difficulty);
  for (int i = 0; i < steps; ++i) {
    const double midpoint = 0.5 * (near + far);
    c.pose_b.t = start + midpoint * away;
    (in_contact(c) ? near : far) = midpoint;
  }
  // Vertex on vertex at the initial position belongs to another family.
  c.pose_b.t = start + (random() % 2 && near > 0 ? near : far) * away;
  return c;
}

Case make_shared(RandomEngine& random, double difficulty) {
  Case c;
  c.a = any_body(random);
  std::array<Vector3d, 3> t = any_triangle(random, *c.a);
  const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
  const auto point_beside = [&] {
    const double along = uniform(random, -1, 1), across = uniform(random, -1, 1);
    const Vector3d v = t[0] + along * (t[1] - t[0]) + across * (t[2] - t[0]);
    return Vector3d(v + uniform(random, -0.2, 1) * n);
  };
  const int shared = pick(random, 1, 3);
  std::array<Vector3d, 4> p = {t[0], point_beside(), point_beside(), point_beside()};
  for (int i = 0; i < shared; ++i) p[i] = t[i];
  for (int i = 0; i < shared; ++i) p[i] += slack(difficulty) * shapes::random_direction(random);
  c.b = body(tetrahedron(p));
  if (random() % 2) c.pose_a = c.pose_b = any_pose(random);
  return c;
}

Case make_coplanar(RandomEngine& random, double difficulty) {
  static const std::vector<Body> kFlat = {body(shapes::box()), body(shapes::l_shape()), body(shapes::comb(3)),
                                          body(shapes::quad_box()), body(shapes::tetrahedron(2))};
  Case c{kFlat[random() % kFlat.size()], kFlat[random() % 4], {}, {}, {}, {}};
  const int turn = pick(random, 0, 2);
  const double angle = turn == 0   ? slack(difficulty)
                       : turn == 1 ? uniform(random, 0, 6.3)
                                   : pick(random, 0, 3) * std::numbers::pi / 2;
  c.pose_b = Pose::rotation({0, 0, 1}, angle);
  if (turn == 2) c.pose_b.r = c.pose_b.r.array().round();
  if (pick(random, 0, 2) == 0)
    c.pose_b.r = Pose::rotation({1, uniform(random), 0}, slack(difficulty)).r * c.pose_b.r;
  const double step = random() % 2 ? 0.5 : 1.0 / 3;
  c.pose_b.t = {step * pick(random, -3, 3), step * pick(random, -3, 3),
                static_cast<double>(pick(random, -1, 1))};
  c.pose_b.t.z() = nudged(c.pose_b.t.z(), pick(random, -1, 1));
  if (pick(random, 0, 2) == 0) c.pose_b.t.x() = nudged(c.pose_b.t.x(), pick(random, -1, 1));
  loosen(random, c, slack(difficulty));
  if (pick(random, 0, 3) == 0) move_both(c, any_pose(random));
  return c;
}

Case make_identical(RandomEngine& random, double difficulty) {
  Case c;
  c.a = c.b = any_body(random);
  c.pose_a = any_pose(random);
  const int kind = pick(random, 0, 3);
  if (kind == 0) c.pose_a = Pose{};
  c.pose_b = c.pose_a;
  if (kind == 1) {  // about the centre of the unit cube
    const Eigen::Matrix3d r = grid_turn(random);
    const Vector3d centre(0.5, 0.5, 0.5);
    c.pose_a = Pose{};
    c.pose_b = {r, centre - r * centre};
  }
  if (kind == 2) c.pose_b.r = c.pose_a.r * grid_turn(random);
  if (pick(random, 0, 2) == 0) {
    const int k = pick(random, 0, 2);
    c.pose_b.t[k] = nudged(c.pose_b.t[k], pick(random, -2, 2));
  }
  loosen(random, c, slack(difficulty));
  return c;
}

Case make_hub(RandomEngine& random, double difficulty) {
  // Tip on tip (kind 0) n^2 pairs intersect, so the maximum of 100 faces is rare.
  const int n = 3 + static_cast<int>((random() % 8 ? 21 : 97) * difficulty);
  static const Body kPoly = body(screw(64, 1, 0));
  Case c{body(cone(n, 1)), body(cone(pick(random, 3, n), 1)), {}, {}, {}, {}};
  const int kind = pick(random, 0, 3);
  if (kind == 0) c.pose_b.r = Vector3d(1, -1, -1).asDiagonal();  // tip on tip
  if (kind == 1) c.pose_b = any_pose(random, 0);                 // tips at one point, in any directions
  if (kind == 2) {
    c.b = kPoly;
    c.pose_b = {grid_turn(random), {0, 0, static_cast<double>(pick(random, -2, 2))}};
  }
  if (kind == 3) c.pose_b.t = {0, 0, static_cast<double>(pick(random, -2, 2)) / 2};
  const int k = pick(random, 0, 2);
  if (random() % 2) c.pose_b.t[k] = nudged(c.pose_b.t[k], pick(random, -1, 1));
  loosen(random, c, slack(difficulty));
  return c;
}

Case make_interlock(RandomEngine& random, double difficulty) {
  static const Body kComb = body(shapes::comb(4, 3)), kScrew = body(screw(5, 6, 2)),
                    kNut = body(nut(5, 6, 2));
  static const Body kLink =
      body(shapes::voxels(5, 3, 1, [](int i, int j, int) { return j != 1 || i % 4 == 0; }));
  Case c;
  const int kind = pick(random, 0, 2);
  if (kind == 0) {  // comb (width 7, depth 4) rotated by half a turn about z, teeth into the gaps
    c.a = c.b = kComb;
    c.pose_b.r = Vector3d(-1, -1, 1).asDiagonal();
    c.pose_b.t = {8, static_cast<double>(pick(random, 4, 8)), static_cast<double>(pick(random, -1, 1))};
  } else if (kind == 1) {  // a bar of one link through the slot of the other
    c.a = c.b = kLink;
    c.pose_b.r << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    const double step = random() % 2 ? 0.5 : 1;
    c.pose_b.t = {step * pick(random, -4, 4), 2, static_cast<double>(pick(random, -3, 1))};
  } else {
    c.a = kNut;
    c.b = kScrew;
    const double height = random() % 2 ? 0 : uniform(random, -1, 1);
    c.pose_b = Pose::rotation({0, 0, 1}, random() % 4 ? height : 0, {0, 0, height});
  }
  loosen(random, c, slack(difficulty));
  if (pick(random, 0, 3) == 0) move_both(c, any_pose(random));
  return c;
}

Case make_quadratic(RandomEngine& random, double difficulty) {
  const int n = 2 + static_cast<int>(4 * difficulty);
  std::vector<Mesh> across, along;
  for (int i = 0; i < n; ++i) {
    across.push_back(shapes::box({i + 0.25, 0, 0}, {i + 0.5, static_cast<double>(n), 1}));
    along.push_back(shapes::box({0, i + 0.25, 0}, {static_cast<double>(n), i + 0.5, 1}));
  }
  Case c{body(shapes::several(across)), body(shapes::several(along)), {}, {}, {}, {}};
  c.pose_b.t = {0, 0, random() % 2 ? 0 : uniform(random, -1, 1)};
  if (random() % 2) c.pose_b.r = Pose::rotation({1, 0, 0}, uniform(random, 0, 0.3)).r;
  loosen(random, c, slack(difficulty));
  if (pick(random, 0, 3) == 0) move_both(c, any_pose(random));
  return c;
}

/// Plates of A and of B in turns, each on the one below, shifted, and off by up to the slack and an ulp.
Case make_stack(RandomEngine& random, double difficulty) {
  const int plates = pick(random, 2, 5);
  std::vector<Mesh> of_a, of_b;
  for (int i = 0; i < 2 * plates; ++i) {
    const double x = pick(random, -2, 2) / 3.0, y = pick(random, -2, 2) / 3.0;
    double z[2] = {static_cast<double>(i), i + 1.0};
    for (double& side : z) {
      if (i % 2 == 0) continue;  // of A
      side += slack(difficulty) * uniform(random, -1, 1);
      side = nudged(side, pick(random, -1, 1));
    }
    (i % 2 == 0 ? of_a : of_b).push_back(shapes::box({x, y, z[0]}, {x + 2, y + 2, z[1]}));
  }
  Case c{body(shapes::several(of_a)), body(shapes::several(of_b)), {}, {}, {}, {}};
  loosen(random, c, slack(difficulty));
  if (pick(random, 0, 2) == 0) move_both(c, any_pose(random));
  return c;
}

}  // namespace

std::vector<Family> contact_families() {
  return {
      {"touch", "random bodies stopped within an ulp of contact", make_touch, "0.2 from first contact",
       "an ulp from first contact", false, 10,
       [](double difficulty) {
         return rounded_value(12 * deterministic::exp2(-static_cast<int>(6 + 54 * difficulty)));
       }},
      {"shared", "a face, edge or vertex in common, exactly or nearly", make_shared, "0.1 off",
       "in common exactly", false, 20, slack_value},
      {"coplanar", "face on face: shifted, rotated in the plane, tilted", make_coplanar,
       "0.1 off and tilted by 0.1", "in one plane, or an ulp off", false, 30, slack_value},
      {"stack", "plates of both bodies in turns, all nearly flush", make_stack, "0.1 off and tilted by 0.1",
       "flush, or an ulp off", false, 35, slack_value},
      {"identical", "the same body at the same pose, or under a symmetry", make_identical, "0.1 off",
       "the same pose, or an ulp off", false, 40, slack_value},
      {"hub", "many faces at a point; faces with many corners", make_hub, "3 faces, 0.1 off",
       "100 faces, exactly at the point", false, 50},
      {"interlock", "combs with all flanks in contact, chain links, screw in nut", make_interlock, "0.1 off",
       "all flanks in contact", false, 60, slack_value},
      {"quadratic", "every plate of one through every plate of the other", make_quadratic,
       "2 plates, 0.1 off", "6 plates, faces in one plane", false, 70},
  };
}

}  // namespace lrb::cases

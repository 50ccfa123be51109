// Families with answers known to the last ulp, and families of bodies with very many faces or corners.
#include <cmath>
#include <numbers>

#include "bench/cases/families.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/core/random.hpp>

namespace lrb::cases {
namespace {

using Eigen::Vector3d;

/// Makes a prism over a counter-clockwise polygon; each of its two ends is one polygon.
Mesh prism(const std::vector<shapes::Point2>& section, double height) {
  Mesh m;
  m.name = "prism";
  const auto n = static_cast<std::uint32_t>(section.size());
  for (const double z : {0.0, height})
    for (const auto& p : section) m.vertices.emplace_back(p.x(), p.y(), z);
  std::vector<VertexId> low, high;
  for (VertexId i = 0; i < n; ++i) {
    low.emplace_back(n - 1 - i);
    high.emplace_back(n + i);
    const VertexId j((i + 1) % n), side[4] = {i, j, VertexId(n + j), VertexId(n + i)};
    m.add_face(side);
  }
  m.add_face(low);
  m.add_face(high);
  return m;
}

std::vector<shapes::Point2> circle_section(int corners) {
  std::vector<shapes::Point2> p;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    p.emplace_back(deterministic::cos(angle), deterministic::sin(angle));
  }
  return p;
}

/// Makes a comb with teeth and gaps of width 1 / (2 * teeth): not convex.
std::vector<shapes::Point2> comb_section(int teeth) {
  std::vector<shapes::Point2> p = {{0, 0}, {1, 0}};
  const double width = 1.0 / (2 * teeth - 1);
  for (int i = teeth - 1; i >= 0; --i) {
    p.emplace_back((2 * i + 1) * width, 1);
    p.emplace_back(2 * i * width, 1);
    if (i == 0) break;
    p.emplace_back(2 * i * width, 0.25);
    p.emplace_back((2 * i - 1) * width, 0.25);
  }
  return p;
}

/// Makes the Menger sponge of 3^levels cells to a side, from [0, 1]^3.
Mesh menger(int levels) {
  const int n = static_cast<int>(std::lround(std::pow(3, levels)));
  const auto solid = [](int i, int j, int k) {
    for (; i + j + k > 0; i /= 3, j /= 3, k /= 3)
      if ((i % 3 == 1) + (j % 3 == 1) + (k % 3 == 1) > 1) return false;
    return true;
  };
  return shapes::scaled(shapes::voxels(n, n, n, solid), 1.0 / n);
}

/// Makes a cube of 7^3 cells with a square dent in each of its sides, `depth` cells deep, from [0, 1]^3.
Mesh dented_cube(int depth) {
  const auto solid = [=](int i, int j, int k) {
    const int x[3] = {i, j, k};
    for (int axis = 0; axis < 3; ++axis) {
      const int u = x[(axis + 1) % 3], v = x[(axis + 2) % 3];
      const bool in_dent = u >= 2 && u <= 4 && v >= 2 && v <= 4;
      if (in_dent && (x[axis] < depth || x[axis] >= 7 - depth)) return false;
    }
    return true;
  };
  return shapes::scaled(shapes::voxels(7, 7, 7, solid), 1.0 / 7);
}

Mesh cone(int n) {
  return shapes::revolve({{0, 0}, {1, 1}, {0, 1}}, n);
}

Case make_kiss(RandomEngine& random, double difficulty) {
  static const std::vector<Body> cubes = {body(shapes::box()), body(shapes::quad_box())};
  const double gap = deterministic::exp2(-std::round(4 + 48 * difficulty));  // at difficulty 1 an ulp of 1
  Case c{cubes[random() % 2], cubes[random() % 2], {}, {}, {}, {}};
  const int axes = pick(random, 1, 3);  // in contact along: a face, an edge, a vertex
  bool apart = false, touch = false;
  for (int k = 0; k < 3; ++k) {
    if (k >= axes) {
      c.pose_b.t[k] = (2 * pick(random, -4, 3) + 1) / 8.0;  // no coplanar sides
      continue;
    }
    const int gaps = uniform(random) < difficulty ? pick(random, -1, 1) : random() % 2 ? 1 : -1;
    c.pose_b.t[k] = 1 + gaps * gap;
    apart |= gaps > 0;
    touch |= gaps == 0;
  }
  if (apart) c.relation = Relation::separate;
  if (!apart && touch) c.relation = Relation::touching;
  c.interiors_overlap = !apart && !touch;
  // All operations are exact: a permutation of the axes, a change of signs, a power of two.
  const double size = deterministic::exp2(std::round(40 * difficulty * uniform(random, -1, 1)));
  const Pose by{size * grid_turn(random, true), Vector3d::Zero()};
  if (random() % 2) move_both(c, by);
  if (random() % 2) {
    std::swap(c.a, c.b);
    std::swap(c.pose_a, c.pose_b);
  }
  return c;
}

Case make_nested(RandomEngine& random, double difficulty) {
  const int walls = 2 + static_cast<int>(30 * difficulty);
  std::vector<Mesh> shells;
  for (int i = 0; i < walls; ++i) {  // from outside in: every second one faces inward
    const double reach = walls - i;
    const Mesh shell = random() % 4 ? shapes::box({-reach, -reach, -reach}, {reach, reach, reach})
                                    : shapes::quad_box({-reach, -reach, -reach}, {reach, reach, reach});
    shells.push_back(i % 2 ? shapes::turned_inside_out(shell) : shell);
  }
  const double near =
      1 - deterministic::pow10(-1 - 13 * difficulty);  // share of the available space that is used
  const double reach = 0.5 * near;
  const int layer = pick(random, 0, walls);  // 0: outside all of them
  const double position = walls - layer + 0.5;
  const auto piece = [&](double at) {
    return shapes::translated(shapes::box({-reach, -reach, -reach}, {reach, reach, reach}), {at, 0, 0});
  };
  const bool in_solid = layer % 2 == 1;
  Case c{body(shapes::several(shells)), {}, {}, {}, {}, {}};
  // Other pieces are outside: it is enough if one is enclosed.
  const int pieces = pick(random, 1, 3);
  std::vector<Mesh> all = {piece(position)};
  for (int i = 1; i < pieces; ++i) all.push_back(piece(-walls - 2.0 * i));
  c.b = body(shapes::several(all));
  c.relation = in_solid ? Relation::b_inside_a : Relation::separate;
  c.interiors_overlap = in_solid;
  // The outside piece of B must not contain any part of A: it is a box without a cavity.
  if (random() % 2) move_both(c, {grid_turn(random, true), Vector3d::Zero()});
  if (random() % 2) {
    std::swap(c.a, c.b);
    std::swap(c.pose_a, c.pose_b);
    if (in_solid) c.relation = Relation::a_inside_b;
  }
  return c;
}

Case make_polygon(RandomEngine& random, double difficulty) {
  // 8 to 4096 corners; and the same number in a comb, whose ends are not convex.
  static const std::vector<Body> kRound = [] {
    std::vector<Body> list;
    for (int n = 8; n <= 4096; n *= 8) list.push_back(body(prism(circle_section(n), 1)));
    return list;
  }();
  static const std::vector<Body> kComb = [] {
    std::vector<Body> list;
    for (int n = 2; n <= 1024; n *= 8) list.push_back(body(prism(comb_section(n), 1)));
    return list;
  }();
  // The largest takes a hundred times as long as the others, so it is rare.
  const std::size_t largest = random() % 16 == 0 ? 3 : 2;
  const auto& bodies = uniform(random) < 0.5 * difficulty ? kComb : kRound;
  Case c{
      bodies[std::min(largest, static_cast<std::size_t>(4 * difficulty))], any_body(random), {}, {}, {}, {}};
  const int kind = uniform(random) < difficulty ? pick(random, 0, 2) : 3;
  if (kind == 0) {  // one many-cornered end on another: the answer is quadratic
    c.a = bodies[random() % 64 == 0];
    c.b = bodies[random() % 64 == 0];
    const double angle = random() % 2 ? 0 : uniform(random);
    c.pose_b = Pose::rotation({0, 0, 1}, angle, {0, 0, pick(random, -1, 1) * 1.0});
  } else if (kind == 1) {  // a body on top of an end
    c.pose_b = {grid_turn(random), {uniform(random, -1, 1), uniform(random, -1, 1), 1}};
  } else if (kind == 2) {  // at a corner of the section
    const auto v = c.a->vertices()[random() % c.a->vertices().size()];
    const auto w = c.b->vertices()[random() % c.b->vertices().size()];
    c.pose_b.r = random() % 2 ? grid_turn(random) : shapes::random_rotation(random);
    c.pose_b.t = v - c.pose_b.r * w;
  } else {
    c.pose_b = any_pose(random, 2);
  }
  if (kind != 3 && random() % 2) c.pose_b.t.z() = nudged(c.pose_b.t.z(), pick(random, -1, 1));
  if (pick(random, 0, 3) == 0) move_both(c, any_pose(random));
  return c;
}

Case make_fractal(RandomEngine& random, double difficulty) {
  static const Body kSponge = body(menger(2)), kHub = body(cone(400));
  static const std::vector<Body> dented = {body(dented_cube(1)), body(dented_cube(2)), body(menger(1))};
  static const std::vector<Body> probes = {body(shapes::scaled(shapes::box(), 1.0 / 9)),
                                           body(shapes::scaled(shapes::box(), 1.0 / 7)),
                                           body(shapes::scaled(shapes::icosphere(0), 0.1))};
  Case c{kSponge, probes[random() % 3], {}, {}, {}, {}};
  const int kind = pick(random, 0, 15);
  const double fine = deterministic::pow10(-17 * difficulty);
  if (kind < 8) {  // a plug for a hole of the sponge, of a dented cube
    if (kind % 2) c.a = dented[random() % 3];
    const double cell = 1.0 / (kind % 2 ? 7 : 9);
    c.pose_b = {grid_turn(random), cell * pick_point(random, {-1, -1, -1}, {9, 9, 9})};
    c.pose_b.t += fine * shapes::random_direction(random);
  } else if (kind < 14) {  // cube in dent, on the grid or nearly
    c.a = dented[random() % 3];
    c.b = dented[random() % 3];
    c.pose_b = {grid_turn(random), pick_point(random, {4, -8, -8}, {8, 8, 8}) / 7};
    c.pose_b.t += fine * shapes::random_direction(random);
  } else if (kind == 14) {  // hundreds of faces at a point, with a corner of the other body in it
    c.a = kHub;
    c.b = any_body(random);
    c.pose_b = any_pose(random, 0);
    const Vector3d corner = c.b->vertices()[random() % c.b->vertices().size()];
    c.pose_b.t = -(c.pose_b.r * corner);
  } else {
    c.b = random() % 8 ? dented[random() % 3] : kSponge;
    c.pose_b = any_pose(random, 1.5);
  }
  if (pick(random, 0, 3) == 0) move_both(c, any_pose(random));
  return c;
}

}  // namespace

std::vector<Family> large_families() {
  return {
      {"kiss", "cubes that share a face, an edge, a vertex; the same a gap apart, a gap inside", make_kiss,
       "gap 1/16", "gap 1 ulp", false, 210,
       [](double difficulty) {
         return rounded_value(deterministic::exp2(-std::round(4 + 48 * difficulty)));
       }},
      {"nested", "nested shells, solid by parity, with components in and between the walls", make_nested,
       "2 walls, 0.1 of the room left", "32 walls, 1e-14 of the room left", false, 220,
       [](double difficulty) { return rounded_value(deterministic::pow10(-1 - 13 * difficulty)); }},
      {"polygon", "faces with thousands of corners, convex and not", make_polygon, "8 corners, anywhere",
       "4096 corners, end to end", false, 230},
      {"fractal", "sponges, dented cubes and hubs of hundreds of faces against plugs that fit", make_fractal,
       "1 off the grid", "on the grid", false, 240},
  };
}

}  // namespace lrb::cases

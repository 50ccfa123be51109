// Families of awkward bodies: lattices, nested and defective ones, and cells of one grid, for which the
// answer is known.
#include <numbers>

#include "bench/cases/families.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/random.hpp>

namespace lrb::cases {
namespace {

using Eigen::Vector3d;

bool is_central(int i) {
  return i % 3 == 1;
}

Mesh menger() {
  return shapes::voxels(
      3, 3, 3, [](int i, int j, int k) { return is_central(i) + is_central(j) + is_central(k) < 2; });
}

/// A cube of 3^3 cells with a smaller cube at the centre of every face.
Mesh koch_cube() {
  const auto in = [](int i, int low, int high) { return i >= low && i < high; };
  return shapes::voxels(5, 5, 5, [=](int i, int j, int k) {
    const int core = in(i, 1, 4) + in(j, 1, 4) + in(k, 1, 4), central = (i == 2) + (j == 2) + (k == 2);
    return core == 3 || (core == 2 && central >= 2);
  });
}

Mesh lattice() {
  return shapes::voxels(5, 5, 3, [](int i, int j, int k) { return i % 2 + j % 2 + k % 2 < 2; });
}

/// The Koch snowflake with `levels` subdivisions, counter-clockwise.
Mesh koch_snowflake(int levels) {
  std::vector<Vector3d> p = {{0, 0, 0}, {1, 0, 0}, {0.5, std::numbers::sqrt3 / 2, 0}};
  const double c = 0.5, s = -std::numbers::sqrt3 / 2;
  for (; levels > 0; --levels) {
    std::vector<Vector3d> next;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vector3d a = p[i], third = (p[(i + 1) % p.size()] - a) / 3;
      const Vector3d turned(c * third.x() - s * third.y(), s * third.x() + c * third.y(), 0);
      next.insert(next.end(), {a, a + third, a + third + turned, a + 2 * third});
    }
    p.swap(next);
  }
  std::vector<shapes::Point2> corners;
  for (const Vector3d& x : p) corners.emplace_back(x.x(), x.y());
  return shapes::polygon(corners);
}

/// A random set of cells of an nx x ny x nz grid.
struct Cells {
  int n[3];
  std::vector<bool> solid;

  Cells(RandomEngine& random, int most, int depth, double share) {
    for (int& x : n) x = pick(random, 1, most);
    n[2] = std::min(n[2], depth);
    for (int i = 0; i < n[0] * n[1] * n[2]; ++i) solid.push_back(uniform(random) < share);
    solid[random() % solid.size()] = true;
  }
  bool holds(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2] && solid[(i * n[1] + j) * n[2] + k];
  }
  Mesh mesh(bool quads) const {
    return shapes::voxels(
        n[0], n[1], n[2], [&](int i, int j, int k) { return holds(i, j, k); }, quads);
  }
  /// The boundary of the layer k = 0 in the plane.
  Mesh outline() const {
    Mesh m;
    m.dim = 2;
    const auto edge = [&](int x0, int y0, int x1, int y1) {
      const auto v = static_cast<VertexId>(m.vertices.size());
      m.vertices.emplace_back(x0, y0, 0);
      m.vertices.emplace_back(x1, y1, 0);
      const VertexId f[2] = {v, VertexId(v + 1)};
      m.add_face(f);
    };
    for (int i = 0; i < n[0]; ++i)
      for (int j = 0; j < n[1]; ++j) {
        if (!holds(i, j, 0)) continue;
        if (!holds(i, j - 1, 0)) edge(i, j, i + 1, j);
        if (!holds(i + 1, j, 0)) edge(i + 1, j, i + 1, j + 1);
        if (!holds(i, j + 1, 0)) edge(i + 1, j + 1, i, j + 1);
        if (!holds(i - 1, j, 0)) edge(i, j + 1, i, j);
      }
    return merged(m);
  }

 private:
  static Mesh merged(const Mesh& in) {
    Mesh m;
    m.dim = 2;
    std::vector<VertexId> to;
    for (const Vector3d& v : in.vertices) {
      const auto known = std::find(m.vertices.begin(), m.vertices.end(), v);
      to.push_back(static_cast<VertexId>(known - m.vertices.begin()));
      if (known == m.vertices.end()) m.vertices.push_back(v);
    }
    for (FaceId f = 0; f < in.face_count(); ++f) {
      const VertexId corners[2] = {to[in.face(f)[0]], to[in.face(f)[1]]};
      m.add_face(corners);
    }
    return m;
  }
};

/// Returns true if a cell of `a` and a cell of `b`, moved by `shift`, have interior points in common; the
/// faces of B's cells are at their rounded positions.
bool share_a_cell(const Cells& a, const Cells& b, const Vector3d& shift) {
  const auto each = [](const Cells& c, auto visit) {
    for (int i = 0; i < c.n[0]; ++i)
      for (int j = 0; j < c.n[1]; ++j)
        for (int k = 0; k < c.n[2]; ++k)
          if (c.holds(i, j, k) && visit(Vector3d(i, j, k))) return true;
    return false;
  };
  return each(a, [&](const Vector3d& x) {
    return each(b, [&](const Vector3d& y) {
      const Vector3d low = y + shift, high = (y + Vector3d::Ones()) + shift;
      return (low.array() < x.array() + 1).all() && (x.array() < high.array()).all();
    });
  });
}

/// Half of the shifts are whole cells, the others half cells; small enough that grids of n cells intersect.
Vector3d grid_shift(RandomEngine& random, int n, bool flat) {
  const double step = random() % 2 ? 1 : 0.5;
  Vector3d s;
  for (int k = 0; k < 3; ++k)
    s[k] = step * pick(random, -static_cast<int>(n / step), static_cast<int>(n / step));
  if (flat) s.z() = 0;
  return s;
}

/// Exact motions keep the answer: rotations of the grid, integer translations and powers of two.
void move_exactly(RandomEngine& random, Case& c) {
  const double size = deterministic::exp2(pick(random, -3, 3));
  const Pose by{size * grid_turn(random, true), pick_point(random, {-9, -9, -9}, {9, 9, 9})};
  move_both(c, by);
}

Case make_lattice(RandomEngine& random, double difficulty) {
  static const std::vector<Body> kBodies = {body(menger()), body(koch_cube()), body(lattice())};
  Case c{kBodies[random() % 3], kBodies[random() % 3], {}, {}, {}, {}};
  const double steps[] = {1, 0.5, 1.0 / 3, slack(difficulty)};
  const double step = steps[random() % 4];
  c.pose_b = {grid_turn(random), step * pick_point(random, {-4, -4, -4}, {4, 4, 4})};
  c.pose_b.t += c.pose_b.r.cwiseMin(0).rowwise().sum() * -3;  // back over A
  loosen(random, c, slack(difficulty));
  if (pick(random, 0, 3) == 0) move_both(c, any_pose(random));
  if (pick(random, 0, 3) == 0) c.pose_b.r = shapes::random_rotation(random);
  return c;
}

Case make_dented(RandomEngine& random, double difficulty) {
  static const std::vector<Body> kBodies = {
      std::make_shared<LrbRep>(shapes::dented_box()),
      std::make_shared<LrbRep>(build_lrb(shapes::bumpy_sphere(1, 3, 0.4))),
      std::make_shared<LrbRep>(build_lrb(shapes::torus(8, 6))),
      std::make_shared<LrbRep>(build_lrb(shapes::comb(3))),
      std::make_shared<LrbRep>(build_lrb(koch_cube())),
  };
  Case c{kBodies[random() % kBodies.size()], kBodies[random() % kBodies.size()], {}, {}, {}, {}};
  c.pose_b = random() % 2 ? any_pose(random, 2)
                          : Pose{grid_turn(random), pick_point(random, {-3, -3, 1}, {3, 3, 1})};
  loosen(random, c, slack(difficulty));
  return c;
}

/// A ball or a box within this distance from the origin.
Body small_body(RandomEngine& random, double reach) {
  return body(random() % 2 ? shapes::icosphere(0, reach)
                           : shapes::box({-reach, -reach, -reach}, {reach, reach, reach}));
}

const Body& large_ball() {
  static const Body kBall = body(shapes::icosphere(1, 4));
  return kBall;
}

/// In the void, which is [4, 8]^3, or in the wall around it, which is [0, 4] thick.
Case about_a_void(RandomEngine& random, double near, bool in_wall) {
  static const Body kVoid = body(shapes::scaled(shapes::box_with_void(), 4));
  if (!in_wall)
    return {kVoid, small_body(random, 2 * near), {}, Pose::translation({6, 6, 6}), Relation::separate, false};
  return {kVoid,
          small_body(random, 2 * near),
          {},
          Pose::translation({2, uniform(random, 2, 10), 6}),
          Relation::b_inside_a,
          true};
}

/// In the core, between the shells or in the outer wall.
Case in_shells(RandomEngine& random, double near) {
  static const Body kShells = body(shapes::several(
      {shapes::box({-6, -6, -6}, {6, 6, 6}), shapes::turned_inside_out(shapes::box({-4, -4, -4}, {4, 4, 4})),
       shapes::box({-2, -2, -2}, {2, 2, 2})}));
  const int layer = pick(random, 0, 2);
  Case c{kShells, small_body(random, near), {}, {}, Relation::b_inside_a, true};
  c.pose_b.t = {layer == 0 ? uniform(random, -1, 1) : layer == 1 ? 3 : 5, 0, uniform(random, -1, 1)};
  if (layer == 1) {
    c.relation = Relation::separate;
    c.interiors_overlap = false;
  }
  return c;
}

/// One of B's three pieces is inside A.
Case one_piece_inside(RandomEngine& random) {
  const Mesh piece = shapes::icosphere(0, 0.5);
  const Body pieces = body(
      shapes::several({shapes::translated(piece, {9, 0, 0}), piece, shapes::translated(piece, {0, 9, 0})}));
  return {large_ball(), pieces, {}, any_pose(random, 1), Relation::b_inside_a, true};
}

/// Each body contains a piece of the other; the relation names A first.
Case each_holds_a_piece() {
  const Mesh big = shapes::icosphere(1, 3), tiny = shapes::icosphere(0, 0.5);
  return {body(shapes::several({big, shapes::translated(tiny, {20, 0, 0})})),
          body(shapes::several({shapes::translated(big, {20, 0, 0}), tiny})),
          {},
          {},
          Relation::a_inside_b,
          true};
}

/// `near`: share of the available space that is used.
Case containment_of_kind(int kind, RandomEngine& random, double near) {
  switch (kind) {
    case 0:
      return {large_ball(), small_body(random, 1), {}, any_pose(random, 1), Relation::b_inside_a, true};
    case 1:
    case 2:
      return about_a_void(random, near, kind == 2);
    case 3:
      return in_shells(random, near);
    case 4:
      return one_piece_inside(random);
    default:
      return each_holds_a_piece();
  }
}

Case make_containment(RandomEngine& random, double difficulty) {
  const double near = 1 - deterministic::pow10(-1 - 13 * difficulty);
  const int kind = pick(random, 0, 5);
  Case c = containment_of_kind(kind, random, near);
  if (random() % 2) move_both(c, near < 0.999 ? any_pose(random, 5) : Pose{grid_turn(random), {1, -2, 3}});
  if (kind != 5 && random() % 2) {
    std::swap(c.a, c.b);
    std::swap(c.pose_a, c.pose_b);
    if (c.relation == Relation::b_inside_a) c.relation = Relation::a_inside_b;
  }
  return c;
}

Case make_voxels(RandomEngine& random, double difficulty) {
  const int most = 2 + static_cast<int>(2 * difficulty);
  const Cells a(random, most, most, uniform(random, 0.2, 1)), b(random, most, most, uniform(random, 0.2, 1));
  Case c{body(a.mesh(random() % 2)), body(b.mesh(random() % 2)), {}, {}, {}, {}};
  c.pose_b.t = grid_shift(random, most, false);
  c.pose_b.t += slack(difficulty) * shapes::random_direction(random);
  c.interiors_overlap = share_a_cell(a, b, c.pose_b.t);
  if (random() % 2 && slack(difficulty) == 0) move_exactly(random, c);
  return c;
}

Case make_plane(RandomEngine& random, double difficulty) {
  static const std::vector<Body> kBodies = {body(shapes::star(5)),
                                            body(shapes::gear(6)),
                                            body(shapes::comb_2d(3)),
                                            body(shapes::ring_2d(12)),
                                            body(koch_snowflake(2)),
                                            body(shapes::l_shape_2d()),
                                            std::make_shared<LrbRep>(shapes::stairs_2d())};
  Case c{kBodies[random() % kBodies.size()], kBodies[random() % kBodies.size()], {}, {}, {}, {}};
  if (random() % 2) {
    const int most = 2 + static_cast<int>(4 * difficulty);
    const Cells a(random, most, 1, uniform(random, 0.2, 1)), b(random, most, 1, uniform(random, 0.2, 1));
    c.a = body(a.outline());
    c.b = body(b.outline());
    c.pose_b.t = grid_shift(random, most, true);
    c.pose_b.t += slack(difficulty) * shapes::random_direction(random);
    c.pose_b.t.z() = 0;
    c.interiors_overlap = share_a_cell(a, b, c.pose_b.t);
    return c;
  }
  if (random() % 2) {
    c.pose_b.r = shapes::random_rotation(random, 2);
    c.pose_b.t = {uniform(random, -2, 2), uniform(random, -2, 2), 0};
  } else {
    const double angle = std::numbers::pi / 3 * pick(random, 0, 5);
    c.pose_b = Pose::rotation({0, 0, 1}, angle, {pick(random, -3, 3) / 3.0, pick(random, -2, 2) / 2.0, 0});
    if (random() % 2) c.pose_b = Pose::translation(c.pose_b.t);
  }
  if (random() % 2) c.pose_b.t.x() = nudged(c.pose_b.t.x(), pick(random, -1, 1));
  loosen(random, c, slack(difficulty));
  return c;
}

Case make_dirty(RandomEngine& random, double difficulty) {
  const auto spoil = [&](Mesh m) {
    const double share = 0.3 * difficulty;
    Mesh out;
    out.vertices = m.vertices;
    for (FaceId f = 0; f < m.face_count(); ++f) {
      std::vector<VertexId> corners(m.face(f).begin(), m.face(f).end());
      const double r = uniform(random);
      if (r < share / 4) continue;                                         // a hole
      if (r < share / 2) std::swap(corners[0], corners[1]);                // flipped
      if (r > 1 - share / 4) corners[2] = corners[random() % 2];           // zero area
      if (r > 1 - share / 2 && r <= 1 - share / 4) out.add_face(corners);  // doubled
      out.add_face(corners);
    }
    if (out.face_count() == 0) out.add_face(m.face(0));
    return out;
  };
  const Mesh ball = shapes::icosphere(1);
  const Mesh crossing = shapes::several({shapes::icosphere(0), shapes::icosphere(0, 1, {0.7, 0.1, 0.2})});
  const Mesh meshes[] = {spoil(ball), spoil(shapes::box()), crossing, shapes::open_cylinder(6),
                         spoil(crossing)};
  Case c{body(meshes[random() % 5], true), body(meshes[random() % 5], true), {}, any_pose(random, 2), {}, {}};
  if (random() % 2) c.pose_b = {grid_turn(random), pick_point(random, {-2, -1, 0}, {2, 1, 0})};
  loosen(random, c, slack(difficulty));
  return c;
}

}  // namespace

std::vector<Family> body_families() {
  return {
      {"lattice", "lattices, Menger and Koch bodies on their grid", make_lattice, "0.1 off the grid",
       "on the grid", false, 150, slack_value},
      {"dented", "bodies with regions, made by hand and by the builder", make_dented, "0.1 off the grid",
       "on the grid", false, 160, slack_value},
      {"containment", "inside, in a cavity, in the wall around one, nested shells, enclosed components",
       make_containment, "0.1 of the room left", "1e-14 of the room left", false, 170,
       [](double difficulty) { return rounded_value(deterministic::pow10(-1 - 13 * difficulty)); }},
      {"voxels", "random cells of one grid: interiors overlap exactly if a cell is shared", make_voxels,
       "0.1 off the grid", "on the grid, or on half of it", false, 180, slack_value},
      {"plane", "2D bodies, random cells of one grid among them", make_plane, "0.1 off",
       "edges on edges, corners on corners", false, 190, slack_value},
      {"dirty", "open, duplicated, zero-area, flipped and crossing faces", make_dirty,
       "clean except for crossings, 0.1 off", "a third of the faces bad", false, 200,
       [](double difficulty) { return rounded_value(30 * difficulty) + " %"; }},
  };
}

}  // namespace lrb::cases

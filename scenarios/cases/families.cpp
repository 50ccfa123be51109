#include "scenarios/cases/families.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "engine/core/error.hpp"
#include "engine/core/fnv.hpp"
#include "engine/core/steady_math.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "scenarios/bodies/shapes/hand_made.hpp"
#include "scenarios/bodies/shapes/shapes.hpp"

namespace lrb::cases {
namespace {

constexpr Family kFamilies[] = {
    {"touch", "random bodies stopped within an ulp of contact", make_touch, "0.2 from first contact",
     "an ulp from first contact"},
    {"shared", "a face, edge or vertex in common, exactly or nearly", make_shared, "0.1 off",
     "in common exactly"},
    {"coplanar", "face on face: shifted, turned in the plane, tilted", make_coplanar,
     "0.1 off and tilted by 0.1", "in one plane, or an ulp off"},
    {"identical", "the same body at the same pose, or under a symmetry", make_identical, "0.1 off",
     "the same pose, or an ulp off"},
    {"hub", "many faces in a point; faces of many corners", make_hub, "3 faces, 0.1 off",
     "100 faces, exactly in the point"},
    {"interlock", "combs with all flanks in contact, chain links, screw in nut", make_interlock, "0.1 off",
     "all flanks in contact"},
    {"quadratic", "every plate of one through every plate of the other", make_quadratic, "2 plates, 0.1 off",
     "6 plates, faces in one plane"},
    {"sliver", "needles and sheets", make_sliver, "aspect 1", "aspect 1e8"},
    {"zero-area", "faces that collapse to segments and points", make_zero_area, "corners 0.1 from collapse",
     "no area at all"},
    {"far", "far from the world's or the bodies' own origin", make_far, "1 from the origin",
     "1e16 from the origin"},
    {"scale", "tiny and huge", make_scale, "size 1", "size 1e-120 or 1e120"},
    {"extreme", "tiny and huge to the ends of double, and beyond", make_extreme, "size 1",
     "size 4e-322 or 1.6e308"},
    {"ratio", "bodies of different sizes", make_ratio, "equal sizes", "sizes 1e12 or 1e60 apart"},
    {"matrix", "poses that scale, shear, reflect or flatten", make_matrix, "by 1e-3", "by 1e3, or flat"},
    {"lattice", "lattices, Menger and Koch bodies on their grid", make_lattice, "0.1 off the grid",
     "on the grid"},
    {"dented", "bodies with regions, made by hand and by the builder", make_dented, "0.1 off the grid",
     "on the grid"},
    {"containment", "inside, in a cavity, in the wall around one, nested shells, swallowed pieces",
     make_containment, "0.1 of the room left", "1e-14 of the room left"},
    {"voxels", "random cells of one grid: interiors overlap exactly if a cell is shared", make_voxels,
     "0.1 off the grid", "on the grid, or on half of it"},
    {"plane", "2D bodies, random cells of one grid among them", make_plane, "0.1 off",
     "edges on edges, corners on corners"},
    {"dirty", "open, duplicated, zero-area, turned and crossing faces", make_dirty,
     "clean but for crossings, 0.1 off", "a third of the faces bad"},
    {"kiss", "cubes that share a face, an edge, a vertex; the same a gap apart, a gap inside", make_kiss,
     "gap 1/16", "gap 1 ulp"},
    {"nested", "shell in shell in shell, solid by parity, with pieces in the walls and between them",
     make_nested, "2 walls, 0.1 of the room left", "32 walls, 1e-14 of the room left"},
    {"polygon", "faces with thousands of corners, convex and not", make_polygon, "8 corners, anywhere",
     "4096 corners, end to end"},
    {"fractal", "sponges, dented cubes and hubs of hundreds of faces against plugs that fit", make_fractal,
     "1 off the grid", "on the grid"},
    {"swapped", "cases of the others, asked both ways: is B against A the transpose of A against B?",
     make_swapped, "as theirs", "as theirs", true},
};

}  // namespace

std::span<const Family> all_families() {
  return kFamilies;
}

const Family* find_family(const std::string& name) {
  for (const Family& f : kFamilies)
    if (name == f.name) return &f;
  return nullptr;
}

double dial_value(int setting) {
  return static_cast<double>(setting) / (kDialSettings - 1);
}

RandomEngine case_random(const Family& family, std::uint64_t seed, std::uint64_t index) {
  Fnv64 h;
  h.add_bytes(family.name, std::strlen(family.name));
  h.add_value(seed);
  h.add_value(index);
  return RandomEngine(h.value());
}

Case make_case(const Family& family, std::uint64_t seed, int dial, std::uint64_t index) {
  if (dial < 0 || dial >= kDialSettings)
    throw InputError("dial setting " + std::to_string(dial) + ": use 0 (benign) to " +
                     std::to_string(kDialSettings - 1) + " (degenerate)");
  RandomEngine random = case_random(family, seed, index);
  return family.make(random, dial_value(dial));
}

Body body(const Mesh& mesh, bool self_intersecting) {
  return std::make_shared<LrbRep>(
      LrbRep::without_regions(mesh, check_mesh(mesh, false).bounds_solid, self_intersecting));
}

Body any_body(RandomEngine& random) {
  static const std::vector<Body> kBodies = {
      body(shapes::tetrahedron()), body(shapes::box()),
      body(shapes::l_shape()),     body(shapes::icosphere(0)),
      body(shapes::icosphere(1)),  body(shapes::bumpy_sphere(1, 5, 0.4)),
      body(shapes::torus(8, 5)),   body(shapes::comb(3)),
      body(shapes::quad_box()),    body(shapes::box_with_void()),
      body(shapes::bowl(7, 3)),    std::make_shared<LrbRep>(shapes::dented_box()),
  };
  return kBodies[random() % kBodies.size()];
}

Pose any_pose(RandomEngine& random, double distance) {
  // One after the other: compilers order operands differently.
  const Eigen::Matrix3d turn = shapes::random_rotation(random);
  const Eigen::Vector3d direction = shapes::random_direction(random);
  return {turn, distance * uniform(random) * direction};
}

void move_both(Case& c, const Pose& by) {
  for (Pose* p : {&c.pose_a, &c.pose_b}) *p = Pose{by.r * p->r, by.r * p->t + by.t};
}

double slack(double dial) {
  return dial >= 1 ? 0 : 0.1 * steady::pow10(-15 * dial / 0.9);
}

void loosen(RandomEngine& random, Case& c, double by) {
  const bool flat = c.a->dim() == 2;
  Eigen::Vector3d away = shapes::random_direction(random);
  const Eigen::Vector3d axis = flat ? Eigen::Vector3d::UnitZ() : shapes::random_direction(random);
  const double angle = by * uniform(random, -1, 1);
  if (by == 0) return;
  if (flat) away.z() = 0;
  c.pose_b.r = Pose::rotation(axis, angle).r * c.pose_b.r;
  c.pose_b.t += by * away;
}

Case make_swapped(RandomEngine& random, double dial) {
  while (true) {  // one of the other families
    const Family& f = kFamilies[random() % std::size(kFamilies)];
    if (!f.both_ways) return f.make(random, dial);
  }
}

double nudged(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, std::numeric_limits<double>::infinity());
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -std::numeric_limits<double>::infinity());
  return x;
}

int pick(RandomEngine& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}

Eigen::Vector3d pick_point(RandomEngine& random, const Eigen::Vector3i& low, const Eigen::Vector3i& high) {
  Eigen::Vector3d x;
  for (int k = 0; k < 3; ++k) x[k] = pick(random, low[k], high[k]);
  return x;
}

Eigen::Matrix3d grid_turn(RandomEngine& random, bool reflections) {
  std::array<int, 3> axis = {0, 1, 2};
  for (int i = 2; i > 0; --i) std::swap(axis[i], axis[pick(random, 0, i)]);
  Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) r(i, axis[i]) = random() % 2 ? 1 : -1;
  if (!reflections && r.determinant() < 0) r.row(0) = -r.row(0);
  return r;
}

}  // namespace lrb::cases

#include "scenarios/families/families.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/error.hpp"
#include "engine/lrb/fnv.hpp"
#include "engine/mesh/mesh_check.hpp"
#include "scenarios/shapes/hand_made.hpp"
#include "scenarios/shapes/shapes.hpp"

namespace lrb::families {
namespace {

constexpr Family kFamilies[] = {
    {"touch", "random bodies stopped within an ulp of contact", make_touch},
    {"shared", "a face, edge or vertex in common, exactly or ulps off", make_shared},
    {"coplanar", "face on face: shifted, turned in the plane, tilted by 1e-9 to 1e-17", make_coplanar},
    {"identical", "the same body at the same pose, or under a symmetry", make_identical},
    {"hub", "hundreds of faces in a point; faces of a hundred corners", make_hub},
    {"interlock", "combs with all flanks in contact, chain links, screw in nut", make_interlock},
    {"quadratic", "every plate of one through every plate of the other", make_quadratic},
    {"sliver", "needles to aspect 1e8, sheets to 1e-8", make_sliver},
    {"far", "1e6, 1e8 and 1e16 from the world's or the bodies' own origin", make_far},
    {"scale", "1e-120 to 1e120", make_scale},
    {"extreme", "denormals to 1e308", make_extreme},
    {"ratio", "sizes 1e12 and 1e60 apart", make_ratio},
    {"matrix", "poses that scale, shear, reflect or flatten", make_matrix},
    {"lattice", "lattices, Menger and Koch bodies on their grid", make_lattice},
    {"dented", "bodies with regions, made by hand and by the builder", make_dented},
    {"containment", "inside, in a cavity, in the wall around one, nested shells, swallowed pieces",
     make_containment},
    {"voxels", "random cells of one grid: interiors overlap exactly if a cell is shared", make_voxels},
    {"plane", "2D bodies, random cells of one grid among them", make_plane},
    {"dirty", "open, duplicated, zero-area, turned and crossing faces", make_dirty},
    {"kiss", "cubes that share a face, an edge, a vertex; the same a gap apart, a gap inside", make_kiss},
    {"nested", "shell in shell in shell, solid by parity, with pieces in the walls and between them",
     make_nested},
    {"polygon", "faces with thousands of corners, convex and not", make_polygon},
    {"fractal", "sponges, dented cubes and hubs of hundreds of faces against plugs that fit", make_fractal},
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

Random case_random(const Family& family, std::uint64_t seed, std::uint64_t index) {
  Fnv64 h;
  h.add_bytes(family.name, std::strlen(family.name));
  h.add_value(seed);
  h.add_value(index);
  return Random(h.value());
}

Case make_case(const Family& family, std::uint64_t seed, int dial, std::uint64_t index) {
  if (dial < 0 || dial >= kDialSettings)
    throw InputError("dial setting " + std::to_string(dial) + ": use 0 (benign) to " +
                     std::to_string(kDialSettings - 1) + " (degenerate)");
  Random random = case_random(family, seed, index);
  return family.make(random, dial_value(dial));
}

Body body(const Mesh& mesh, bool self_intersecting) {
  return std::make_shared<LrbRep>(
      LrbRep::without_regions(mesh, check_mesh(mesh, false).bounds_solid, self_intersecting));
}

Body any_body(Random& random) {
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

Pose any_pose(Random& random, double distance) {
  return {shapes::random_rotation(random), distance * uniform(random) * shapes::random_direction(random)};
}

void move_both(Case& c, const Pose& by) {
  for (Pose* p : {&c.pose_a, &c.pose_b}) *p = Pose{by.r * p->r, by.r * p->t + by.t};
}

double nudged(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, std::numeric_limits<double>::infinity());
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -std::numeric_limits<double>::infinity());
  return x;
}

int pick(Random& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}

Eigen::Matrix3d grid_turn(Random& random, bool reflections) {
  std::array<int, 3> axis = {0, 1, 2};
  for (int i = 2; i > 0; --i) std::swap(axis[i], axis[pick(random, 0, i)]);
  Eigen::Matrix3d r = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) r(i, axis[i]) = random() % 2 ? 1 : -1;
  if (!reflections && r.determinant() < 0) r.row(0) = -r.row(0);
  return r;
}

}  // namespace lrb::families

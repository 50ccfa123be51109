#include "bench/cases/families.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include <lrbscope/core/hash.hpp>
#include <lrbscope/core/random.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh_check.hpp>

namespace lrb::cases {
std::span<const Family> all_families() {
  static const std::vector<Family> kFamilies = registered_families();
  return kFamilies;
}

const Family* find_family(const std::string& name) {
  for (const Family& f : all_families())
    if (name == f.name) return &f;
  return nullptr;
}

double scaled_difficulty(int setting) {
  return static_cast<double>(setting) / (kDifficulties - 1);
}

RandomEngine case_random(const Family& family, std::uint64_t seed, std::uint64_t index) {
  Fnv64 h;
  h.add_bytes(family.name, std::strlen(family.name));
  h.add_value(seed);
  h.add_value(index);
  return RandomEngine(h.value());
}

Case make_case(const Family& family, std::uint64_t seed, int difficulty, std::uint64_t index) {
  if (difficulty < 0 || difficulty >= kDifficulties)
    throw InputError("difficulty " + std::to_string(difficulty) + ": expected 0 (benign) to " +
                     std::to_string(kDifficulties - 1) + " (degenerate)");
  RandomEngine random = case_random(family, seed, index);
  return family.make(random, scaled_difficulty(difficulty));
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
  // In separate statements, because compilers evaluate operands in different orders.
  const Eigen::Matrix3d turn = shapes::random_rotation(random);
  const Eigen::Vector3d direction = shapes::random_direction(random);
  return {turn, distance * uniform(random) * direction};
}

void move_both(Case& c, const Pose& by) {
  for (Pose* p : {&c.pose_a, &c.pose_b}) *p = Pose{by.r * p->r, by.r * p->t + by.t};
}

double slack(double difficulty) {
  return difficulty >= 1 ? 0 : 0.1 * deterministic::pow10(-15 * difficulty / 0.9);
}

std::string rounded_value(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value >= 0.1 && value < 99.5 ? "%.2g" : "%.0e", value);
  const std::string out = text;
  const std::size_t e = out.find('e');
  if (e == std::string::npos || value == 0) return value == 0 ? "0" : out;
  return out.substr(0, e + 1) + std::to_string(std::stoi(out.substr(e + 1)));
}

std::string slack_value(double difficulty) {
  return rounded_value(slack(difficulty));
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

// Cases of the other families, queried both ways, drawn from all families in their order. Adding a family
// changes the selection.

namespace {

Case make_swapped(RandomEngine& random, double difficulty) {
  const std::span<const Family> families = all_families();
  while (true) {  // until it is one of the others
    const Family& f = families[random() % families.size()];
    if (!f.both_ways) return f.make(random, difficulty);
  }
}

}  // namespace

std::vector<Family> swapped_families() {
  return {
      {"swapped",
       "cases of the other families, queried both ways: is B against A the transpose of A against B?",
       make_swapped, "as in the other families", "as in the other families", true, 250},
  };
}

}  // namespace lrb::cases

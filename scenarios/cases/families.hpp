#pragma once
/// Families of cases that break collision engines, each with a dial from benign (0) to degenerate (1).
///
/// A case is the same whatever the compiler and the processor: no expression draws two random numbers without
/// an order between them (arguments and operands have none; initializers in braces have), and functions that
/// round differently from one processor to another come from engine/core/steady_math.hpp.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/query/collide.hpp"
#include "scenarios/bodies/shapes/random_pose.hpp"

namespace lrb::cases {

using shapes::RandomEngine;
using shapes::uniform;
using Body = std::shared_ptr<const LrbRep>;

/// Two bodies at two poses, and what is known of the answer from the way they were made.
struct Case {
  Body a, b;
  Pose pose_a, pose_b;
  std::optional<Relation> relation;
  std::optional<bool> interiors_overlap;
};

struct Family {
  const char* name;  ///< the class in the table
  const char* what;
  Case (*make)(RandomEngine& random, double dial);
  const char* benign = "";      ///< what dial 0 means: "1e-1 apart"
  const char* degenerate = "";  ///< what dial 1 means: "exactly in contact"
  bool both_ways = false;       ///< the question is whether exchanging A and B transposes the answer
  int rank = 1000;              ///< the families' order in tables: by rank, then by file
};
inline int rank_of(const Family& f) {
  return f.rank;
}

/// A file NAME_families.cpp of this folder defines `std::vector<Family> NAME_families()`, and its families are
/// registered: they need no other list (cmake/registry.cmake).
std::vector<Family> registered_families();

/// Returns the same, in their order.
std::span<const Family> all_families();
const Family* find_family(const std::string& name);

/// Settings of a family's dial, evenly from benign (0) to degenerate (kDialSettings - 1).
inline constexpr int kDialSettings = 11;
double dial_value(int setting);  ///< 0 .. 1

/// The numbers that a case is drawn from. They do not depend on the dial: a case is the same at all its
/// settings, but for what the dial turns.
RandomEngine case_random(const Family& family, std::uint64_t seed, std::uint64_t index);

/// Case `index` of the family at a dial setting, the same on every machine. Throws InputError if there is no
/// such setting.
Case make_case(const Family& family, std::uint64_t seed, int dial, std::uint64_t index);

// What the files share.
Body body(const Mesh& mesh,
          bool self_intersecting = false);                 ///< without regions; closed if it bounds a solid
Body any_body(RandomEngine& random);                       ///< one of a dozen small closed bodies
Pose any_pose(RandomEngine& random, double distance = 3);  ///< random rotation and translation
/// The same motion in front of both poses. Rounds, so that exact contact becomes nearly exact contact.
void move_both(Case& c, const Pose& by);
/// How far a case is from the configuration that its family is about: 0.1 at dial 0, 1e-16 at 0.9, nothing at
/// 1. In units of the bodies, which are a few wide.
double slack(double dial);
/// Moves B by `by` in a random direction and turns it by up to as much (radians). Draws as many numbers for
/// 0, which moves nothing at all.
void loosen(RandomEngine& random, Case& c, double by);
double nudged(double x, int ulps);
int pick(RandomEngine& random, int low, int high);  ///< low to high, both included
/// A point of the grid, each coordinate from low to high, both included.
Eigen::Vector3d pick_point(RandomEngine& random, const Eigen::Vector3i& low, const Eigen::Vector3i& high);
/// An exact rotation (or, if asked, perhaps a reflection) of the grid.
Eigen::Matrix3d grid_turn(RandomEngine& random, bool reflections = false);

}  // namespace lrb::cases

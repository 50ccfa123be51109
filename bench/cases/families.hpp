#pragma once
/// Families of cases that break collision engines, each with a dial from benign (0) to degenerate (1).
///
/// A case is the same with every compiler and processor: no expression draws two random numbers in an order
/// that is left open (the order of arguments and operands is, that of initializers in braces is not), and
/// functions that processors round differently come from engine/include/lrbscope/core/random.hpp.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/collide.hpp>

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
  const char* name;  ///< the class that it belongs to in the table
  const char* what;
  Case (*make)(RandomEngine& random, double dial);
  const char* benign = "";      ///< what dial 0 means: "1e-1 apart"
  const char* degenerate = "";  ///< what dial 1 means: "exactly in contact"
  bool both_ways = false;       ///< the question is whether the answer to (B, A) is that to (A, B) transposed
  int rank = 1000;              ///< the families' order in tables: by rank, then by file
  /// Returns what a setting of the dial means, in a few characters such as "1e-6"; null: it has no one
  /// number.
  std::string (*value)(double dial) = nullptr;
};
inline int rank_of(const Family& f) {
  return f.rank;
}

/// Returns the families of the program. A file NAME_families.cpp of this folder defines `std::vector<Family>
/// NAME_families()`, and bench/CMakeLists.txt names it (lrb_registry).
std::vector<Family> registered_families();

/// Returns the same families, in their order.
std::span<const Family> all_families();
const Family* find_family(const std::string& name);

/// The number of settings of a family's dial, evenly from benign (0) to degenerate (kDialSettings - 1).
inline constexpr int kDialSettings = 11;
double dial_value(int setting);  ///< 0 .. 1

/// Returns the source of the numbers that a case is drawn from. They do not depend on the dial: a case is the
/// same at all settings, except for what the dial changes.
RandomEngine case_random(const Family& family, std::uint64_t seed, std::uint64_t index);

/// Makes case `index` of the family at a dial setting, the same on every machine. Throws InputError if there
/// is no such setting.
Case make_case(const Family& family, std::uint64_t seed, int dial, std::uint64_t index);

// What the files of families share.
Body body(const Mesh& mesh,
          bool self_intersecting = false);                 ///< without regions; closed if it bounds a solid
Body any_body(RandomEngine& random);                       ///< one of a dozen small closed bodies
Pose any_pose(RandomEngine& random, double distance = 3);  ///< random rotation and translation
/// Applies the same motion to the world after both poses. Rounds, so that exact contact becomes nearly exact
/// contact.
void move_both(Case& c, const Pose& by);
/// Returns the distance of a case from the configuration that its family is about: 0.1 at dial 0, 1e-16 at
/// 0.9, 0 at 1. In the unit of the bodies, which are a few wide.
double slack(double dial);
std::string slack_value(double dial);     ///< the same in a few characters
std::string rounded_value(double value);  ///< one digit and an exponent: "0.1", "2e-3", "6e4"
/// Moves B by `by` in a random direction and turns it by up to `by` radians. For 0 it moves nothing, but
/// draws as many random numbers.
void loosen(RandomEngine& random, Case& c, double by);
double nudged(double x, int ulps);
int pick(RandomEngine& random, int low, int high);  ///< low to high, both included
/// Draws a point of the grid, each coordinate from low to high, both included.
Eigen::Vector3d pick_point(RandomEngine& random, const Eigen::Vector3i& low, const Eigen::Vector3i& high);
/// Draws an exact rotation (or, if asked, perhaps a reflection) of the grid.
Eigen::Matrix3d grid_turn(RandomEngine& random, bool reflections = false);

}  // namespace lrb::cases

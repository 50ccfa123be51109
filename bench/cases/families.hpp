#pragma once
/// Families of cases that break collision engines, each with a difficulty from benign (0) to degenerate (1).
///
/// A case is the same with every compiler and processor: no expression draws two random numbers in
/// unspecified order (the order of arguments and operands is unspecified, that of initializers in braces is
/// not), and functions that processors round differently come from engine/include/lrbscope/core/random.hpp.

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

/// Two bodies at two poses, and the part of the answer known by construction.
struct Case {
  Body a, b;
  Pose pose_a, pose_b;
  std::optional<Relation> relation;
  std::optional<bool> interiors_overlap;
};

struct Family {
  const char* name;  ///< name of its row in the table
  const char* what;
  Case (*make)(RandomEngine& random, double difficulty);
  const char* benign = "";      ///< meaning of difficulty 0: "1e-1 apart"
  const char* degenerate = "";  ///< meaning of difficulty 1: "exactly in contact"
  bool both_ways = false;       ///< tests whether the answer to (B, A) is the transpose of (A, B)'s
  int rank = 1000;              ///< order of families in tables: by rank, then by file
  /// Returns the physical value of a difficulty as a short text such as "1e-6"; null: it has no single value.
  std::string (*value)(double difficulty) = nullptr;
};
inline int rank_of(const Family& f) {
  return f.rank;
}

/// Returns the families of the program. A file NAME_families.cpp of this folder defines `std::vector<Family>
/// NAME_families()`, and bench/cases/CMakeLists.txt lists it (lrb_registry).
std::vector<Family> registered_families();

/// Returns the same families, in their order.
std::span<const Family> all_families();
const Family* find_family(const std::string& name);

/// The number of difficulties of a family, evenly spaced from benign (0) to degenerate (kDifficulties - 1).
inline constexpr int kDifficulties = 11;
double scaled_difficulty(int setting);  ///< 0 .. 1

/// Returns the random engine of a case. It does not depend on the difficulty: a case is the same at all
/// difficulties, except for the quantities that the difficulty changes.
RandomEngine case_random(const Family& family, std::uint64_t seed, std::uint64_t index);

/// Makes case `index` of the family at a difficulty, the same on every machine. Throws InputError if the
/// difficulty is out of range.
Case make_case(const Family& family, std::uint64_t seed, int difficulty, std::uint64_t index);

// Helpers shared by the files of families.
Body body(const Mesh& mesh,
          bool self_intersecting = false);                 ///< without regions; closed if it bounds a solid
Body any_body(RandomEngine& random);                       ///< one of a dozen small closed bodies
Pose any_pose(RandomEngine& random, double distance = 3);  ///< random rotation and translation
/// Applies the same motion to the world after both poses. It rounds, so that exact contact becomes almost
/// exact contact.
void move_both(Case& c, const Pose& by);
/// Returns the distance of a case from its family's degenerate configuration: 0.1 at difficulty 0, 1e-16 at
/// 0.9, 0 at 1. In the bodies' unit; bodies are a few units wide.
double slack(double difficulty);
std::string slack_value(double difficulty);  ///< as a short text
std::string rounded_value(double value);     ///< one digit and an exponent: "0.1", "2e-3", "6e4"
/// Moves B by `by` in a random direction and rotates it by up to `by` radians. For 0 nothing moves, but the
/// same number of random numbers is drawn.
void loosen(RandomEngine& random, Case& c, double by);
double nudged(double x, int ulps);
int pick(RandomEngine& random, int low, int high);  ///< low to high, inclusive
/// Draws a point of the grid, each coordinate from low to high, inclusive.
Eigen::Vector3d pick_point(RandomEngine& random, const Eigen::Vector3i& low, const Eigen::Vector3i& high);
/// Draws an exact rotation of the grid; with `reflections`, possibly a reflection.
Eigen::Matrix3d grid_turn(RandomEngine& random, bool reflections = false);

}  // namespace lrb::cases

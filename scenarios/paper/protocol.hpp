#pragma once
/// The experiment of the paper's section 4: object A against another one, 100 collisions, the number of face
/// comparisons at every time step with a face contact.
///
/// Details that the paper leaves open are defined here. Both bodies get a random rotation. The other one
/// approaches from a random direction, on a line through the centres of both bounding boxes, in steps of a
/// fixed share of the diagonal of A's bounding box, starting where their bounding spheres touch. It is scaled
/// to the same diagonal. Counting begins at the first step at which real faces intersect, and continues for
/// `steps_after` steps; steps among them in which no real faces intersect are not counted.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::paper {

struct PaperProtocol {
  std::uint32_t collisions = 100;
  std::uint32_t steps_after = 5;
  double step = 0.005;  ///< as a share of the diagonal
  std::uint64_t seed = 1;
  std::uint32_t seeds = 1;  ///< number of repetitions, with seed, seed + 1, ...
};
inline constexpr std::uint32_t kMaxCollisions = 100'000, kMaxStepsAfter = 1000, kMaxSeeds = 1000;
inline constexpr double kMinStep = 1e-5, kMaxStep = 0.5;

inline constexpr std::array kRecursions = {Recursion::paper, Recursion::paper_strict,
                                           Recursion::paper_wrapper, Recursion::complete};
/// A value for each recursion, in the order of kRecursions.
template <class T>
using PerRecursion = std::array<T, kRecursions.size()>;
inline constexpr std::size_t kPaper = 0, kWrapper = 2;  ///< indices of paper and paper_wrapper
/// Indices of the recursions whose cost allows large bodies: not paper_wrapper, which compares each new face
/// with a whole wrapper.
inline constexpr std::size_t kScalable[] = {0, 1, 3};

/// The counters of one recursion at one time step.
struct RecursionCount {
  std::uint64_t comparisons = 0;  ///< number of faces compared (paper: polygons; complete: the triangles that
                                  ///< they are fans of)
  std::uint64_t triangles = 0;    ///< pairs of triangles of the compared faces (Recursion::paper only)
  std::uint64_t refinements = 0;
  std::uint64_t pairs = 0;        ///< number of pairs of real triangles found to intersect
  std::uint64_t missed = 0;       ///< number of intersecting pairs that were not found
  std::uint64_t bound_tests = 0;  ///< number of boxes and planes; a batch of eight counts as eight (complete
                                  ///< only)
  std::uint64_t box_tests = 0;    ///< the boxes among them; not in the record
  std::uint64_t nanoseconds = 0;  ///< duration, measured once; not in the record, because it is not
                                  ///< reproducible
};

/// One time step with a face contact.
struct ContactStep {
  std::uint64_t seed = 0;
  double time_step = 0;         ///< as a share of the diagonal
  std::string object;           ///< the one that A collides with
  std::uint32_t collision = 0;  ///< 0 .. collisions - 1
  std::uint32_t step = 0;       ///< number of steps since the first contact
  Relation relation = Relation::separate;
  PerRecursion<RecursionCount> counts;
  Pose pose_a, pose_x;  ///< not in the record
};

/// Returns the counted steps of one collision. The random numbers depend only on protocol.seed, the object's
/// name and the collision's number. Reuses the memory of `workspace`. `scalable_only` leaves all recursions
/// but kScalable at 0.
std::vector<ContactStep> run_collision(const LrbRep& a, const LrbRep& x, const std::string& object,
                                       std::uint32_t collision, const PaperProtocol& protocol,
                                       Workspace& workspace, bool scalable_only = false);

/// Returns the protocol of at most this many collisions, of which only the first contact counts.
PaperProtocol first_contacts(PaperProtocol protocol, std::uint32_t most);

/// Returns the body with its coordinates multiplied by `by`.
LrbRep scaled(const LrbRep& rep, double by);
/// Returns the diagonal of the bounding box of the real faces.
double diagonal(const LrbRep& rep);

}  // namespace lrb::paper

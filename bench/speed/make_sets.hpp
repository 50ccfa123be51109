#pragma once
/// Makes data sets: bodies, poses of each class, and the exact answers.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/speed/data_set.hpp"
#include "bench/speed/metrics.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::speed {

// Finds poses at which two bodies are at a given distance or penetrate each other.

struct Approach {
  Pose pose;                           ///< of B; A's is the identity
  Eigen::Vector3d direction{0, 0, 1};  ///< from A to B, opposite to B's approach
};

/// Rotates B at random, and moves it against A along random directions, to first contact and beyond.
class Approaches {
 public:
  /// Keeps references to the bodies. `diagonal`: of the larger one.
  Approaches(const LrbRep& a, const LrbRep& b, double diagonal, std::uint64_t seed);

  /// Returns the next approach, `depth` diagonals beyond first contact; negative: separate.
  Approach next(double depth);

 private:
  bool meets(const Pose& pose_b);

  const LrbRep &a_, &b_;
  double diagonal_;
  shapes::RandomEngine random_;
  Workspace workspace_;
  CollideRequest request_;
};

struct BodyPair {
  std::string name, what;
  std::function<Mesh()> a, b;
  std::optional<Pose> pose_b = {};  ///< of interlocked bodies; A's is the identity
};

/// Returns pairs of generated bodies of about `faces` real faces each: two rocks, a knot and a gear, two
/// balls.
std::vector<BodyPair> generated_pairs(std::uint32_t faces);
/// Returns the pairs of generators::interlocked(), of at least about `faces` real faces a body; none for 0.
std::vector<BodyPair> interlocked_pairs(std::uint32_t faces);
/// Returns each mesh or LRB-rep of a folder, in order of names, paired with the next. Throws InputError if
/// there are fewer than two.
std::vector<BodyPair> pairs_of_models(const std::string& folder);

struct SetOptions {
  int poses = 12;  ///< number per class; identical bodies at identical poses: a quarter
  std::uint64_t seed = 1;
  Quantity quantity = Quantity::pairs;  ///< the queried quantity
};

/// Writes a data set and its bodies into a folder and returns it, or reads the existing one if it was made
/// from the same bodies and options. Throws InputError if an LRB-rep of a body cannot be built, and the
/// exceptions of find_numbers().
DataSet make_data_set(const BodyPair& pair, const SetOptions& options, const std::string& folder);
/// Returns the name of that data set.
std::string set_name(const BodyPair& pair, Quantity quantity);

// Makes the targets of links in charts: a query as a scenario, run, with trace, pictures and page.

/// The name of a data set, and a class of poses.
using SceneKey = std::pair<std::string, PoseClass>;

/// Chooses for each data set and class of poses the query that is the worst of most methods. Writes
/// folder/scenes/SET-CLASS.scenario.json and its run, folder/scenes/SET-CLASS/; keeps existing ones. Returns
/// their pages, relative to the folder.
std::map<SceneKey, std::string> write_scenes(const std::vector<DataSet>& sets,
                                             const std::vector<Point>& points, const std::string& folder,
                                             const record::ProgressReport& progress);

}  // namespace lrb::speed

#pragma once
/// Makes data sets: bodies, poses of each class, and the exact answers.

#include <functional>
#include <string>
#include <vector>

#include "engine/mesh/mesh.hpp"
#include "scenarios/bench/data_set.hpp"

namespace lrb::bench {

struct BodyPair {
  std::string name, what;
  std::function<Mesh()> a, b;
};

/// Makes pairs of generated bodies of about `faces` real faces each: two rocks, a knot and a gear, two balls.
std::vector<BodyPair> generated_pairs(std::uint32_t faces);
/// Returns each mesh or LRB-rep of a folder, by name, paired with the next one. Throws InputError if there
/// are fewer than two.
std::vector<BodyPair> pairs_of_models(const std::string& folder);

struct SetOptions {
  int poses = 12;  ///< number for each class; identical bodies at identical poses: a quarter of it
  std::uint64_t seed = 1;
  Quantity quantity = Quantity::pairs;  ///< what is asked for
};

/// Writes the data set and its bodies into a folder and returns the set, or reads what is there if it was
/// made from the same bodies and options. Throws InputError if a body cannot be an LRB-rep, and as
/// find_numbers() does.
DataSet make_data_set(const BodyPair& pair, const SetOptions& options, const std::string& folder);

}  // namespace lrb::bench

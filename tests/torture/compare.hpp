#pragma once
/// One case, asked every way and compared with everything that knows the answer.

#include <cstdint>
#include <string>

#include "bench/cases/families.hpp"
#include "tests/torture/tally.hpp"

namespace lrb::torture {

using namespace cases;

/// Sums over the cases of a class.
struct Tally {
  std::uint64_t poses = 0;
  std::uint64_t in_contact = 0, inside = 0;
  std::uint64_t with_regions = 0;                          ///< repeated on bodies with regions
  std::uint64_t false_negatives = 0, false_positives = 0;  ///< pairs of simplices
  std::uint64_t wrong_lists =
      0;  ///< repeated or misordered pairs, touch for cross, modes or contacts at odds
  std::uint64_t wrong_relations = 0;  ///< interiors_overlap included
  std::uint64_t undecided = 0;        ///< interiors_overlap unknown for bodies where it should be decided
  std::uint64_t rejections = 0, crashes = 0;
  std::uint64_t oracle_pairs = 0, cgal_pairs = 0, parity_checks = 0;

  std::uint64_t differences() const {
    return false_negatives + false_positives + wrong_lists + wrong_relations + undecided + crashes;
  }
};

struct Effort {
  std::size_t oracle_pairs = 3;  ///< number of pairs of a case for the rational oracle
  int parity_every = 8;          ///< the parity oracle checks the relation of every parity_every-th case
  /// Every regions_every-th case is built with regions first, if its bodies have at most
  /// regions_most_simplices.
  std::uint64_t regions_every = 4;
  std::uint32_t regions_most_simplices = 700;
  /// Above this number of simplex pairs brute force sorts boxes first (sweep_oracle.hpp).
  std::uint64_t brute_force_pairs = 20000;
  /// Overlap of interiors is tested in every case with at most small_pairs pairs of simplices, and in every
  /// interiors_every-th one above, unless it is known.
  std::uint64_t small_pairs = 200;
  std::uint64_t interiors_every = 8;
};

/// `trouble` gets a line for each difference.
Tally check(const cases::Case& c, RandomEngine& random, const Effort& effort, std::string& trouble);

}  // namespace lrb::torture

#pragma once
/// The comparisons of the suite: queries of a case, coarse queries, motions.

#include <array>
#include <cstdint>
#include <string>

#include "bench/cases/families.hpp"
#include "tests/torture/children.hpp"

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
};
template <>
inline constexpr auto kColumns<Tally> =
    std::to_array<Column<Tally>>({{"poses", &Tally::poses},
                                  {"contact", &Tally::in_contact},
                                  {"inside", &Tally::inside},
                                  {"regions", &Tally::with_regions},
                                  {"false-", &Tally::false_negatives, true},
                                  {"false+", &Tally::false_positives, true},
                                  {"lists", &Tally::wrong_lists, true},
                                  {"relation", &Tally::wrong_relations, true},
                                  {"undecided", &Tally::undecided, true},
                                  {"refusals", &Tally::rejections},
                                  {"rational", &Tally::oracle_pairs},
                                  {"CGAL", &Tally::cgal_pairs},
                                  {"parity", &Tally::parity_checks},
                                  {"crashes", &Tally::crashes, true}});

struct Effort {
  std::size_t oracle_pairs = 3;  ///< number of pairs of a case for the rational oracle
  int parity_every = 8;          ///< the parity oracle checks the relation of every parity_every-th case
  /// Every regions_every-th case is built with regions first, if its bodies have at most
  /// regions_most_simplices.
  std::uint64_t regions_every = 4;
  std::uint32_t regions_most_simplices = 700;
  /// Overlap of interiors is tested in every case with at most small_pairs pairs of simplices, and in every
  /// interiors_every-th one above, unless it is known.
  std::uint64_t small_pairs = 200;
  std::uint64_t interiors_every = 8;
};

/// Asks about one case in every way, and compares with everything that knows the answer. `trouble` gets a
/// line for each difference.
Tally check(const cases::Case& c, RandomEngine& random, const Effort& effort, std::string& trouble);

/// Gives a case's bodies regions by build_lrb(), where they have none and the mesh can be built and has at
/// most `max_simplices` simplices: the answer must not change. How many bodies got some.
int give_regions(cases::Case& c, cases::RandomEngine& random, std::uint32_t max_simplices);

/// `count` coarse queries of bodies near contact, flush ones among them, against the exact query and against
/// distances: prints a table, a row for each pair of bodies. The number of wrong answers.
std::uint64_t torture_coarse(std::uint64_t count, std::uint64_t seed, unsigned jobs);

/// First contacts of `count` motions: straight through, screws, many turns within a motion, along each
/// other's surfaces, from contact, thin sheets at any speed; each against the exact query at many times.
/// Prints a table, a row for each pair of bodies. The number of wrong answers.
std::uint64_t torture_sweeps(std::uint64_t count, std::uint64_t seed, unsigned jobs);

}  // namespace lrb::torture

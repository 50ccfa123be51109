#pragma once
/// The comparisons of the suite: queries of a case, exact and coarse, and motions of its bodies.

#include <cstdint>
#include <string>

#include "bench/cases/families.hpp"

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
  std::uint64_t coarse = 0, measured = 0, wrong_bounds = 0;
  std::uint64_t motions = 0, contacts = 0, misses = 0, no_contact = 0, wide = 0;
};
struct Column {
  const char* head;
  std::uint64_t Tally::*count;
  bool is_difference = false;  ///< should be 0
};
inline constexpr Column kColumns[] = {{"poses", &Tally::poses},
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
                                      {"coarse", &Tally::coarse},
                                      {"measured", &Tally::measured},
                                      {"bound", &Tally::wrong_bounds, true},
                                      {"motions", &Tally::motions},
                                      {"contacts", &Tally::contacts},
                                      {"misses", &Tally::misses, true},
                                      {"no contact", &Tally::no_contact, true},
                                      {"wide", &Tally::wide, true},
                                      {"crashes", &Tally::crashes, true}};

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
  /// The bodies of every motions_every-th case move, if they have at most motions_most_pairs pairs of
  /// simplices.
  std::uint64_t motions_every = 2, motions_most_pairs = 200'000;
};

/// Counts differences, and describes them in a line.
inline void complain(std::uint64_t& counter, std::string& trouble, const std::string& what,
                     std::uint64_t times = 1) {
  if (times == 0) return;
  counter += times;
  trouble += what + (times > 1 ? " (" + std::to_string(times) + " times)" : "") + '\n';
}

/// Asks about one case in every way, and compares with everything that knows the answer. `trouble` gets a
/// line for each difference.
Tally check(const cases::Case& c, RandomEngine& random, const Effort& effort, std::string& trouble);

/// Asks coarse queries of a case with regions, whose relation and pairs are `truth`: of any tolerance, mode
/// and limit of tests.
void check_coarse(const cases::Case& c, const BruteForceResult& truth, RandomEngine& random, Tally& t,
                  std::string& trouble);

/// Moves the bodies of a case, and compares their first contact with the exact query at many times: straight
/// through, screws, many turns, along each other's surfaces, past each other by hardly anything.
void check_motion(const cases::Case& c, RandomEngine& random, Tally& t, std::string& trouble);

}  // namespace lrb::torture

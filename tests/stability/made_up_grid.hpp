#pragma once

#include "bench/cases/families.hpp"
#include "bench/stability/outcome_grid.hpp"

namespace lrb::stability {

/// A grid that no method made: every outcome and an absent method in it, and texts that need escaping.
inline Grid made_up_grid() {
  Grid g;
  g.command = "lrbscope stability --cases 55";
  g.seconds = 321.5;
  g.methods = {
      {"ours", "lrbscope, complete", "pairs and relation; exact", true},
      {"no-exact", "lrbscope without the exact fallback", "pairs and relation; doubles alone", true},
      {"paper", "lrbscope, the paper's recursion", "pairs and relation", true},
      {"naive", "brute force in double, epsilon 1e-9", "pairs; <all> of them & no tree", true},
      {"fcl", "FCL 0.7.0, OBBRSS, double", "pairs; each mesh as a BVHModel", true},
      {"fcl-float", "FCL 0.7.0, OBBRSS, float", "pairs; coordinates rounded to float first", true},
      {"cgal", "CGAL 5.5, Rigid_triangle_mesh_collision_detection", "meet or not, and inside", true},
      {"bullet", "Bullet 3.24, GImpact", "meet or not", false},
  };
  g.families = family_rows();
  g.families[0].what += " <b>&\"quoted\"";
  for (std::size_t f = 0; f < g.families.size(); ++f)
    for (std::size_t m = 0; m < g.methods.size(); ++m) {
      Cell c;
      if (g.methods[m].present)
        for (std::size_t d = 0; d < cases::kDifficulties; ++d) {
          const auto some = [&](Outcome o, std::uint64_t n) { c.of(o)[d] = n; };
          if (m == 0 && f == 10 && d > 7) some(Outcome::rejected, 5 * (d - 7));
          if (m > 0 && d + m > 6 + f % 5)
            some(Outcome::wrong, std::min<std::uint64_t>(24, (d + m + f) % 5 * (f % 4 + (d > 8 ? 3 : 0))));
          if (m == 6 && f % 6 == 2 && d > 5) some(Outcome::crashed, 2);
          if (m == 4 && f % 7 == 3 && d > 8) some(Outcome::timed_out, 3);
          if (m == 5 && f % 5 == 1 && d > 6) some(Outcome::rejected, 3);
          some(Outcome::right, 30 - c.cases(d));
        }
      for (std::size_t d = 0; d < cases::kDifficulties && !c.worst; ++d) {
        if (c.cases(d) == c.of(Outcome::right)[d]) continue;
        Record r;
        r.family = g.families[f].name;
        r.method = g.methods[m].name;
        r.difficulty = static_cast<int>(d);
        r.case_index = d;
        r.seed = 1;
        r.expected = 12;
        for (const Outcome o : {Outcome::rejected, Outcome::wrong, Outcome::timed_out, Outcome::crashed})
          if (c.of(o)[d] > 0) r.outcome = o;
        if (r.outcome == Outcome::wrong) r.missed = 3, r.extra = 1;
        if (r.outcome == Outcome::crashed) r.message = "signal 11 (<Segmentation fault>)";
        r.relation = "separate";
        r.expected_relation = "touching";
        r.microseconds = 12.5;
        c.worst = r;
      }
      g.cells.push_back(c);
    }
  return g;
}

}  // namespace lrb::stability

#include "scenarios/compare/regions.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <span>
#include <tuple>
#include <unordered_map>

#include "scenarios/bodies/region_figures.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>

namespace lrb::compare {
namespace {

using render::group_digits;
using render::short_number;

/// The regions above each real face: from the body outward along parents, and those without any along parents
/// above the regions that they touch, so that every region has real faces below it.
class RegionsAbove {
 public:
  explicit RegionsAbove(const LrbRep& rep) : rep_(rep), more_(rep.region_count()) {
    std::vector<bool> is_above(rep.region_count(), false);
    for (FaceId f(0); f < rep.real_face_count(); ++f)
      for (CellId c = rep.outer_cell(f); is_region(c); c = rep.parent(c.as_region()))
        is_above[c.as_region()] = true;
    for (RegionId r(0); r < rep.region_count(); ++r) {
      if (is_above[r]) continue;
      for (const FaceId f : rep.floor(r))
        if (const CellId beneath = rep.inner_cell(f); is_region(beneath))
          more_[beneath.as_region()].push_back(r);
    }
  }

  /// Returns those of a face; valid until the next call.
  const std::vector<RegionId>& of(FaceId face) {
    found_.clear();
    for (CellId c = rep_.outer_cell(face); is_region(c); c = rep_.parent(c.as_region()))
      found_.push_back(c.as_region());
    for (std::size_t i = 0; i < found_.size(); ++i)
      for (const RegionId r : more_[found_[i]])
        if (std::find(found_.begin(), found_.end(), r) == found_.end()) found_.push_back(r);
    return found_;
  }

 private:
  const LrbRep& rep_;
  std::vector<std::vector<RegionId>> more_;
  std::vector<RegionId> found_;
};

/// The real faces below the regions of two bodies with the same real faces.
struct Below {
  std::array<std::vector<std::uint32_t>, 2> each;           ///< number, by region
  std::unordered_map<std::uint64_t, std::uint32_t> common;  ///< number below both of two regions, by key()

  static std::uint64_t key(RegionId x, RegionId y) { return std::uint64_t{x} << 32 | y; }
  static RegionId first_of(std::uint64_t key) { return RegionId(static_cast<std::uint32_t>(key >> 32)); }
  static RegionId second_of(std::uint64_t key) { return RegionId(static_cast<std::uint32_t>(key)); }
};

Below below_regions(const LrbRep& x, const LrbRep& y) {
  Below out{{std::vector<std::uint32_t>(x.region_count()), std::vector<std::uint32_t>(y.region_count())}, {}};
  RegionsAbove above_x(x), above_y(y);
  for (FaceId f(0); f < x.real_face_count(); ++f) {
    const std::vector<RegionId>&of_x = above_x.of(f), &of_y = above_y.of(f);
    for (const RegionId s : of_y) ++out.each[1][s];
    for (const RegionId r : of_x) {
      ++out.each[0][r];
      for (const RegionId s : of_y) ++out.common[Below::key(r, s)];
    }
  }
  return out;
}

std::vector<RegionFacts> facts_of(const run::Recording& run, std::span<const run::Attempt> attempts) {
  const LrbRep& rep = run.bodies[0].rep;
  std::vector<RegionFacts> out(rep.region_count());
  const auto of_region = run::attempts_by_region(run.trace, rep, attempts);
  for (const bodies::RegionFigures& f : bodies::region_figures(rep, bodies::RegionOrder::waste, 1))
    out[f.region] = {f.lids,
                     f.floor,
                     f.thickness,
                     f.volume,
                     static_cast<std::uint32_t>(of_region[f.region].size()),
                     run::verdicts_of(attempts, of_region[f.region])};
  return out;
}

/// Returns "12 | 9", or the number once if both are the same.
std::string both(const std::string& x, const std::string& y) {
  return x == y ? x : x + " | " + y;
}
std::string both(std::uint32_t x, std::uint32_t y) {
  return both(group_digits(x), group_digits(y));
}

std::string difference_line(const RegionComparison& c, const MatchedRegions& m) {
  const RegionFacts &x = c.facts[0][m.of[0]], &y = c.facts[1][m.of[1]];
  std::string out = "  region " + group_digits(m.of[0]) + " | " + group_digits(m.of[1]) + ", " +
                    render::percent(m.overlap()) + " of " + group_digits(m.either()) + " real faces: lids " +
                    both(x.lids, y.lids) + ", floor " + both(x.floor, y.floor) + ", bound " +
                    both(short_number(x.bound), short_number(y.bound));
  if (c.has_attempts) out += ", refused " + both(run::refused(x.verdicts), run::refused(y.verdicts));
  return out + "\n";
}

report::Table different_table(const RegionComparison& c, const Runs& runs) {
  constexpr std::size_t kMaxRows = 300;
  report::Table t{"Regions at the same place that differ",
                  {"region, " + runs.names[0], "region, " + runs.names[1], "overlap", "real faces", "lids",
                   "floor", "bound", "volume"}};
  if (c.has_attempts)
    for (const std::string& name : runs.names) t.columns.push_back("refused, " + name);
  for (const std::size_t i : c.different) {
    if (t.rows.size() == kMaxRows) break;
    const MatchedRegions& m = c.matching.pairs[i];
    const RegionFacts &x = c.facts[0][m.of[0]], &y = c.facts[1][m.of[1]];
    t.rows.push_back({group_digits(m.of[0]), group_digits(m.of[1]), render::percent(m.overlap()),
                      both(m.below[0], m.below[1]), both(x.lids, y.lids), both(x.floor, y.floor),
                      both(short_number(x.bound), short_number(y.bound)),
                      both(short_number(x.volume), short_number(y.volume))});
    if (c.has_attempts)
      for (const RegionFacts* f : {&x, &y}) t.rows.back().push_back(trace::rejection_text(f->verdicts));
    t.targets.push_back("regions " + std::to_string(m.of[0]) + " " + std::to_string(m.of[1]));
  }
  t.note =
      "Two regions are at the same place if at least half of the real faces below either are below both; overlap is that share. "
      "A cell with two numbers has that of " +
      runs.names[0] + " first. Bound: proven largest deviation of the lids from the body, mesh units.";
  if (c.different.size() > kMaxRows)
    t.note += " The first " + std::to_string(kMaxRows) + " of " + group_digits(c.different.size()) + ".";
  return t;
}

report::Table unmatched_table(const RegionComparison& c, const Runs& runs) {
  constexpr std::size_t kMaxRows = 300;
  report::Table t{"Regions without a counterpart", {"in", "region", "lids", "floor", "bound", "volume"}};
  if (c.has_attempts) t.columns.insert(t.columns.end(), {"refused", "reasons"});
  for (std::size_t i = 0; i < 2; ++i) {
    std::size_t rows = 0;
    for (const RegionId r : c.matching.unmatched[i]) {
      if (++rows > kMaxRows) break;
      const RegionFacts& f = c.facts[i][r];
      t.rows.push_back({runs.names[i], group_digits(r), group_digits(f.lids), group_digits(f.floor),
                        short_number(f.bound), short_number(f.volume)});
      if (c.has_attempts) {
        t.rows.back().push_back(group_digits(run::refused(f.verdicts)));
        t.rows.back().push_back(trace::rejection_text(f.verdicts));
      }
      t.targets.push_back(i == 0 ? "regions " + std::to_string(r) + " -" : "regions - " + std::to_string(r));
    }
    if (rows > kMaxRows) t.note = "The first " + std::to_string(kMaxRows) + " of each.";
  }
  return t;
}

}  // namespace

bool same_real_faces(const LrbRep& x, const LrbRep& y) {
  if (x.dim() != y.dim() || x.real_face_count() != y.real_face_count()) return false;
  for (FaceId f(0); f < x.real_face_count(); ++f) {
    const auto p = x.face(f), q = y.face(f);
    if (p.size() != q.size()) return false;
    for (std::size_t k = 0; k < p.size(); ++k)
      if (p[k] != q[k] || x.vertices()[p[k]] != y.vertices()[q[k]]) return false;
  }
  return true;
}

RegionMatching match_regions(const LrbRep& x, const LrbRep& y) {
  const Below below = below_regions(x, y);
  std::vector<MatchedRegions> found;
  for (const auto& [key, common] : below.common) {
    const RegionId r = Below::first_of(key), s = Below::second_of(key);
    const MatchedRegions m{{r, s}, common, {below.each[0][r], below.each[1][s]}};
    if (m.overlap() >= kSamePlace) found.push_back(m);
  }
  // A region and the one above it may have the same real faces below them: then depths decide.
  const auto order = [&](const MatchedRegions& m) {
    const int depths = static_cast<int>(x.depth(m.of[0])) - static_cast<int>(y.depth(m.of[1]));
    return std::tuple(-m.overlap(), std::abs(depths), m.of[0], m.of[1]);
  };
  std::sort(found.begin(), found.end(),
            [&](const MatchedRegions& m, const MatchedRegions& n) { return order(m) < order(n); });
  RegionMatching out;
  std::array<std::vector<bool>, 2> taken = {std::vector<bool>(x.region_count()),
                                            std::vector<bool>(y.region_count())};
  for (const MatchedRegions& m : found) {
    if (taken[0][m.of[0]] || taken[1][m.of[1]]) continue;
    taken[0][m.of[0]] = taken[1][m.of[1]] = true;
    out.pairs.push_back(m);
  }
  std::sort(out.pairs.begin(), out.pairs.end(),
            [](const MatchedRegions& m, const MatchedRegions& n) { return m.of[0] < n.of[0]; });
  for (std::size_t i = 0; i < 2; ++i)
    for (std::uint32_t r = 0; r < taken[i].size(); ++r)
      if (!taken[i][r]) out.unmatched[i].emplace_back(r);
  return out;
}

std::optional<RegionComparison> compare_regions(const Runs& runs) {
  const LrbRep &x = runs.of[0]->bodies[0].rep, &y = runs.of[1]->bodies[0].rep;
  if (x.region_count() + y.region_count() == 0 || !same_real_faces(x, y)) return std::nullopt;
  RegionComparison out;
  out.matching = match_regions(x, y);
  out.has_attempts = true;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<run::Attempt> attempts = run::attempts_of(runs.of[i]->trace);
    out.facts[i] = facts_of(*runs.of[i], attempts);
    out.refused[i] = static_cast<std::uint32_t>(
        std::count_if(attempts.begin(), attempts.end(), std::mem_fn(&run::Attempt::refused)));
    out.has_attempts = out.has_attempts && !attempts.empty();
  }
  const auto& pairs = out.matching.pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (!(out.facts[0][pairs[i].of[0]] == out.facts[1][pairs[i].of[1]])) out.different.push_back(i);
  std::stable_sort(out.different.begin(), out.different.end(),
                   [&](std::size_t p, std::size_t q) { return pairs[p].common > pairs[q].common; });
  return out;
}

std::string regions_sentence(const RegionComparison& c, const Runs& runs) {
  const auto& [pairs, unmatched] = c.matching;
  std::string out = group_digits(c.facts[0].size()) + " in " + runs.names[0] + ", " +
                    group_digits(c.facts[1].size()) + " in " + runs.names[1] +
                    ". By place, that is by the real " + "faces below them, " + group_digits(pairs.size()) +
                    " are in both (" + group_digits(c.different.size()) +
                    (c.different.size() == 1 ? " differs" : " differ") + "), " +
                    group_digits(unmatched[0].size()) + " only in " + runs.names[0] + ", " +
                    group_digits(unmatched[1].size()) + " only in " + runs.names[1] + ".";
  if (!c.has_attempts) return out;
  out += " Refused caps:";
  for (std::size_t i = 0; i < 2; ++i)
    out += " " + group_digits(c.refused[i]) + " in " + runs.names[i] + (i == 0 ? "," : ".");
  return out;
}

std::string regions_text(const RegionComparison& c, const Runs& runs) {
  constexpr std::size_t kMaxLines = 10;
  const auto& pairs = c.matching.pairs;
  std::string out = "regions: " + regions_sentence(c, runs) + "\n";
  for (std::size_t k = 0; k < std::min(kMaxLines, c.different.size()); ++k)
    out += difference_line(c, pairs[c.different[k]]);
  if (c.different.size() > kMaxLines)
    out += "  and " + group_digits(c.different.size() - kMaxLines) + " more, on the page\n";
  return out;
}

std::vector<report::Table> region_tables(const RegionComparison& c, const Runs& runs) {
  std::vector<report::Table> out = {different_table(c, runs), unmatched_table(c, runs)};
  std::erase_if(out, [](const report::Table& t) { return t.rows.empty(); });
  return out;
}

}  // namespace lrb::compare

#include <algorithm>
#include <numeric>
#include <string>

#include "engine/core/geometry.hpp"
#include "engine/lrb/complex.hpp"
#include "engine/lrb/thickness.hpp"
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {

Wrapper::Wrapper(const LrbRep& rep, WrapperMode mode)
    : rep_(&rep),
      mode_(mode),
      region_stamp_(rep.region_count(), 0),
      discarded_stamp_(mode == WrapperMode::unregularised ? rep.face_count() : 0, 0) {}

void Wrapper::reset() {
  // Incrementing the epoch invalidates all stamps at once: O(1) in the number of regions and faces.
  order_.clear();
  excluded_count_ = 0;
  if (++epoch_ == 0) {  // after 2^32 resets the stamps of the first epoch would be valid again
    std::fill(region_stamp_.begin(), region_stamp_.end(), 0);
    std::fill(discarded_stamp_.begin(), discarded_stamp_.end(), 0);
    epoch_ = 1;
  }
}

void Wrapper::discard_lids(RegionId r) {
  for (const FaceId lid : rep_->lids(r)) discarded_stamp_[lid] = epoch_;
}

bool Wrapper::refine_face(FaceId f) {
  if (rep_->is_real(f) || !on_boundary(f)) return false;
  // A pseudo face on the boundary hides the region behind it.
  const RegionId r = rep_->inner_cell(f).as_region();
  if (mode_ == WrapperMode::regularised) return refine(r);
  // Unregularised: the first refined lid excludes the region and thus exposes its floor. Each further lid is
  // only removed.
  if (included(r)) {
    order_.push_back(r);
    region_stamp_[r] = epoch_;
    ++excluded_count_;
  }
  discarded_stamp_[f] = epoch_;
  return true;
}

bool Wrapper::coarsen(RegionId r) {
  if (included(r)) return false;
  // Epochs start at 1, so stamp 0 always means "included".
  region_stamp_[r] = 0;
  --excluded_count_;
  if (mode_ == WrapperMode::unregularised)
    for (const FaceId lid : rep_->lids(r)) discarded_stamp_[lid] = 0;
  // The region refined last is usually the first to be included again.
  const auto last = std::find(order_.rbegin(), order_.rend(), r);
  order_.erase(std::next(last).base());
  return true;
}

void Wrapper::refine_all() {
  for (RegionId r = 0; r < rep_->region_count(); ++r) refine(r);
}

bool Wrapper::on_boundary(FaceId f) const {
  // Boundary of a union of cells: exactly one side of the face is included.
  if (mode_ == WrapperMode::regularised)
    return included(rep_->inner_cell(f)) != included(rep_->outer_cell(f));
  // A face is on the boundary if the cell in front of it is not included, unless it is a lid that was
  // discarded itself.
  return !included(rep_->outer_cell(f)) && (rep_->is_real(f) || discarded_stamp_[f] != epoch_);
}

std::vector<FaceId> Wrapper::boundary() const {
  // A boundary face is adjacent to the outside or to an excluded region, so these lists contain all of them.
  std::vector<FaceId> faces;
  const auto add = [&](std::span<const FaceId> some) {
    for (const FaceId f : some)
      if (on_boundary(f)) faces.push_back(f);
  };
  add(rep_->outermost_faces());
  for (const RegionId r : order_) add(rep_->collector(r));
  // A face between two excluded regions is in both collectors, and an outermost face may be a lid of one.
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

// Levels of detail of a body, made from its wrappers:
// 1. Thickness of each region, propagated outward: the tolerance from which on a region is included.
// 2. The number of boundary faces at each such tolerance, by differences and a prefix sum.
// 3. A choice of tolerances whose face counts grow by a bounded factor.
// 4. A tree over the boundary faces of each chosen wrapper.

namespace {

/// Maximum growth factor of the number of faces from one level to the next, if regions are small enough.
/// Smaller: more levels to create and store. Larger: a tolerance between two levels costs more additional
/// faces.
constexpr double kLevelStep = 4.0 / 3;
/// The same for levels with at most kFewFaces, or kSmallShare of the body's own: these take little memory,
/// even if there are many.
constexpr double kFewFaces = 2048, kSmallShare = 1.0 / 16, kSmallStep = 1.1;
/// Maximum fraction of the body's own faces for a level: for more, the exact query costs hardly more. Also
/// limits the total size of all levels: between two and three times as many faces as a large body has, up to
/// six times as many as a small one.
constexpr double kMaxFaces = 0.5;
/// More levels than kLevelStep gives for the largest body: a file with more was not written by lrbscope.
constexpr std::size_t kMaxLevels = 256;

[[noreturn]] void reject(const std::string& what) {
  throw InputError("the levels of the LRB-rep " + what + "; rebuild it from its mesh");
}

bool can_have_levels(const LrbRep& rep) {
  return rep.region_count() > 0 && why_no_levels(rep).empty();
}

/// Returns, for each region, the largest thickness of the region and of all regions that it hides.
std::vector<double> needed_tolerances(const LrbRep& rep, unsigned threads) {
  // Worklist algorithm: raise every region outside r to at least r's value. Values only grow and are taken
  // from a finite set, so this terminates, with the same result in any order.
  std::vector<double> needed = region_thickness(rep, threads);
  std::vector<RegionId> work(rep.region_count());
  std::iota(work.begin(), work.end(), RegionId{0});
  while (!work.empty()) {
    const RegionId r = work.back();
    work.pop_back();
    for (const FaceId lid : rep.lids(r)) {
      // All outer neighbours, not only the parent: each of them hides r through this lid.
      const CellId over = rep.outer_cell(lid);
      if (!is_region(over) || needed[over] >= needed[r]) continue;
      needed[over] = needed[r];
      work.push_back(over.as_region());
    }
  }
  return needed;
}

/// Throws InputError if a region could be included without a region that it hides.
void check_needed(const LrbRep& rep, const std::vector<double>& needed) {
  if (needed.size() != (can_have_levels(rep) ? rep.region_count() : 0)) reject("do not match its regions");
  for (RegionId r = 0; r < needed.size(); ++r) {
    // Written so that NaN is rejected as well.
    if (!(needed[r] >= 0)) reject("have an invalid tolerance for region " + std::to_string(r));
    if (rep.lids(r).empty() && needed[r] != kInfinity)
      reject("include region " + std::to_string(r) + ", which has no lid");
    for (const FaceId lid : rep.lids(r)) {
      // The order established by needed_tolerances(); without it a wrapper would have a cavity around r.
      const CellId over = rep.outer_cell(lid);
      if (is_region(over) && needed[over] < needed[r])
        reject("include region " + std::to_string(over) + " without region " + std::to_string(r) +
               ", which it covers");
    }
  }
}

/// Finds the faces that bound the wrapper of a tolerance. A region needs no larger tolerance than the regions
/// that hide it. Hence a face is on the boundary from the tolerance that includes the cell behind it up to
/// the tolerance that includes the cell in front of it.
class Boundaries {
 public:
  Boundaries(const LrbRep& rep, std::span<const double> needed) : rep_(rep), needed_(needed) {}

  /// Returns the faces at each of several descending tolerances.
  std::vector<std::vector<FaceId>> faces(std::span<const double> tolerances) const {
    std::vector<std::vector<FaceId>> out(tolerances.size());
    const auto count_from = [&](double x) {  // number of values that are at least x
      return std::partition_point(tolerances.begin(), tolerances.end(), [&](double t) { return t >= x; }) -
             tolerances.begin();
    };
    // At tolerance t a face is on the boundary if need(inner) <= t < need(outer): one run of the sorted
    // tolerances.
    for (FaceId f = 0; f < rep_.face_count(); ++f) {
      const auto end = count_from(need(rep_.inner_cell(f)));
      for (auto i = count_from(need(rep_.outer_cell(f))); i < end; ++i)
        out[static_cast<std::size_t>(i)].push_back(f);
    }
    return out;
  }

  /// Returns the number of faces at each of several ascending tolerances.
  std::vector<std::uint32_t> face_counts(std::span<const double> tolerances) const {
    const auto place = [&](CellId cell) {
      return std::lower_bound(tolerances.begin(), tolerances.end(), need(cell)) - tolerances.begin();
    };
    // A face appears at the first tolerance that includes its inner cell and disappears at the first that
    // includes its outer cell. The prefix sum of these changes is the number of faces.
    std::vector<std::int64_t> change(tolerances.size() + 1, 0);
    for (FaceId f = 0; f < rep_.face_count(); ++f) {
      ++change[static_cast<std::size_t>(place(rep_.inner_cell(f)))];
      --change[static_cast<std::size_t>(place(rep_.outer_cell(f)))];
    }
    std::partial_sum(change.begin(), change.end(), change.begin());
    return {change.begin(), change.end() - 1};
  }

 private:
  /// Returns the tolerance that includes a cell: 0 for the solid, infinite for the outside.
  double need(CellId cell) const { return is_region(cell) ? needed_[cell] : cell == kSolid ? 0 : kInfinity; }

  const LrbRep& rep_;
  std::span<const double> needed_;
};

/// Returns the bounds of the levels that are worth their memory, coarsest first.
std::vector<double> choose_bounds(const LrbRep& rep, std::span<const double> needed) {
  // Candidates: every tolerance at which some region is added to the wrapper.
  std::vector<double> bounds;
  std::copy_if(needed.begin(), needed.end(), std::back_inserter(bounds),
               [](double x) { return x < kInfinity; });
  std::sort(bounds.begin(), bounds.end());
  bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
  const std::vector<std::uint32_t> faces = Boundaries(rep, needed).face_counts(bounds);
  // Go from the coarsest candidate to finer ones, and choose one before the face count grows beyond the step.
  std::vector<std::size_t> chosen;
  const auto choose = [&](std::size_t i) {
    // Drop coarser levels that have no fewer faces.
    while (!chosen.empty() && faces[chosen.back()] >= faces[i]) chosen.pop_back();
    chosen.push_back(i);
  };
  const double few = std::max(kFewFaces, kSmallShare * rep.real_face_count());
  const auto is_beyond = [&](std::size_t i) {
    const double step = faces[i] <= few ? kSmallStep : kLevelStep;
    return chosen.empty() || faces[i] > step * faces[chosen.back()];
  };
  std::size_t i = bounds.size();
  // The count may jump by more than a step between neighbouring candidates. Then both sides of the jump are
  // chosen.
  for (; i-- > 0 && faces[i] <= kMaxFaces * rep.real_face_count();) {
    if (!is_beyond(i)) continue;
    if (!chosen.empty()) choose(i + 1);
    if (is_beyond(i)) choose(i);
  }
  // Candidate i + 1 is the finest with few enough faces; if all have, i has wrapped around, and it is 0.
  if (!chosen.empty()) choose(i + 1);
  std::vector<double> out;
  out.reserve(chosen.size());
  for (const std::size_t at : chosen) out.push_back(bounds[at]);
  return out;
}

/// Sets the members of a level except its tree. Returns the simplices of the tree.
std::vector<SimplexId> outline(const LrbRep& rep, double bound, std::span<const FaceId> faces,
                               WrapperLevel& level) {
  // Everything except the tree follows from the list of boundary faces.
  level.bound = bound;
  level.face_count = static_cast<std::uint32_t>(faces.size());
  level.component_vertices = piece_vertices(rep, faces);
  std::vector<SimplexId> simplices;
  for (const FaceId f : faces) {
    level.pseudo_count += !rep.is_real(f);
    const std::size_t count = Mesh::simplices_of(rep.face(f).size(), rep.dim());
    for (std::size_t i = 0; i < count; ++i) simplices.emplace_back(rep.first_simplex(f) + i);
  }
  return simplices;
}

}  // namespace

std::string why_no_levels(const LrbRep& rep) {
  if (!rep.closed()) return "its surface does not bound a solid";
  if (rep.self_intersecting()) return "its surface intersects itself";
  return {};
}

std::string note_no_levels(const LrbRep& rep) {
  const std::string why = why_no_levels(rep);
  if (why.empty()) return {};
  return rep.name() + ": approximate queries are not supported, because " + why +
         "; queries with a tolerance or limit are answered exactly";
}

WrapperLevels::WrapperLevels(const LrbRep& rep, unsigned threads) {
  const FloatMode float_mode;
  if (!can_have_levels(rep)) return;
  needed_ = needed_tolerances(rep, threads);
  const std::vector<double> bounds = choose_bounds(rep, needed_);
  const std::vector<std::vector<FaceId>> faces = Boundaries(rep, needed_).faces(bounds);
  levels_.resize(bounds.size());
  // Levels are independent of each other: one task per level, each tree on one thread.
  Workers workers(threads);
  workers.for_each(bounds.size(), [&](std::size_t i, unsigned) {
    const std::vector<SimplexId> simplices = outline(rep, bounds[i], faces[i], levels_[i]);
    levels_[i].tree = ObbTree(rep.simplices(), simplices);
  });
}

WrapperLevels::WrapperLevels(const LrbRep& rep, std::vector<double> needed, std::vector<StoredLevel> stored)
    : needed_(std::move(needed)) {
  const FloatMode float_mode;
  check_needed(rep, needed_);
  if (stored.size() > (needed_.empty() ? 0 : kMaxLevels)) reject("are too many");
  if (needed_.empty()) return;  // a body without levels, whose file contains an empty list of them
  std::vector<double> bounds;
  // Bounds must be finite and strictly descending; within() depends on the order.
  for (const StoredLevel& from : stored) {
    if (!(from.bound >= 0 && from.bound < (bounds.empty() ? kInfinity : bounds.back())))
      reject("are not in order");
    bounds.push_back(from.bound);
  }
  // The faces are derived again rather than read, so that a file cannot omit any. Each stored tree is checked
  // to contain exactly these simplices.
  const std::vector<std::vector<FaceId>> faces = Boundaries(rep, needed_).faces(bounds);
  levels_.resize(bounds.size());
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const std::vector<SimplexId> simplices = outline(rep, bounds[i], faces[i], levels_[i]);
    levels_[i].tree =
        ObbTree(rep.simplices(), simplices, std::move(stored[i].nodes), std::move(stored[i].blocks));
  }
}

const WrapperLevel* WrapperLevels::within(double tolerance) const {
  // Bounds descend, so the first one within the tolerance is the coarsest: binary search.
  const auto level = std::partition_point(levels_.begin(), levels_.end(),
                                          [&](const WrapperLevel& x) { return x.bound > tolerance; });
  return level == levels_.end() ? nullptr : &*level;
}

std::size_t WrapperLevels::memory_bytes() const {
  std::size_t bytes = needed_.capacity() * sizeof(double) + levels_.capacity() * sizeof(WrapperLevel);
  for (const WrapperLevel& level : levels_)
    bytes += level.tree.memory_bytes() + level.component_vertices.capacity() * sizeof(VertexId);
  return bytes;
}

}  // namespace lrb

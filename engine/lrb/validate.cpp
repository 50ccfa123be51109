// Validation of an LRB-rep, weakest invariant first:
// 1. Cells: the solid and each region are bounded by closed oriented surfaces, and their volumes add up.
// 2. Derived data: hash, bounds of the trees, thickness of the regions.
// 3. Embedding: all pairs of simplices whose bounds overlap are tested exactly.
// 4. Random wrapper states: closed, with the volume of their cells, and enclosing sampled vertices by ray
//    parity.
// Step 1 alone does not exclude overlaps, because the sum of volumes telescopes. Step 3 is the proof of
// embedding.
#include <algorithm>
#include <cmath>
#include <random>

#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/lrb/complex.hpp"
#include "engine/lrb/thickness.hpp"
#include "engine/mesh/face_pairs.hpp"
#include "engine/tree/tree_kernel.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb {
namespace {

class Validator {
 public:
  Validator(const LrbRep& rep, const ValidateOptions& options, Workers& workers)
      : rep_(rep), options_(options), workers_(workers), sum_(rep) {}

  ValidateReport run_cells() {
    check_cells();
    return std::move(report_);
  }

  ValidateReport run() {
    check_cells();
    check_derived();
    // Embedding and wrapper states run concurrently. The second validator has its own boundary sum and
    // report, and needs only the volumes computed so far.
    Validator states(rep_, options_, workers_);
    states.volume_ = volume_;
    states.report_.volume_outer = report_.volume_outer;
    workers_.both(
        [&] {
          if (options_.embedding) check_embedding();
        },
        [&] { states.check_wrapper_states(); });
    // Messages on the embedding come first, whichever check finished first. If they fill the list, those on
    // states are omitted.
    if (report_.valid || report_.violation_count < options_.max_messages) append(states.report_);
    return std::move(report_);
  }

 private:
  void append(const ValidateReport& states) {
    report_.states = states.states;
    // violation() counts each message that was kept. Violations beyond the limit are added by number.
    for (const std::string& text : states.violations) violation(text);
    report_.violation_count += states.violation_count - states.violations.size();
  }

  void violation(const std::string& text) {
    report_.valid = false;
    if (report_.violation_count++ < options_.max_messages) report_.violations.push_back(text);
  }

  /// Checks the derived data stored in files.
  void check_derived() {
    // The bounds of the OBB tree: the completeness of queries depends on them.
    const bool tree_holds = rep_.tree().bounds_hold(rep_.simplices());
    if (!tree_holds) violation("the bounds of the query's tree do not contain its faces");
    if (hash_of(rep_.data()) != rep_.hash()) violation("the stored hash does not match the complex");
    // The thickness of regions is measured with the tree, so its bounds must be checked first.
    if (tree_holds && options_.levels && rep_.has_levels()) check_levels(rep_.levels());
  }

  /// Checks the data of levels of detail that are trusted when a file is read.
  void check_levels(const WrapperLevels& levels) {
    if (levels.needed().empty()) return;
    // Computed again. The stored tolerance may be larger than the thickness (it covers all hidden regions),
    // but never smaller.
    const std::vector<double> thickness = region_thickness(rep_, workers_.count());
    for (RegionId r = 0; r < rep_.region_count(); ++r)
      if (levels.needed()[r] < thickness[r])
        violation("region " + std::to_string(r) + " has a stored thickness below its proven thickness");
    for (const WrapperLevel& level : levels.all())
      if (!level.tree.bounds_hold(rep_.simplices()))
        violation("the bounds of the tree of the level with " + std::to_string(level.face_count) +
                  " faces do not contain its faces");
  }

  void check_closed(const std::string& what) {
    VertexId at[2];
    if (!sum_.take_closed(at))
      violation(what + " is open at edge (" + std::to_string(at[0]) + ", " + std::to_string(at[1]) + ")");
  }

  void check_cells() {
    // The solid is bounded by the real faces, normals outward. An open mesh bounds nothing: its sum is only
    // reset.
    std::vector<FaceId> real(rep_.real_face_count());
    for (FaceId f = 0; f < real.size(); ++f) {
      real[f] = f;
      sum_.add(f);
    }
    if (rep_.closed())
      check_closed("the solid");
    else
      sum_.take_closed(unused_);
    report_.volume_solid = enclosed_volume(rep_, real);
    report_.volume_outer = enclosed_volume(rep_, rep_.outermost_faces());
    const double noise = kVolumeRounding * std::abs(report_.volume_outer);
    // A region is bounded by its lids, and by its floor reversed.
    for (RegionId r = 0; r < rep_.region_count(); ++r) {
      for (const FaceId f : rep_.lids(r)) sum_.add(f);
      for (const FaceId f : rep_.floor(r)) sum_.add_reversed(f);
      check_closed("region " + std::to_string(r));
      volume_.push_back(region_volume(rep_, r));
      report_.volume_regions += volume_.back();
      // Where a solid overlaps itself its volume counts twice, which a region around it may have to
      // compensate.
      if (volume_.back() < -noise && !rep_.self_intersecting())
        violation("region " + std::to_string(r) + " has negative volume " + std::to_string(volume_.back()));
    }
    // Follows from closed cells, because the two uses of a face between cells cancel. Cheap, so it is checked
    // as well.
    for (const FaceId f : rep_.outermost_faces()) sum_.add(f);
    if (rep_.closed())
      check_closed("the outermost wrapper");
    else
      sum_.take_closed(unused_);
    // Volumes must add up: each face between two cells occurs once with either sign, so only rounding
    // remains.
    const double gap = std::abs(report_.volume_solid + report_.volume_regions - report_.volume_outer);
    report_.volume_error = report_.volume_outer != 0 ? gap / std::abs(report_.volume_outer) : gap;
    if (rep_.region_count() > 0 && report_.volume_error > kVolumeRounding)
      violation("the volumes of the solid and the regions differ from the outermost wrapper's by " +
                std::to_string(gap));
  }

  /// Returns all simplices of the complex as faces with the same numbers.
  Mesh all_simplices() const {
    Mesh out;
    out.dim = rep_.dim();
    out.vertices = rep_.data().vertices;
    VertexId v[3] = {};
    for (SimplexId s = 0; s < rep_.simplex_count(); ++s) {
      rep_.simplex(s, v);
      out.add_face(std::span(v, static_cast<std::size_t>(rep_.simplex_size())));
    }
    return out;
  }

  void check_embedding() {
    on_body_ = regions_on_body(rep_);
    if (has_hubs()) return check_embedding_with_hubs();
    const LrbRep soup = LrbRep::without_regions(all_simplices(), false, false, workers_.count());
    std::vector<Pair> pairs;
    for_each_self_pair(soup.tree(), [&](SimplexId s, SimplexId t) {
      // Batches bound the memory and give the workers enough to share.
      pairs.push_back({s, t});
      if (pairs.size() == kPairsAtOnce) judge(pairs);
    });
    judge(pairs);
  }

  /// Returns true if many bounds of simplices with a common vertex overlap. The plain search then takes
  /// longer than the search that omits most of these pairs.
  bool has_hubs() const {
    if (rep_.dim() == 2) return false;
    std::vector<std::uint64_t> degree(rep_.vertices().size(), 0);
    VertexId v[3] = {};
    for (SimplexId s = 0; s < rep_.simplex_count(); ++s) {
      rep_.simplex(s, v);
      for (const VertexId corner : v) ++degree[corner];
    }
    // A vertex with n simplices has n (n - 1) / 2 such pairs.
    std::uint64_t pairs = 0;
    for (const std::uint64_t n : degree)
      if (n > kFewNeighbours) pairs += n * (n - 1) / 2;
    return pairs > kHubPairs * std::uint64_t{rep_.simplex_count()};
  }

  /// Runs the same check with a different search for pairs that may intersect. (A degenerate simplex also
  /// counts as convex.)
  void check_embedding_with_hubs() {
    const Mesh simplices = all_simplices();
    const FacePairs search(simplices, std::vector<FaceUse>(simplices.face_count(), FaceUse::convex));
    std::vector<Pair> pairs;
    // One thread, because the callback appends to a single list. The exact tests in judge() use all threads.
    Workers alone;
    search.for_each(
        [&](FaceId s, FaceId t) {
          pairs.push_back({SimplexId(s.value()), SimplexId(t.value())});
          if (pairs.size() == kPairsAtOnce) judge(pairs);
        },
        alone);
    judge(pairs);
  }

  /// Two simplices of the complex, with the result of their test.
  struct Pair {
    SimplexId s, t;
    bool good = false;
  };
  /// The corners of a simplex.
  struct Corners {
    VertexId id[3];
    const double* x[3];
  };

  Corners corners(SimplexId s) const {
    Corners c;
    rep_.simplex(s, c.id);
    for (int k = 0; k < rep_.simplex_size(); ++k) c.x[k] = rep_.vertices()[c.id[k]].data();
    return c;
  }

  /// Tests many pairs in parallel, then reports on them in order; empties the list.
  void judge(std::vector<Pair>& pairs) {
    // Pass 1, on all threads: exact tests. Each thread writes only to its own pairs.
    workers_.for_each((pairs.size() + kPairsShared - 1) / kPairsShared, [&](std::size_t i, unsigned) {
      const std::size_t end = std::min(pairs.size(), (i + 1) * kPairsShared);
      for (std::size_t k = i * kPairsShared; k < end; ++k) {
        const Corners s = corners(pairs[k].s), t = corners(pairs[k].t);
        pairs[k].good = rep_.dim() == 3 ? exact::meet_only_in_shared(s.x, s.id, t.x, t.id)
                                        : exact::meet_only_in_shared_2d(s.x, s.id, t.x, t.id);
      }
    });
    // Pass 2, in the order of the pairs: the report does not depend on the number of threads.
    report_.embedding_pairs += pairs.size();
    for (const Pair& p : pairs)
      if (!p.good)
        judge_meeting(rep_.face_of_simplex(p.s), rep_.face_of_simplex(p.t), corners(p.s).x, corners(p.t).x);
    pairs.clear();
  }

  void judge_meeting(FaceId f, FaceId g, const double* const* cf, const double* const* cg) {
    // Two real faces: a fault of the mesh. A face and a lid over it: a region of zero thickness, which is
    // allowed. Everything else violates the embedding.
    if (rep_.is_real(f) && rep_.is_real(g)) {
      ++report_.real_pairs_meeting;
    } else if (is_behind_own(f) || is_behind_own(g) || touches_from_behind(f, g, cf, cg) ||
               touches_from_behind(g, f, cg, cf)) {
      ++report_.flat_pairs;
    } else {
      violation("faces " + std::to_string(f) + (rep_.is_real(f) ? " (real)" : " (pseudo)") + " and " +
                std::to_string(g) + (rep_.is_real(g) ? " (real)" : " (pseudo)") +
                " intersect outside their shared edges and corners");
    }
  }

  /// Returns true if the lid hides the face and no corner of the face is in front of the lid's plane. Such a
  /// face touches the lid from behind: the region between the two has zero thickness there.
  bool touches_from_behind(FaceId lid, FaceId face, const double* const* cl, const double* const* cf) const {
    if (!hides(lid, face)) return false;
    for (int k = 0; k < rep_.dim(); ++k) {
      // Positive: in front of the lid. In 2D the left of a segment is behind it, hence the minus sign.
      const int side = rep_.dim() == 2 ? -exact::orient2d(cl[0], cl[1], cf[k])
                                       : exact::orient3d(cl[0], cl[1], cl[2], cf[k]);
      if (side > 0) return false;
    }
    return true;
  }

  /// Returns true if a real face is a part of the lids over it: other faces then meet it only where they meet
  /// these, which are tested themselves.
  bool is_behind_own(FaceId f) const {
    return rep_.is_real(f) && is_region(rep_.outer_cell(f)) && on_body_[rep_.outer_cell(f)];
  }

  bool hides(FaceId lid, FaceId face) const {
    if (rep_.is_real(lid)) return false;
    // Walk outward from the cell in front of the face to the cell behind the lid, along parents only. The
    // constructor rejects cycles of parents, so the loop terminates.
    CellId c = rep_.outer_cell(face);
    while (is_region(c) && c != rep_.inner_cell(lid)) c = rep_.parent(c.as_region());
    return is_region(c);
  }

  void check_wrapper_states() {
    // Without regions the outermost wrapper is the only state.
    if (rep_.region_count() == 0 || !rep_.closed()) return;
    std::mt19937_64 random(options_.seed);
    for (std::uint32_t state = 0; state < options_.wrapper_states; ++state) {
      // Vary the fraction of excluded regions from almost none to all, so that states near both ends occur.
      const double share = std::pow(std::generate_canonical<double, 53>(random), 2);
      Wrapper w(rep_);
      double volume = report_.volume_outer;
      for (RegionId r = 0; r < rep_.region_count(); ++r)
        if (std::generate_canonical<double, 53>(random) < share) {
          // Any set of regions is a valid state. Its volume does not depend on the order of refinement.
          w.refine(r);
          volume -= volume_[r];
        }
      check_state(w.boundary(), w, volume, random);
      ++report_.states;
    }
  }

  void check_state(const std::vector<FaceId>& boundary, const Wrapper& w, double volume,
                   std::mt19937_64& random) {
    std::vector<bool> touched(rep_.vertices().size(), false);
    std::vector<FaceId> as_is, reversed;
    for (const FaceId f : boundary) {
      // If the region in front of a face is included but the cell behind it is not, the boundary of the
      // wrapper contains the reversed face.
      const bool outward = w.included(rep_.inner_cell(f));
      outward ? sum_.add(f) : sum_.add_reversed(f);
      (outward ? as_is : reversed).push_back(f);
      for (const VertexId v : rep_.face(f)) touched[v] = true;
    }
    // Closedness: the oriented boundary faces must cancel along every edge.
    const std::string name = "wrapper state " + std::to_string(report_.states);
    check_closed(name);
    // Volume: that of the boundary must equal that of the included cells, up to rounding.
    if (std::abs(enclosed_volume(rep_, as_is, reversed) - volume) >
        kVolumeRounding * std::abs(report_.volume_outer))
      violation(name + " encloses another volume than its cells");
    // A self-intersecting solid has vertices in its interior that are outside by parity.
    if (!rep_.self_intersecting()) check_enclosure(boundary, touched, name, random);
  }

  void check_enclosure(const std::vector<FaceId>& boundary, const std::vector<bool>& touched,
                       const std::string& name, std::mt19937_64& random) {
    for (int sample = 0; sample < kEnclosureSamples; ++sample) {
      const FaceId f = static_cast<FaceId>(random() % rep_.real_face_count());
      // Vertices of the boundary itself may be on it; all others must be inside.
      const VertexId v = rep_.face(f)[0];
      if (touched[v]) continue;
      if (!holds(boundary, v)) violation(name + " leaves real vertex " + std::to_string(v) + " outside");
    }
  }

  /// Returns true if the vertex is behind the boundary or on it.
  bool holds(const std::vector<FaceId>& boundary, VertexId v) const {
    // Parity of the crossings of an exact ray. Parity does not depend on orientation, so reversed faces are
    // not treated separately.
    const double* p = rep_.vertices()[v].data();
    bool inside = false, on_face = false;
    const auto note = [&](exact::RayHit hit) {
      inside ^= hit == exact::RayHit::crosses;
      on_face |= hit == exact::RayHit::on_face;
    };
    for (const FaceId g : boundary) {
      const std::size_t count = Mesh::simplices_of(rep_.face(g).size(), rep_.dim());
      for (std::size_t i = 0; i < count; ++i) {
        VertexId ids[3] = {};
        rep_.simplex(SimplexId(rep_.first_simplex(g) + i), ids);
        const auto at = [&](int k) { return rep_.vertices()[ids[k]].data(); };
        const double* const c[3] = {at(0), at(1), rep_.dim() == 2 ? nullptr : at(2)};
        note(rep_.dim() == 2 ? exact::ray_crosses_2d(p, c) : exact::ray_crosses(p, c));
      }
    }
    return inside || on_face;
  }

  static constexpr int kEnclosureSamples = 8;
  static constexpr std::size_t kPairsAtOnce = 1u << 14, kPairsShared = 256;
  /// Number of pairs at hubs for each simplex from which on the search for hubs is used. The plain search
  /// tests about 20 pairs for each simplex; the other one takes twice as long where there are no hubs.
  static constexpr std::uint64_t kHubPairs = 20;

  const LrbRep& rep_;
  const ValidateOptions& options_;
  Workers& workers_;
  BoundarySum sum_;
  ValidateReport report_;
  std::vector<double> volume_;
  std::vector<bool> on_body_;
  VertexId unused_[2] = {};
};

}  // namespace

ValidateReport validate(const LrbRep& rep, const ValidateOptions& options) {
  const FloatMode float_mode;
  Workers workers(options.threads);
  return Validator(rep, options, workers).run();
}

ValidateReport validate_cells(const LrbRep& rep) {
  const FloatMode float_mode;
  const ValidateOptions options;
  Workers workers;
  return Validator(rep, options, workers).run_cells();
}

}  // namespace lrb

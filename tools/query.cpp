#include <optional>
#include <utility>

#include "tools/pose_lines.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/wrapper.hpp>

namespace lrb::tools {
namespace {

/// The interiors of touching bodies may still overlap (see Relation::touching). This is decided for a query
/// that found all pairs exactly, up to this number of pairs: 1000 take 0.1 s or more (docs/measurements.md).
constexpr std::size_t kMaxPairsToDecide = 1000;

struct PairsQuestion : PosedQuestion {
  static constexpr const char* kName = "query";
  static constexpr const char* kHelp =
      "Find all intersecting pairs of faces, exactly, for each pose of B; one JSON line per pose";
  static constexpr unsigned kThreads = 0;
  CollideRequest request;
  bool pairs = false, with_kind = false, with_distance = false;
  std::optional<ClashResult> kind;         ///< of the pose, for --kind
  std::optional<DistanceResult> distance;  ///< of the pose, for --distance

  void add_options(App& app) {
    add_request_options(app, request);
    add_coarse_options(app, request);
    auto* separation = app.add_flag("--separation", request.separation,
                                    "For separate bodies, add the coarsest pair of disjoint wrappers (a "
                                    "certificate of separation)");
    app.add_option(
           "--draw-separation", draw.picture, "PNG",
           "Draw the certificate of --separation to this PNG; for several poses, one numbered file each")
        ->needs(separation);
    app.add_flag("--pairs", pairs, "Add the sorted list of intersecting pairs");
    app.add_flag("--kind", with_kind, "Add the kind of contact, as reported by `clash`");
    app.add_flag("--distance", with_distance, "Add the distance between the surfaces, as a proven interval");
  }

  std::array<bodies::LoadedBody, 2> load(const Globals& globals) const {
    const bool needs_regions =
        request.recursion != Recursion::complete || request.is_coarse() || request.separation;
    return needs_regions ? bodies::load_two_bodies(a, b, with_progress({}, globals.quiet), corners)
                         : PosedQuestion::load(globals);
  }
  void prepare(const LrbRep& rep_a, const LrbRep& rep_b, const Globals& globals) const {
    if (with_kind) check_request(rep_a, ClashRequest{});
    if (!request.is_coarse()) return;
    check_request(request);
    for (const LrbRep* rep : {&rep_a, &rep_b}) {
      if (const std::string why = note_no_levels(*rep); !why.empty()) note(globals, {why});
      rep->levels(0);
    }
  }

  CollideResult ask(const pictures::PosedBodies& p, Workspace& workspace, bool /*watched*/) const {
    return std::move(collide(p.a, p.pose_a, p.b, p.pose_b, request, workspace).value());
  }
  bool tells_overlap() const {
    return request.mode == Mode::all_pairs && request.recursion == Recursion::complete &&
           request.predicates == Predicates::exact && !request.is_coarse();
  }
  void complete(CollideResult& result, const pictures::PosedBodies& p, Workspace& workspace) {
    if (tells_overlap() && result.relation == Relation::touching &&
        result.pairs.size() <= kMaxPairsToDecide) {
      CollideRequest overlap = request;
      overlap.interiors_overlap = true;
      describe_contact(p.a, p.pose_a, p.b, p.pose_b, overlap, workspace, result).value();
    }
    ClashRequest of_kind;
    of_kind.depth = of_kind.volume = false;
    if (with_kind) kind = clash(p.a, p.pose_a, p.b, p.pose_b, of_kind, workspace).value();
    DistanceRequest of_distance;
    of_distance.relation = false;
    if (with_distance) distance = lrb::distance(p.a, p.pose_a, p.b, p.pose_b, of_distance, workspace).value();
  }

  /// Writes [[number of A, number of B], ...]. numbers(pair): an array of two.
  static void write_pairs(trace::JsonWriter& w, const char* name, const std::vector<SimplexPair>& pairs,
                          const auto& numbers) {
    w.key(name).begin_array();
    for (const SimplexPair& pair : pairs) w.value(numbers(pair));
    w.end_array();
  }
  void write(trace::JsonWriter& w, const CollideResult& result, const pictures::PosedBodies& p,
             const auto& us) const {
    w.member("relation", name_of(result.relation)).member("pairs", std::uint64_t{result.pairs.size()});
    w.member("fingerprint", trace::to_hex(fingerprint(result.pairs)));
    if (tells_overlap() && result.relation == Relation::touching)
      w.member("interiors_overlap", name_of(result.interiors_overlap));
    if (kind) w.member("kind", name_of(kind->kind));
    if (kind && kind->reason != ClashReason::none) w.member("reason", name_of(kind->reason));
    if (distance) w.member("distance", std::array{distance->lower, distance->upper});
    if (request.recursion != Recursion::complete) w.member("recursion", name_of(request.recursion));
    if (request.predicates != Predicates::exact) w.member("predicates", name_of(request.predicates));
    if (request.is_coarse()) w.member("finished", result.finished).member("error_bound", result.error_bound);
    if (request.separation && result.separation) {
      w.key("separation");
      trace::write_json(w, *result.separation);
    }
    us(w);
    if (!pairs) return;
    write_pairs(w, "list", result.pairs, [](const SimplexPair& x) { return std::array{x.a, x.b}; });
    if (request.is_coarse())
      write_pairs(w, "pseudo", result.pairs, [&](const SimplexPair& x) {
        return std::array{p.a.is_real_simplex(x.a) ? 0U : 1U, p.b.is_real_simplex(x.b) ? 0U : 1U};
      });
  }

  static bool has_picture(const CollideResult& result) { return result.separation.has_value(); }
  static auto picture(const CollideResult& result, const pictures::PosedBodies& p,
                      const pictures::Look& /*its own*/) {
    return pictures::picture_of(*result.separation, p);
  }
};

}  // namespace

Command add_query(App& root, const Globals& globals) {
  return add_question<PairsQuestion>(root, globals);
}

}  // namespace lrb::tools

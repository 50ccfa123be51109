#include <memory>
#include <optional>
#include <utility>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/pose_lines.hpp"
#include "tools/terminal.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::cli {
namespace {

struct QueryOptions : PosedFiles {
  std::string draw;
  CollideRequest request;
  bool pairs = false, kind = false, distance = false;
  std::uint32_t repeat = 0;
};

/// Answers a query with its own memory.
CollideResult answer(const LrbRep& a, const LrbRep& b, const Pose& pose, const QueryOptions& o,
                     Workspace& workspace) {
  return std::move(collide(a, Pose{}, b, pose, o.request, workspace).value());
}

/// Returns the median time in microseconds of the repeated runs of one query, in a warm workspace.
double repeated_us(const LrbRep& a, const LrbRep& b, const Pose& pose, const QueryOptions& o,
                   Workspace& workspace) {
  return median_us(o.repeat, [&] {
    const CollideResult result = answer(a, b, pose, o, workspace);
    if (result.mode != o.request.mode) throw std::logic_error("the query changed its mode");
  });
}

/// The interiors of touching bodies may still overlap (see Relation::touching). This is decided for a query
/// that found all pairs exactly, up to this number of pairs: 1000 take 0.1 s or more (docs/measurements.md).
constexpr std::size_t kMaxPairsToDecide = 1000;

bool tells_overlap(const CollideRequest& request) {
  return request.mode == Mode::all_pairs && request.recursion == Recursion::complete &&
         request.predicates == Predicates::exact && !request.is_coarse();
}

void decide_overlap(const LrbRep& a, const LrbRep& b, const Pose& pose, const CollideRequest& request,
                    Workspace& workspace, CollideResult& result) {
  if (result.relation != Relation::touching || result.pairs.size() > kMaxPairsToDecide) return;
  CollideRequest overlap = request;
  overlap.interiors_overlap = true;
  describe_contact(a, Pose{}, b, pose, overlap, workspace, result).value();
}

/// Writes [[number of A, number of B], ...]. numbers(pair): an array of two.
template <class Numbers>
void write_pairs(trace::JsonWriter& w, const char* name, const std::vector<SimplexPair>& pairs,
                 const Numbers& numbers) {
  w.key(name).begin_array();
  for (const SimplexPair& pair : pairs) {
    w.value(numbers(pair));
  }
  w.end_array();
}

/// Answers of --kind and --distance.
struct ExtraAnswers {
  std::optional<ClashResult> kind;
  std::optional<DistanceResult> distance;
};

ExtraAnswers extra_answers(const LrbRep& a, const LrbRep& b, const Pose& pose, const QueryOptions& o,
                           Workspace& workspace) {
  ExtraAnswers out;
  if (o.kind) {
    ClashRequest request;
    request.depth = request.volume = false;
    out.kind = clash(a, Pose{}, b, pose, request, workspace).value();
  }
  if (o.distance) {
    DistanceRequest request;
    request.relation = false;
    out.distance = distance(a, Pose{}, b, pose, request, workspace).value();
  }
  return out;
}

std::string line_of(std::size_t pose, const CollideResult& result, const ExtraAnswers& extra,
                    const QueryOptions& o, double us, const LrbRep& a, const LrbRep& b) {
  const CollideRequest& request = o.request;
  return trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
    w.begin_object().member("pose", std::uint64_t{pose}).member("relation", name_of(result.relation));
    w.member("pairs", std::uint64_t{result.pairs.size()});
    w.member("fingerprint", trace::to_hex(fingerprint(result.pairs)));
    if (tells_overlap(request) && result.relation == Relation::touching)
      w.member("interiors_overlap", name_of(result.interiors_overlap));
    if (extra.kind) w.member("kind", name_of(extra.kind->kind));
    if (extra.kind && extra.kind->reason != ClashReason::none)
      w.member("reason", name_of(extra.kind->reason));
    if (extra.distance) w.member("distance", std::array{extra.distance->lower, extra.distance->upper});
    if (request.recursion != Recursion::complete) w.member("recursion", name_of(request.recursion));
    if (request.predicates != Predicates::exact) w.member("predicates", name_of(request.predicates));
    if (request.is_coarse()) w.member("finished", result.finished).member("error_bound", result.error_bound);
    if (request.separation && result.separation) {
      w.key("separation");
      trace::write_json(w, *result.separation);
    }
    if (o.repeat > 0) w.member("us", us);
    if (o.pairs)
      write_pairs(w, "list", result.pairs, [](const SimplexPair& p) { return std::array{p.a, p.b}; });
    if (o.pairs && request.is_coarse())
      write_pairs(w, "pseudo", result.pairs, [&](const SimplexPair& p) {
        return std::array{a.is_real_simplex(p.a) ? 0U : 1U, b.is_real_simplex(p.b) ? 0U : 1U};
      });
    w.end_object();
  });
}

/// Returns true if an answer depends on wrappers, not only on the bodies' faces.
bool needs_regions(const CollideRequest& request) {
  return request.recursion != Recursion::complete || request.is_coarse() || request.separation;
}

int run_query(const QueryOptions& o, const Globals& globals) {
  const PoseLines list(o.poses);
  const std::vector<Pose>& poses = list.poses;
  const auto loaded = needs_regions(o.request)
                          ? bodies::load_two_bodies(o.a, o.b, with_progress({}, globals.quiet), o.corners)
                          : bodies::load_faces_of_two(o.a, o.b, o.corners);
  const bodies::LoadedBody &a = loaded[0], &b = loaded[1];
  note(globals, a.notes);
  note(globals, b.notes);
  list.check(a.rep, b.rep);
  if (o.kind) check_request(a.rep, ClashRequest{});
  if (o.request.is_coarse()) check_request(o.request);
  if (o.request.is_coarse())
    for (const bodies::LoadedBody* body : {&a, &b}) {
      if (const std::string why = note_no_levels(body->rep); !why.empty()) note(globals, {why});
      body->rep.levels(0);
    }
  Workspace workspace(0);
  Progress progress("query", poses.size(), globals.quiet);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CollideResult result = list.at(i, [&] { return answer(a.rep, b.rep, poses[i], o, workspace); });
    if (tells_overlap(o.request)) decide_overlap(a.rep, b.rep, poses[i], o.request, workspace, result);
    const double us = o.repeat > 0 ? repeated_us(a.rep, b.rep, poses[i], o, workspace) : 0;
    print(line_of(i, result, extra_answers(a.rep, b.rep, poses[i], o, workspace), o, us, a.rep, b.rep));
    if (!o.draw.empty() && result.separation)
      run::write_picture(run::picture_of(*result.separation, {a.rep, Pose{}, b.rep, poses[i]}),
                         picture_name(o.draw, i, poses.size()));
    progress.set(i + 1);
  }
  return kOk;
}

}  // namespace

Command add_query(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "query", "Find all intersecting pairs of faces, exactly, for each pose of B; one JSON line per pose");
  const auto o = std::make_shared<QueryOptions>();
  add_posed_files(*app, *o);
  add_request_options(*app, o->request);
  add_coarse_options(*app, o->request);
  auto* separation = app->add_flag("--separation", o->request.separation,
                                   "For separate bodies, add the coarsest pair of disjoint wrappers (a "
                                   "certificate of separation)");
  app->add_option(
         "--draw-separation", o->draw, "PNG",
         "Draw the certificate of --separation to this PNG; for several poses, one numbered file each")
      ->needs(separation);
  app->add_flag("--pairs", o->pairs, "Add the sorted list of intersecting pairs");
  app->add_flag("--kind", o->kind, "Add the kind of contact, as reported by `clash`");
  app->add_flag("--distance", o->distance, "Add the distance between the surfaces, as a proven interval");
  add_repeat_option(*app, o->repeat, "pose");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_query(*o, globals); }};
}

}  // namespace lrb::cli

#include "scenarios/run/scene_json.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "render/page_palette.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/run_charts.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

namespace {

/// Returns the centre of a body in its own frame. A page has vertices and poses relative to it.
Eigen::Vector3d body_centre(const LrbRep& rep) {
  return rep.vertices().empty() ? Eigen::Vector3d(0, 0, 0)
                                : Eigen::Vector3d(render::bounds(render::body_points(rep, {})).center());
}

/// Appends a pose in the page's frame: rows of [R | t], for vertices relative to the body's centre.
void add_pose(std::vector<float>& out, const Pose& pose, const Eigen::Vector3d& centre,
              const SceneFrame& frame) {
  const Eigen::Vector3d at = (pose.apply(centre) - frame.origin) / frame.unit;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out.push_back(static_cast<float>(pose.r(row, column)));
    out.push_back(static_cast<float>(at[row]));
  }
}

}  // namespace

std::vector<std::uint32_t> shown_pseudo_faces(const LrbRep& rep, Side side, const trace::Trace& trace) {
  std::vector<bool> shown(rep.region_count());
  const auto show = [&](FaceId f) {
    if (is_region(rep.inner_cell(f))) shown[rep.inner_cell(f).as_region()] = true;
  };
  for (const FaceId f : rep.outermost_faces()) show(f);
  for (const trace::Event& e : trace.events)
    if (e.kind == EventKind::refine && e.side == side)
      for (const FaceId f : rep.floor(RegionId(e.a))) show(f);
  const auto is_of_shown = [&](CellId c) { return is_region(c) && shown[c.as_region()]; };
  std::vector<std::uint32_t> out;
  for (FaceId f(rep.real_face_count()); f < rep.face_count(); ++f)
    if (is_of_shown(rep.inner_cell(f)) || is_of_shown(rep.outer_cell(f))) out.push_back(f.value());
  return out;
}

namespace {

using nlohmann::json;
using report::packed;
using Numbers = std::vector<std::uint32_t>;

/// Packs one number of each element.
template <class Range, class Get>
std::string packed_each(const Range& range, Get get) {
  Numbers out;
  out.reserve(std::size(range));
  for (const auto& item : range) out.push_back(static_cast<std::uint32_t>(get(item)));
  return packed(out);
}

// ---- where things are

const Pose& pose_in(const trace::Step& step, std::size_t body) {
  return body == 0 ? step.pose_a : step.pose_b;
}

SceneFrame scene_frame(const frames::RecordedRun& p) {
  SceneFrame frame;
  if (p.trace->steps.empty()) return frame;
  const trace::Step& first = p.trace->steps.front();
  double size = 0;
  for (std::size_t i = 0; i < p.reps.size(); ++i) {
    Eigen::AlignedBox3d placed;
    for (const Eigen::Vector3d& v : p.reps[i]->vertices()) placed.extend(pose_in(first, i).apply(v));
    if (!placed.isEmpty()) size = std::max(size, placed.diagonal().norm());
  }
  frame.origin = first.pose_a.apply(body_centre(*p.reps[0]));
  if (size > 0 && std::isfinite(size)) frame.unit = std::exp2(std::floor(std::log2(size)));
  return frame;
}

/// Returns the poses of a body in the page's frame, or one if it never moves: rows of [R | t], for vertices
/// relative to the body's centre.
std::vector<float> poses_of(const frames::RecordedRun& p, std::size_t body, const Numbers& steps,
                            const SceneFrame& frame) {
  const Eigen::Vector3d centre = body_centre(*p.reps[body]);
  std::vector<float> out;
  const auto pose = [&](std::uint32_t step) -> const Pose& { return pose_in(p.trace->steps[step], body); };
  const bool stays = std::all_of(steps.begin(), steps.end(),
                                 [&](std::uint32_t s) { return trace::equal(pose(s), pose(steps.front())); });
  for (const std::uint32_t s : steps)
    if (!stays || out.empty()) add_pose(out, pose(s), centre, frame);
  return out;
}

// ---- bodies

/// `shown`: the pseudo faces that have corners on the page; null: all.
json geometry(const LrbRep& rep, const SceneFrame& frame, const Numbers* shown = nullptr) {
  const Eigen::Vector3d centre = body_centre(rep);
  std::vector<float> vertices;
  for (const Eigen::Vector3d& v : rep.vertices()) frame.add_vector(vertices, v - centre);
  Numbers sizes, corners, inner, outer, parents, layers;
  const auto region_or_null = [](CellId c) { return is_region(c) ? c.value() : std::uint32_t{kNull}; };
  for (FaceId f = 0; f < rep.face_count(); ++f) {
    sizes.push_back(static_cast<std::uint32_t>(rep.face(f).size()));
    inner.push_back(region_or_null(rep.inner_cell(f)));
    outer.push_back(region_or_null(rep.outer_cell(f)));
    if (shown == nullptr || rep.is_real(f) || std::binary_search(shown->begin(), shown->end(), f.value()))
      for (const VertexId v : rep.face(f)) corners.push_back(v.value());
  }
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    parents.push_back(region_or_null(rep.parent(r)));
    layers.push_back(rep.layer(r));
  }
  json out = {{"vertices", packed(vertices)}, {"sizes", packed(sizes)},
              {"corners", packed(corners)},   {"inner", packed(inner)},
              {"outer", packed(outer)},       {"parent", packed(parents)},
              {"layer", packed(layers)},      {"shown", shown == nullptr ? "" : packed(*shown)}};
  // The corners of all triangles, in the order of the simplices; without them, polygons are fans.
  if (!rep.has_cut_faces()) return out;
  Numbers triangles;
  for (SimplexId s = 0; s < rep.simplex_count(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    for (const VertexId corner : v) triangles.push_back(corner.value());
  }
  out["triangles"] = packed(triangles);
  return out;
}

/// Returns the real simplices of a body that events compare, in the events' order: contacts first.
std::vector<SimplexId> compared_simplices(const frames::RecordedRun& p, Side side) {
  std::vector<SimplexId> out;
  for (const EventKind kind : {EventKind::contact, EventKind::face_test})
    for (const trace::Event& e : p.trace->events)
      if (e.kind == kind) out.push_back(e.simplex(side));
  return out;
}

/// Boxes of nodes: all down to some depth, and below it those on the paths to compared faces.
struct ShownBoxes {
  std::vector<pictures::TreeBox> boxes;
  std::uint32_t whole = 0;              ///< all boxes down to this depth are included
  std::vector<std::uint32_t> by_depth;  ///< number of nodes at each depth
};

ShownBoxes shown_boxes(const ObbTree& tree, std::size_t most, const std::vector<SimplexId>& compared) {
  ShownBoxes out{pictures::tree_boxes(tree, most), 0, pictures::nodes_by_depth(tree)};
  if (out.boxes.empty()) return out;
  out.whole = out.boxes.back().depth;
  if (out.boxes.size() < tree.nodes().size()) {
    const std::vector<pictures::TreeBox> deeper = pictures::boxes_on_paths(tree, out.whole, compared, most);
    out.boxes.insert(out.boxes.end(), deeper.begin(), deeper.end());
  }
  return out;
}

/// The same of another engine's tree.
ShownBoxes shown_boxes(const trace::TreeShape& tree, std::size_t most,
                       const std::vector<SimplexId>& compared) {
  ShownBoxes out;
  std::vector<std::uint32_t> parent(tree.size(), kNull), leaf;
  for (const std::uint32_t n : tree.from_root()) {
    out.by_depth.resize(tree.depth(n) + std::size_t{1});
    ++out.by_depth[tree.depth(n)];
    for (const std::uint32_t child : tree.children(n)) parent[child] = n;
    for (const SimplexId s : tree.simplices(n)) {
      if (s >= leaf.size()) leaf.resize(s.value() + 1, kNull);
      leaf[s.value()] = n;
    }
  }
  std::size_t down_to = 0;  // nodes in the order from the root are in the order of their depths
  for (std::uint32_t depth = 0; depth < out.by_depth.size() && down_to + out.by_depth[depth] <= most; ++depth)
    down_to += out.by_depth[depth], out.whole = depth;
  std::vector<bool> taken(tree.size());
  const auto take = [&](std::uint32_t n) {
    taken[n] = true;
    const trace::ShapeBox& box = tree.box(n);
    Eigen::Matrix3d half;
    for (int i = 0; i < 3; ++i) half.col(i) = box.half[static_cast<std::size_t>(i)];
    out.boxes.push_back({n, tree.depth(n), box.centre, half});
  };
  for (std::size_t i = 0; i < down_to; ++i) take(tree.from_root()[i]);
  for (const SimplexId s : compared)
    for (std::uint32_t n = s < leaf.size() ? leaf[s.value()] : std::uint32_t{kNull}; n != kNull && !taken[n];
         n = parent[n]) {
      if (out.boxes.size() >= down_to + most) return out;
      take(n);
    }
  return out;
}

json boxes_json(const LrbRep& rep, const SceneFrame& frame, const ShownBoxes& shown) {
  const std::vector<pictures::TreeBox>& boxes = shown.boxes;
  const Eigen::Vector3d centre = body_centre(rep);
  std::vector<float> places;  // centre and three half axes each
  for (const pictures::TreeBox& box : boxes) {
    frame.add_vector(places, box.centre - centre);
    for (int i = 0; i < 3; ++i) frame.add_vector(places, box.half.col(i));
  }
  return {{"node", packed_each(boxes, [](const pictures::TreeBox& b) { return b.node; })},
          {"depth", packed_each(boxes, [](const pictures::TreeBox& b) { return b.depth; })},
          {"places", packed(places)},
          {"whole", shown.whole},
          {"atDepth", packed(shown.by_depth)}};
}

json body_json(const frames::RecordedRun& p, std::size_t i, const SceneFrame& frame,
               const SceneLimits& limits, std::size_t faces) {
  const LrbRep& rep = *p.reps[i];
  json out = {{"name", std::filesystem::path(rep.name()).stem().string()},
              {"hash", trace::to_hex(rep.hash())},
              {"faces", rep.face_count()},
              {"realFaces", rep.real_face_count()},
              {"regions", rep.region_count()}};
  if (faces > limits.faces) return out;
  const trace::FaceCounts counts = trace::count_faces(rep, static_cast<Side>(i), p.trace->events);
  if (faces > limits.with_all_lids && !p.trace->header.construction) {
    const Numbers shown = shown_pseudo_faces(rep, static_cast<Side>(i), *p.trace);
    out["geometry"] = geometry(rep, frame, &shown);
  } else {
    out["geometry"] = geometry(rep, frame);
  }
  // Another engine traverses trees of its own, which may be unknown.
  const std::vector<SimplexId> compared = compared_simplices(p, static_cast<Side>(i));
  const bool ours = p.trace->header.engine.empty(), is_known = p.trees != nullptr && i < p.trees->size();
  out["boxes"] = boxes_json(rep, frame,
                            ours       ? shown_boxes(rep.tree(), limits.boxes, compared)
                            : is_known ? shown_boxes((*p.trees)[i], limits.boxes, compared)
                                       : ShownBoxes());
  const Eigen::Vector3d centre = body_centre(rep);
  out["centre"] = {centre.x(), centre.y(), centre.z()};
  out["counts"] = {{"tests", packed(counts.tests)},
                   {"hits", packed(counts.hits)},
                   {"contacts", packed(counts.contacts)},
                   {"refinements", packed(counts.refinements)}};
  return out;
}

// ---- events

json kinds_json() {
  json out = json::array();
  for (std::size_t i = 0; i < trace::kEventKinds; ++i) {
    const auto kind = static_cast<EventKind>(i);
    const trace::EventFields fields = trace::fields_of(kind);
    out.push_back({{"name", name_of(kind)},
                   {"a", fields.a},
                   {"b", fields.b},
                   {"colour", render::css(render::palette::event(kind))}});
  }
  return out;
}

template <class Enum>
json words_json() {
  json out = json::array();
  for (const auto& entry : kEnumNames<Enum>) out.push_back(entry.name);
  return out;
}

/// Returns the outcome of an event in a word or two; empty: unknown.
std::string_view outcome_of(const trace::Event& e) {
  switch (e.kind) {
    case EventKind::face_test:
    case EventKind::contact:
      return name_of(e.meet);
    case EventKind::node_pair:
      return name_of(e.node_end().step);
    case EventKind::point:
      return name_of(e.where());
    case EventKind::cap:
      return trace::text_of(e.verdict());
    case EventKind::pass:
      return name_of(e.stage());
    default:
      return {};
  }
}

/// The outcomes of events: a list of texts, and for each event the index of its text.
json outcomes_json(const trace::Trace& trace, const std::vector<trace::EventId>& kept) {
  std::vector<std::string_view> words;
  const auto number = [&](trace::EventId id) -> std::uint32_t {
    const trace::Event& e = trace.events[id];
    const bool is_end = e.kind == EventKind::node_pair && e.node_pair().work.met == 0;
    const std::string_view word = is_end && !trace.header.engine.empty() ? "disjoint" : outcome_of(e);
    if (word.empty()) return kNull;
    const auto at = std::find(words.begin(), words.end(), word);
    if (at == words.end()) words.push_back(word);
    return static_cast<std::uint32_t>(std::find(words.begin(), words.end(), word) - words.begin());
  };
  const std::string numbers = packed_each(kept, number);
  return {{"words", words}, {"numbers", numbers}};
}

json events_json(const trace::Trace& trace, const trace::WorkChart& chart,
                 const std::vector<trace::EventId>& kept) {
  const auto column = [&](auto get) {
    return packed_each(kept, [&](trace::EventId id) { return get(trace.events[id]); });
  };
  using trace::Event;
  return {{"count", kept.size()},
          {"id", kept.size() < trace.events.size() ? packed(kept) : ""},
          {"kind", column([](const Event& e) { return e.kind; })},
          {"side", column([](const Event& e) { return e.side; })},
          {"meet", column([](const Event& e) { return e.meet; })},
          {"a", column([](const Event& e) { return e.a; })},
          {"b", column([](const Event& e) { return e.b; })},
          {"cause", column([](const Event& e) { return e.cause; })},
          {"boundary", column([](const Event& e) {
             return e.changes_wrapper() || e.kind == EventKind::pass_end ? e.boundary : std::uint32_t{kNull};
           })},
          {"outcomes", outcomes_json(trace, kept)},
          {"work", packed_each(kept,
                               [&](trace::EventId id) {
                                 const std::uint8_t part = chart.of_event[id];
                                 return part == trace::WorkChart::kNone ? std::uint32_t{kNull} : part;
                               })},
          {"depthA", column([](const Event& e) { return e.depth_a; })},
          {"depthB", column([](const Event& e) { return e.depth_b; })}};
}

json steps_json(const frames::RecordedRun& p, const Numbers& steps, const SceneFrame& frame) {
  const auto column = [&](auto get) {
    return packed_each(steps, [&](std::uint32_t s) { return get(p.trace->steps[s]); });
  };
  json poses = json::array();
  for (std::size_t i = 0; i < p.reps.size(); ++i) poses.push_back(packed(poses_of(p, i, steps, frame)));
  return {{"count", steps.size()},
          {"index", column([](const trace::Step& s) { return s.index; })},
          {"first", column([](const trace::Step& s) { return s.first_event; })},
          {"poses", std::move(poses)}};
}

/// The key figures of each step: the names of all of them, and lists of [index of the name, value, note].
json answers_json(const frames::RecordedRun& p, const Numbers& steps) {
  std::vector<std::string> names;
  json of_steps = json::array(), meanings = json::array();
  for (const std::uint32_t step : steps) {
    json& out = of_steps.emplace_back(json::array());
    for (const report::Number& n : step_numbers(p, step)) {
      const auto at = std::find(names.begin(), names.end(), n.label);
      const auto index = at - names.begin();
      if (at == names.end()) {
        names.push_back(n.label);
        meanings.push_back(meaning_of_column(n.label));
      }
      out.push_back({index, n.value, n.note});
    }
  }
  if (names.empty()) return nullptr;
  return {{"names", names}, {"meanings", std::move(meanings)}, {"steps", std::move(of_steps)}};
}

/// The contact curves of each step, in the page's frame: the step (an index into `steps`), the number of
/// points, and whether it is closed. A point contact is a curve of one point. Null if the contacts are not
/// known.
json curves_json(const frames::RecordedRun& p, const Numbers& steps, const SceneFrame& frame) {
  if (p.results == nullptr) return nullptr;
  Numbers of_step, sizes, closed;
  std::vector<float> points;
  for (std::uint32_t i = 0; i < steps.size(); ++i) {
    if (steps[i] >= p.results->size()) continue;
    const auto add = [&](std::span<const Eigen::Vector3d> curve, bool is_closed) {
      of_step.push_back(i);
      sizes.push_back(static_cast<std::uint32_t>(curve.size()));
      closed.push_back(is_closed ? 1 : 0);
      for (const Eigen::Vector3d& x : curve) frame.add_point(points, x);
    };
    for (const ContactRegion& region : (*p.results)[steps[i]].regions) {
      if (region.loops.empty()) add({&region.centroid, 1}, false);
      for (const ContactLoop& loop : region.loops) add(loop.points, loop.closed);
    }
  }
  return {{"step", packed(of_step)},
          {"size", packed(sizes)},
          {"closed", packed(closed)},
          {"points", packed(points)}};
}

Numbers steps_of(const trace::Trace& trace, const std::vector<trace::EventId>& kept) {
  Numbers out;
  for (const trace::EventId id : kept) {
    if (!out.empty() && id < trace.steps[out.back()].first_event + trace.events_of(out.back()).size())
      continue;
    out.push_back(static_cast<std::uint32_t>(trace.step_of(id)));
  }
  return out;
}

/// The pairs that another engine got wrong, by the page's steps; null: unknown.
json wrong_json(const frames::RecordedRun& p, const Numbers& steps) {
  if (p.wrong == nullptr || p.wrong->empty()) return nullptr;
  Numbers step, a, b, missed;
  for (std::uint32_t i = 0; i < steps.size(); ++i)
    for (const pictures::WrongPair& w : (*p.wrong)[steps[i]].pairs) {
      step.push_back(i);
      a.push_back(w.pair.a.value());
      b.push_back(w.pair.b.value());
      missed.push_back(w.missed ? 1 : 0);
    }
  return {{"step", packed(step)}, {"a", packed(a)}, {"b", packed(b)}, {"missed", packed(missed)}};
}

std::string thinned_text(const trace::Trace& trace, const record::ThinnedEvents& events,
                         const std::string& trace_file) {
  if (events.all(trace)) return {};
  std::string out = "Of the run's " + render::group_digits(trace.events.size()) +
                    " events, this page contains " + render::group_digits(events.kept.size()) + ": ";
  const std::string whole =
      trace_file.empty() ? "`import --trace` writes all of them." : trace_file + " contains all of them.";
  if (trace.header.construction) return out + "all regions, and others evenly spaced. " + whole;
  out += events.cut ? "the first refinements"
         : events.steps < trace.steps.size()
             ? "of " + render::group_digits(events.steps) + " of " +
                   render::group_digits(trace.steps.size()) + " time steps, all refinements"
             : "all refinements, then contacts";
  return out + ", and others, evenly spaced, up to a size limit. " + whole;
}

/// Returns the passes of a construction, with their ends and a description of their results; null for other
/// runs.
json passes_json(const trace::Trace& trace) {
  if (!trace.header.construction) return nullptr;
  json out = json::array();
  for (const trace::PassSummary& p : trace::passes_of(trace))
    out.push_back({{"first", p.first},
                   {"last", p.last},
                   {"words", frames::pass_text(p)},
                   {"stage", name_of(p.stage)},
                   {"limit", p.max_deviation}});
  return out;
}

/// Returns the data of attempts to cover the front: the vertices of each patch among the kept
/// events, and the meaning of verdicts; null for other runs than constructions.
json attempts_json(const trace::Trace& trace, const std::vector<trace::EventId>& kept) {
  if (!trace.header.construction) return nullptr;
  Numbers counts, vertices;
  for (const trace::EventId id : kept) {
    if (trace.events[id].kind != EventKind::patch) continue;
    const std::span<const VertexId> own = trace.vertices_of(trace.events[id]);
    counts.push_back(static_cast<std::uint32_t>(own.size()));
    vertices.insert(vertices.end(), own.begin(), own.end());
  }
  json verdicts = json::object();
  for (const auto& [verdict, name] : kEnumNames<CapVerdict>)
    verdicts[std::string(trace::text_of(verdict))] = meaning_of(verdict);
  return {{"counts", packed(counts)}, {"vertices", packed(vertices)}, {"verdicts", std::move(verdicts)}};
}

std::string too_large_text(std::size_t faces, const SceneLimits& limits) {
  return "No 3D view: the bodies have " + render::group_digits(faces) +
         " faces including their regions, and the limit for a page is " + render::group_digits(limits.faces) +
         ". Draw them with lrbscope render.";
}

/// Returns the viewpoint of the first view of the frames, at which the page's view starts. Returns null if
/// none is given.
json view_json(const trace::TraceHeader& header) {
  const std::vector<pictures::FrameSpec::View> views =
      spec::read_pictures(header.pictures, header.scenario).views;
  if (views.empty() || views[0].camera == pictures::FrameSpec::Camera::fixed) return nullptr;
  return run::view_json({views[0].from, views[0].up}, views[0].orthographic);
}

}  // namespace

json view_json(const render::ViewDirection& view, bool orthographic) {
  const auto vector = [](const Eigen::Vector3d& v) { return json({v.x(), v.y(), v.z()}); };
  return {{"from", vector(view.from)}, {"up", vector(view.up)}, {"orthographic", orthographic}};
}

std::string scene_json(const frames::RecordedRun& p, const SceneSource& source, const SceneLimits& limits) {
  const trace::Trace& trace = *p.trace;
  const record::ThinnedEvents events = record::thin_events(trace, limits.events);
  const Numbers steps = steps_of(trace, events.kept);
  const SceneFrame frame = scene_frame(p);
  const trace::WorkChart work = work_of(trace);
  std::size_t faces = 0;
  for (const LrbRep* rep : p.reps) faces += rep->face_count();
  json bodies = json::array();
  for (std::size_t i = 0; i < p.reps.size(); ++i) bodies.push_back(body_json(p, i, frame, limits, faces));
  const json out = {
      {"dim", p.reps[0]->dim()},
      {"origin", {frame.origin.x(), frame.origin.y(), frame.origin.z()}},
      {"unit", frame.unit},
      {"view", view_json(trace.header)},
      {"wrapper", name_of(trace.header.request.wrapper)},
      {"thinned", thinned_text(trace, events, source.trace_file)},
      {"tooLarge", faces <= limits.faces ? "" : too_large_text(faces, limits)},
      {"trace", source.trace_file},
      {"firstContact", static_cast<std::int64_t>(record::first_contact(trace) == kNull
                                                     ? std::int64_t{-1}
                                                     : std::int64_t{record::first_contact(trace)})},
      {"work", work_json(trace, work)},
      {"wrong", wrong_json(p, steps)},
      {"measured", measured_json(p, frame)},
      {"answers", answers_json(p, steps)},
      {"curves", curves_json(p, steps, frame)},
      {"map", map_json(p, steps, limits)},
      {"kinds", kinds_json()},
      {"phases", words_json<Phase>()},
      {"engine", trace.header.engine},
      {"passes", passes_json(trace)},
      {"attempts", attempts_json(trace, events.kept)},
      {"relations", words_json<Relation>()},
      {"meets", words_json<exact::Meet>()},
      {"allEvents", trace.events.size()},
      {"colours", scene_colours()},
      {"bodies", std::move(bodies)},
      {"why", explanations_json(p, {events.kept, steps}, frame, source.why, limits.explained)},
      {"steps", steps_json(p, steps, frame)},
      {"events", events_json(trace, work, events.kept)}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

json scene_colours() {
  namespace palette = render::palette;
  using render::css;
  constexpr std::uint32_t kStops = 17, kCategories = 96;
  json scale = json::array(), categories = json::array();
  for (std::uint32_t i = 0; i < kStops; ++i)
    scale.push_back(css(palette::heat(static_cast<double>(i) / (kStops - 1))));
  for (std::uint32_t i = 0; i < kCategories; ++i) categories.push_back(css(palette::category(i)));
  return {{"bodies", {css(palette::body(Side::a)), css(palette::body(Side::b))}},
          {"contact", css(palette::kContact)},
          {"refining", css(palette::kRefining)},
          {"underTest", css(palette::kUnderTest)},
          {"selected", css(palette::kPurple)},
          {"wrong", css(palette::kWrong)},
          {"ink", css(palette::kInk)},
          {"edgeInk", css(palette::kEdgeInk)},
          {"shares",
           {{"edge", palette::kEdgeShare},
            {"lid", palette::kLidPale},
            {"ground", palette::kGroundPale},
            {"noValue", palette::kNoValuePale}}},
          {"separationVector", css(pictures::kSeparationColour)},
          {"scale", std::move(scale)},
          {"categories", std::move(categories)}};
}

}  // namespace lrb::run

#include <cctype>
#include <cmath>

#include "render/pictures/body_picture.hpp"
#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/record/engine_run.hpp"
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::frames {
namespace {

std::string text_of(Relation r) {
  switch (r) {
    case Relation::a_inside_b:
      return "A inside B";
    case Relation::b_inside_a:
      return "B inside A";
    default:
      return to_string(r);
  }
}

}  // namespace

std::string pass_text(const trace::PassSummary& pass) {
  std::string out = "pass " + std::to_string(pass.number()) + ": " +
                    render::counted(pass.regions, "region", "regions") + ", " +
                    render::group_digits(pass.faces_before) + " to " +
                    render::counted(pass.faces_after, "face", "faces");
  if (pass.rejected() > 0)
    out += ", " + render::counted(pass.rejected(), "cap", "caps") +
           " rejected: " + trace::rejection_text(pass.caps);
  return out;
}

std::string stage_text(const trace::PassSummary& pass) {
  std::string out(name_of(pass.stage));
  if (pass.max_deviation > 0) out += ", max. deviation " + render::short_number(pass.max_deviation);
  return out;
}

namespace {

std::string cap_text(const trace::Event& e) {
  const trace::payload::Cap cap = e.cap();
  const std::string size = cap.covered == 0 ? "no cap, because no vertex could be removed"
                                            : "cap of " + render::counted(cap.faces, "face", "faces") +
                                                  " over " + render::group_digits(cap.covered);
  std::string out = size + ": " + std::string(trace::text_of(cap.verdict));
  if (std::isfinite(cap.deviation)) out += ", deviation " + render::short_number(cap.deviation);
  return out;
}

}  // namespace

std::string built_text(const trace::Event& e) {
  switch (e.kind) {
    case EventKind::pass:
      return "pass " + std::to_string(e.pass().layer + 1) + " begins: " + std::string(name_of(e.stage()));
    case EventKind::patch:
      return "patch of " + render::counted(e.patch().faces, "face", "faces") + " grown from vertex " +
             std::to_string(e.patch().vertex);
    case EventKind::cap:
      return cap_text(e);
    case EventKind::region:
      return "region " + std::to_string(e.region()) +
             " created: " + render::counted(e.wrapper_change().faces, "face", "faces") + " covered";
    case EventKind::merged:
      return render::counted(e.merged().pieces, "inner shell", "inner shells") + " merged into region " +
             std::to_string(e.merged().into);
    case EventKind::closed:
      return "built: " + render::counted(e.closed().regions, "region", "regions") +
             ", outermost wrapper of " + render::counted(e.closed().outer_faces, "face", "faces");
    default:
      return {};
  }
}

std::string error_bound_text(double bound) {
  return bound == 0 ? "0 (exact)" : std::isfinite(bound) ? render::short_number(bound) : "none yet";
}

std::string FrameState::isolated_text() const {
  std::string out;
  for (std::size_t i = 0; i < run_.reps.size(); ++i) {
    if (spec_.isolate[i].empty()) continue;
    const std::string owner = is_single() ? "" : i == 0 ? " of A" : " of B";
    out += (out.empty() ? "" : "; ") + pictures::region_text(*run_.reps[i], spec_.isolate[i], owner);
  }
  return out;
}

std::string FrameState::event_text() const {
  if (const std::string regions = isolated_text(); !regions.empty()) return regions;
  if (trace_.header.construction) return construction_text();
  const trace::Event& e = cursor_.event();
  const std::string side = e.side == Side::a ? "A" : "B";
  const auto face_of = [&](Side of) { return rep(of).face_of_simplex(e.simplex(of)); };
  const auto face = [&](Side of) {
    const FaceId f = face_of(of);
    return (rep(of).is_real(f) ? "face " : "pseudo face ") + std::to_string(f);
  };
  const std::string region = "region " + std::to_string(e.region()) + (is_single() ? "" : " of " + side);
  switch (e.kind) {
    case EventKind::step:
      return first_wrappers_text();
    case EventKind::face_test:
      return "face test " + std::to_string(face_of(Side::a)) + " against " +
             std::to_string(face_of(Side::b)) + ": " + std::string(trace::name_of(e.meet));
    case EventKind::refine:
      return "refine " + region + ": " + render::counted(e.wrapper_change().faces, "face", "faces") +
             " exposed";
    case EventKind::coarsen:
      return region + " added";
    case EventKind::contact:
      return "contact: " + face(Side::a) + " of A and " + face(Side::b) + " of B";
    case EventKind::result:
      return result_text();
    case EventKind::plane_test:
      return "simplex " + std::to_string(e.a) + " of A and " + std::to_string(e.b) +
             " of B: separated by the plane of " + side + "'s";
    case EventKind::node_pair:
      return node_pair_text(e);
    case EventKind::point:
      return "vertex " + std::to_string(e.a) + " of " + side + ": " + std::string(name_of(e.where())) +
             (e.side == Side::a ? " of B" : " of A");
    case EventKind::begin:
      return std::string(name_of(e.phase())) + " begins";
    case EventKind::end:
      return std::string(name_of(e.phase())) + " ends";
    default:  // of constructions
      return {};
  }
}

std::string FrameState::construction_text() const {
  const trace::Event& e = cursor_.event();
  if (e.kind == EventKind::step)
    return "the body, " + render::counted(run_.reps[0]->real_face_count(), "face", "faces");
  return e.kind == EventKind::pass_end ? pass_text(*now_.pass) : built_text(e);
}

std::string FrameState::first_wrappers_text() const {
  const auto has_none = [](const LrbRep* rep) { return rep->region_count() == 0; };
  if (is_single()) return has_none(run_.reps[0]) ? "the body (it has no wrapper)" : "the outermost wrapper";
  const bool a = has_none(run_.reps[0]), b = has_none(run_.reps[1]);
  if (a && b) return "the bodies (they have no wrappers)";
  if (a || b)
    return std::string(a ? "A (it has no wrapper) and B's" : "B (it has no wrapper) and A's") +
           " outermost wrapper";
  return "both outermost wrappers";
}

std::string FrameState::open_text() const {
  const bool a = !run_.reps[0]->closed(), b = !run_.reps[1]->closed();
  return a && b ? "undefined, because both bodies are open"
         : a    ? "undefined, because A is open"
                : "undefined, because B is open";
}

std::string FrameState::node_pair_text(const trace::Event& e) {
  const auto [a, b, work, end, pairs_above, engine_axis] = e.node_pair();
  std::string out = "nodes " + std::to_string(a) + " of A and " + std::to_string(b) + " of B: ";
  if (work.met == 0 && engine_axis > 0) return out + "disjoint along " + record::axis_words(engine_axis - 1U);
  if (work.met == 0)
    return out + (end.apart                     ? "disjoint along " + std::string(name_of(end.axis))
                  : end.step == NodeStep::whole ? "disjoint across an edge of each"
                                                : "no overlapping boxes in them");
  if (end.step != NodeStep::leaves)
    return out + render::counted(work.met, "overlapping pair of boxes", "overlapping pairs of boxes");
  return out + render::counted(work.met, "pair of faces", "pairs of faces") + ", " +
         render::counted(work.met - work.rejected, "left to test", "left to test");
}

std::string text_of(const trace::MeasuredNearPairs& near) {
  return render::counted(near.found, "pair", "pairs") + " of faces within " +
         render::short_number(near.within);
}

std::string text_of(const trace::MeasuredManifolds& manifolds) {
  if (manifolds.manifolds == 0) return "no contact manifold";
  return render::counted(manifolds.manifolds, "contact manifold", "contact manifolds") + " with " +
         render::counted(manifolds.found, "point", "points");
}

std::string text_of(const trace::MeasuredPoints& points) {
  std::string out = render::counted(points.count, "point", "points");
  if (points.has_sides)
    out = render::group_digits(points.inside) + " of " + out + " inside" +
          (points.on_surface > 0 ? ", " + render::group_digits(points.on_surface) + " on the surface" : "");
  if (!points.smallest.empty())
    out +=
        ", smallest distance " + pictures::interval_text(points.smallest[0].lower, points.smallest[0].upper);
  return out;
}

std::string FrameState::measured_text() const {
  if (now_.answer == nullptr) return {};
  std::string out;
  if (now_.gap) out = "distance " + now_.gap->text;
  if (now_.answer->clash && now_.answer->clash->kind != ClashKind::apart)
    out +=
        (out.empty() ? "" : ", ") + pictures::kind_text(now_.answer->clash->kind, now_.answer->clash->reason);
  if (now_.separation_vector) out += ", depth " + now_.separation_vector->text;
  if (now_.answer->near) out += (out.empty() ? "" : ", ") + text_of(*now_.answer->near);
  if (now_.answer->manifold) out += (out.empty() ? "" : ", ") + text_of(*now_.answer->manifold);
  if (now_.answer->points) out += (out.empty() ? "" : ", ") + text_of(*now_.answer->points);
  return out;
}

std::uint32_t FrameState::boundary_size(Side side) const {
  return now_.proof != nullptr ? now_.proof->face_count[static_cast<std::size_t>(side)]
                               : cursor_.boundary_size(side);
}

trace::Totals FrameState::totals() const {
  return trace::count_events(events_so_far());
}

std::string FrameState::result_text() const {
  const std::string measured = measured_text();
  if (measured.empty()) return relation_text();
  const Relation relation = cursor_.step()->result.relation;
  return (relation == Relation::separate ? "separate: " : relation_text() + "; ") + measured;
}

std::string FrameState::relation_text() const {
  const trace::StepResult& r = cursor_.step()->result;
  if (const Separation* proof = now_.proof)
    return "separate: wrappers of " + render::group_digits(proof->face_count[0]) + " and " +
           render::counted(proof->face_count[1], "face prove it", "faces prove it");
  if (r.relation == Relation::unresolved)
    return std::isfinite(r.error_bound)
               ? "unresolved: in contact, or at a distance of at most " + render::short_number(r.error_bound)
               : "unresolved: the limit was reached before the coarsest wrappers were compared";
  if (now_.separating) {
    const std::string words = pictures::separating_plane_text(*now_.separating, bodies());
    if (!words.empty()) return "separated " + words;
  }
  const bool open = !run_.reps[0]->closed() || !run_.reps[1]->closed();
  return (r.relation == Relation::undefined && open ? open_text() : text_of(r.relation)) + ": " +
         render::counted(r.pair_count, "intersecting pair of faces", "intersecting pairs of faces");
}

render::Overlay FrameState::overlay(const std::string& title) const {
  render::Overlay o;
  o.title = title;
  if (!is_single()) o.title += "  ·  step " + std::to_string(step());
  o.event = event_text();
  o.event_colour = now_.separating ? pictures::kSeparationColour
                   : now_.separation_vector
                       ? pictures::kSeparationColour
                       : style_of(spec_.style).of(render::palette::event(cursor_.event().kind));
  o.style = spec_.style;
  if (trace_.header.construction) {
    add_construction(o);
    return o;
  }
  add_counters(o);
  return o;
}

void FrameState::add_counters(render::Overlay& o) const {
  if (!is_single()) return add_pair_counters(o);
  const trace::Totals t = totals();
  o.counters = {{"wrapper", render::group_digits(cursor_.boundary_size(Side::a)) + " faces"},
                {"refined", render::group_digits(t.refinements[0] - t.coarsenings[0]) + " of " +
                                render::group_digits(run_.reps[0]->region_count()) + " regions"}};
}

void FrameState::add_pair_counters(render::Overlay& o) const {
  const trace::Totals t = totals();
  if (trace_.header.engine.empty()) {
    const auto refined = [&](Side side) {
      const auto i = static_cast<std::size_t>(side);
      return now_.proof != nullptr ? std::uint64_t{now_.proof->refined[i].size()} : t.refinements[i];
    };
    for (const Side side : {Side::a, Side::b})
      o.counters.push_back({std::string(rep(side).region_count() > 0 ? "wrapper " : "no wrapper, ") +
                                (side == Side::a ? "A" : "B"),
                            render::group_digits(boundary_size(side))});
    o.counters.push_back(
        {"refined", render::group_digits(refined(Side::a)) + " + " + render::group_digits(refined(Side::b))});
  } else {  // another engine has no wrappers
    o.counters.push_back({"pairs of boxes", render::group_digits(t.node_pairs)});
  }
  o.counters.push_back({"face tests", render::group_digits(t.face_tests)});
  o.counters.push_back({"contacts", render::group_digits(t.contacts)});
  if (!now_.wrong.empty()) o.counters.push_back({"wrong pairs", render::group_digits(now_.wrong.size())});
  if (now_.answer != nullptr && trace_.header.request.is_coarse())
    o.counters.push_back({"error bound", error_bound_text(now_.answer->error_bound)});
}

void FrameState::add_construction(render::Overlay& o) const {
  std::uint64_t made = 0;
  for (const trace::PassSummary& p : passes_)
    if (p.last <= cursor_.position()) made += p.regions;
  if (const trace::PassSummary* pass = now_.pass) {
    if (pass->last > cursor_.position()) made += now_.built.size();
    o.title += "  ·  " + stage_text(*pass);
  }
  o.counters = {
      {"front", render::counted(cursor_.boundary_size(Side::a), "face", "faces")},
      {"regions", render::group_digits(made) + " of " + render::group_digits(run_.reps[0]->region_count())}};
}

std::string FrameState::construction_caption() const {
  std::string text = event_text();
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  const trace::PassSummary* pass = now_.pass;
  if (!now_.is_pass_end)
    return text + ". Front: " + render::counted(cursor_.boundary_size(Side::a), "face", "faces") + ".";
  text += ". " + std::string(name_of(pass->stage));
  if (pass->max_deviation > 0)
    text += " with caps of deviation at most " + render::short_number(pass->max_deviation) +
            " (largest: " + render::short_number(pass->deviation) + ")";
  if (pass->covered > 0)
    text += "; " + render::counted(pass->accepted(), "cap", "caps") + " of " +
            render::counted(pass->lids, "face", "faces") + " over " + render::group_digits(pass->covered);
  return text + ".";
}

std::string FrameState::short_caption() const {
  if (trace_.header.construction) {
    const std::uint32_t faces = cursor_.boundary_size(Side::a);
    const bool built = faces == run_.reps[0]->outermost_faces().size();
    const trace::PassSummary* pass = now_.pass;
    if (pass == nullptr) return "the body, " + render::counted(faces, "face", "faces");
    return "pass " + std::to_string(pass->number()) + (built ? ", the outermost wrapper" : "") + ", " +
           render::counted(faces, "face", "faces");
  }
  if (is_single()) {
    const trace::Totals t = totals();
    const std::uint64_t refined = t.refinements[0] - t.coarsenings[0], all = run_.reps[0]->region_count();
    const std::string state = all == 0         ? "the body (it has no wrappers)"
                              : refined == 0   ? "outermost wrapper"
                              : refined == all ? "the body"
                                               : render::group_digits(refined) + " of " +
                                                     render::counted(all, "region", "regions") + " refined";
    return state + ", " + render::counted(cursor_.boundary_size(Side::a), "face", "faces");
  }
  return "step " + std::to_string(step()) + ": " + event_text();
}

std::string FrameState::caption() const {
  if (trace_.header.construction) return construction_caption();
  const trace::Totals t = totals();
  std::string out = !is_single() ? "Step " + std::to_string(step()) + ", event " : "Event ";
  out += std::to_string(cursor_.position()) + ": " + event_text() + ". ";
  out += is_single() ? "Wrapper: " + render::group_digits(cursor_.boundary_size(Side::a)) + " faces."
         : !trace_.header.engine.empty()
             ? render::counted(t.node_pairs, "pair of nodes", "pairs of nodes") + ", " +
                   render::counted(t.face_tests, "face test", "face tests") + "."
             : "Wrappers: " + render::group_digits(boundary_size(Side::a)) + " + " +
                   render::group_digits(boundary_size(Side::b)) + " faces; " +
                   render::counted(t.face_tests, "face test", "face tests") + ", " +
                   render::counted(t.refinements[0] + t.refinements[1], "refinement", "refinements") + ".";
  if (now_.answer != nullptr && trace_.header.request.is_coarse())
    out += " Error bound: " + error_bound_text(now_.answer->error_bound) +
           (now_.answer->finished ? "." : "; a limit was reached.");
  return out;
}

}  // namespace lrb::frames

#include "scenarios/frames/frame_state.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "render/pictures/body_picture.hpp"
#include "render/pictures/explain_picture.hpp"
#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/frames/face_colours.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/frames/pass_words.hpp"
#include "scenarios/record/moments.hpp"
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {
namespace {

trace::Cursor make_cursor(const trace::Trace& trace, const std::vector<const LrbRep*>& reps) {
  return reps.size() == 1 ? trace::Cursor(trace, *reps[0]) : trace::Cursor(trace, *reps[0], *reps[1]);
}

std::string relation_words(Relation r) {
  switch (r) {
    case Relation::a_inside_b:
      return "A inside B";
    case Relation::b_inside_a:
      return "B inside A";
    default:
      return to_string(r);
  }
}

/// Returns a mesh's name without folder and extension.
std::string short_name(const LrbRep& rep) {
  return std::filesystem::path(rep.name()).stem().string();
}

}  // namespace

std::string error_bound_text(double bound) {
  return bound == 0 ? "0 (exact)" : std::isfinite(bound) ? render::short_number(bound) : "none yet";
}

FrameState::FrameState(const trace::Trace& trace, std::vector<const LrbRep*> reps,
                       const std::vector<CollideResult>& results, const render::FrameSpec& spec,
                       bool point_out_refined, const FrameExtras& extras)
    : trace_(trace),
      reps_(std::move(reps)),
      results_(results),
      spec_(spec),
      extras_(extras),
      point_out_refined_(point_out_refined),
      cursor_(make_cursor(trace, reps_)),
      passes_(trace::passes_of(trace)) {}

void FrameState::seek(trace::EventId event) {
  cursor_.seek(event);
}

const trace::PassSummary* FrameState::pass_here() const {
  const auto after = std::find_if(passes_.begin(), passes_.end(),
                                  [&](const trace::PassSummary& p) { return p.first > cursor_.position(); });
  return after == passes_.begin() ? nullptr : &*(after - 1);
}

bool FrameState::at_pass_end() const {
  const trace::PassSummary* pass = pass_here();
  return pass != nullptr && pass->last == cursor_.position() && pass->regions > 0;
}

std::vector<RegionId> FrameState::built_here() const {
  std::vector<RegionId> out;
  const trace::PassSummary* pass = pass_here();
  if (pass == nullptr || cursor_.event().kind == EventKind::closed) return out;
  for (trace::EventId e = pass->first; e <= cursor_.position(); ++e)
    if (trace_.events[e].kind == EventKind::region) out.push_back(trace_.events[e].region());
  return out;
}

bool FrameState::at_step_end() const {
  return cursor_.position() == last_event(trace_, cursor_.step_number());
}

const CollideResult* FrameState::result_here() const {
  return at_step_end() && cursor_.step_number() < results_.size() ? &results_[cursor_.step_number()]
                                                                  : nullptr;
}

const trace::StepResult* FrameState::answer_here() const {
  return at_step_end() && cursor_.step()->finished ? &cursor_.step()->result : nullptr;
}

const Separation* FrameState::proof_here() const {
  const trace::StepResult* answer = answer_here();
  return answer != nullptr && answer->separation ? &*answer->separation : nullptr;
}

const WalkExplanation* FrameState::parting_here() const {
  const CollideRequest& request = trace_.header.request;
  const trace::StepResult* answer = answer_here();
  if (answer == nullptr || answer->separation || answer->distance || answer->relation != Relation::separate ||
      request.recursion != Recursion::complete || request.is_coarse() || !trace_.header.engine.empty() ||
      spec_.colour_by >= render::FrameSpec::ColourBy::face_tests)
    return nullptr;
  if (!parting_ || parting_->step != cursor_.step_number())
    parting_ = {cursor_.step_number(),
                explain_walk(*reps_[0], cursor_.pose(Side::a), *reps_[1], cursor_.pose(Side::b))};
  return &parting_->walk;
}

std::optional<MarkedWay> FrameState::gap_here() const {
  const trace::StepResult* answer = answer_here();
  return answer != nullptr && answer->distance ? gap_of(*answer->distance) : std::nullopt;
}

std::optional<MarkedWay> FrameState::way_out_here() const {
  const trace::StepResult* answer = answer_here();
  if (answer == nullptr || !answer->clash) return std::nullopt;
  const CollideResult* result = result_here();
  return way_out_of(
      *answer->clash, *reps_[0], cursor_.pose(Side::a), *reps_[1], cursor_.pose(Side::b),
      result != nullptr ? std::span<const ContactRegion>(result->regions) : std::span<const ContactRegion>());
}

std::string FrameState::measured_text() const {
  const trace::StepResult* answer = answer_here();
  if (answer == nullptr) return {};
  std::string out;
  if (const auto gap = gap_here()) out = gap->text + " apart";
  if (answer->clash && answer->clash->kind != ClashKind::apart)
    out += (out.empty() ? "" : ", ") + kind_words(answer->clash->kind, answer->clash->reason);
  if (const auto way = way_out_here()) out += ", " + way->text + " deep";
  return out;
}

std::span<const WrongPair> FrameState::wrong_here() const {
  if (extras_.wrong == nullptr || !at_step_end() || cursor_.step_number() >= extras_.wrong->size()) return {};
  return (*extras_.wrong)[cursor_.step_number()];
}

std::uint32_t FrameState::boundary_size(Side side) const {
  const Separation* proof = proof_here();
  return proof != nullptr ? proof->face_count[static_cast<std::size_t>(side)] : cursor_.boundary_size(side);
}

std::vector<std::uint8_t> FrameState::met(Side side) const {
  if (!trace_.header.request.is_coarse()) return {};
  const LrbRep& rep = *reps_[static_cast<std::size_t>(side)];
  std::vector<std::uint8_t> out(rep.face_count());
  for (trace::EventId e = cursor_.step()->first_event; e <= cursor_.position(); ++e) {
    const trace::Event& event = trace_.events[e];
    if (event.kind == EventKind::contact) out[rep.face_of_simplex(event.simplex(side))] = 1;
  }
  return out;
}

trace::Totals FrameState::totals() const {
  return trace::count_events(events_so_far());
}

const trace::TreeShape* FrameState::tree_of(Side side) const {
  if (extras_.trees == nullptr || extras_.trees->empty()) return nullptr;
  return &(*extras_.trees)[static_cast<std::size_t>(side)];
}

std::span<const trace::Event> FrameState::events_so_far() const {
  const trace::EventId first = cursor_.step()->first_event;
  return {trace_.events.data() + first, cursor_.position() + std::size_t{1} - first};
}

std::vector<double> FrameState::values_of(Side side) const {
  const auto i = static_cast<std::size_t>(side);
  if (extras_.face_values != nullptr) return (*extras_.face_values)[i];
  return grouped(face_values(spec_.colour_by, *reps_[i], side, events_so_far(), tree_of(side)),
                 spec_.colour_per, *reps_[i]);
}

render::Scene FrameState::scene(bool wrapper, bool plain) const {
  std::vector<render::SceneBody> bodies;
  const std::vector<double> values[2] = {values_of(Side::a),
                                         reps_.size() > 1 ? values_of(Side::b) : std::vector<double>()};
  const Separation* proof = proof_here();
  std::vector<Wrapper> proving;
  std::vector<std::uint8_t> in_contact[2];
  for (std::size_t i = 0; i < reps_.size() && proof != nullptr; ++i) {
    proving.emplace_back(*reps_[i]);
    for (const RegionId r : proof->refined[i]) proving.back().refine(r);
  }
  if (reps_.size() > 1)
    for (const Side side : {Side::a, Side::b}) in_contact[static_cast<std::size_t>(side)] = met(side);
  for (std::size_t i = 0; i < reps_.size(); ++i) {
    const Side side = static_cast<Side>(i);
    render::SceneBody body;
    body.rep = reps_[i];
    if (wrapper) body.wrapper = proof != nullptr ? &proving[i] : &cursor_.wrapper(side);
    body.in_contact = in_contact[i];
    body.pose = cursor_.pose(side);
    body.face_values = values[i];
    body.name =
        reps_.size() == 1 ? short_name(*reps_[i]) : std::string(i == 0 ? "A " : "B ") + short_name(*reps_[i]);
    bodies.push_back(std::move(body));
  }
  render::SceneHighlight highlight;
  if (wrapper && !plain && point_out_refined_)
    for (const trace::RefinedRegion& r : cursor_.refined())
      if (is_shown(r)) highlight.refining[static_cast<std::size_t>(r.side)].push_back(r.region);
  if (const auto pair = cursor_.pair_under_test(); wrapper && !plain && pair && !at_step_end())
    highlight.under_test = {pair->simplex_a, pair->simplex_b};
  if (const CollideResult* result = result_here()) highlight.contacts = result->regions;
  if (wrapper && trace_.header.construction) highlight.built = built_here();
  render::SceneOptions options;
  switch (spec_.colour_by) {
    case render::FrameSpec::ColourBy::kind:
      break;
    case render::FrameSpec::ColourBy::layer:
      options.colour_by = render::ColourBy::layer;
      break;
    case render::FrameSpec::ColourBy::region:
      options.colour_by = render::ColourBy::region;
      break;
    default:
      options.colour_by = render::ColourBy::value;
      options.value_name = std::string(name_of(spec_.colour_by));
      std::replace(options.value_name.begin(), options.value_name.end(), '_', ' ');
      if (spec_.colour_per != render::FrameSpec::ColourPer::face)
        options.value_name += " in the " + std::string(name_of(spec_.colour_per));
      else if (spec_.colour_by == render::FrameSpec::ColourBy::box_tests)
        options.value_range = scale_without_the_smallest(values);
      if (!extras_.value_name.empty()) options.value_name = extras_.value_name;
      if (extras_.value_range) options.value_range = extras_.value_range;
      break;
  }
  options.explode = spec_.explode;
  options.contact_rims = true;
  const render::Style& style = style_of(spec_);
  options.style = style_name(spec_);
  options.scale = static_cast<float>(spec_.scale()) * style.weight;
  options.isolate = spec_.isolate;
  options.ghost_rest = spec_.ghost_rest;
  render::Scene scene = render::build_scene(bodies, highlight, options);
  if (const WalkExplanation* walk = plain ? nullptr : parting_here())
    add_parting(scene.list, *walk, *reps_[0], cursor_.pose(Side::a), *reps_[1], cursor_.pose(Side::b), style);
  if (const auto gap = gap_here()) add_gap(scene, *gap, style);
  if (const auto way = way_out_here()) add_way_out(scene, *way, reps_[0]->dim());
  if (const std::span<const WrongPair> wrong = wrong_here(); !plain && !wrong.empty()) {
    add_wrong_pairs(scene.list, wrong, *reps_[0], cursor_.pose(Side::a), *reps_[1], cursor_.pose(Side::b),
                    style.paper);
    scene.key.push_back({render::LegendItem::Mark::line, render::palette::kWrong, "pair got wrong"});
  }
  for (const Side side : {Side::a, Side::b})
    if (const trace::TreeShape* tree = tree_of(side); spec_.node_boxes && tree != nullptr)
      add_node_boxes(scene, *tree, side, cursor_.pose(side), *spec_.node_boxes, events_so_far(), style);
  return scene;
}

bool FrameState::is_shown(const trace::RefinedRegion& r) const {
  if (spec_.isolate[0].empty() && spec_.isolate[1].empty()) return true;
  const std::vector<RegionId>& of_side = spec_.isolate[static_cast<std::size_t>(r.side)];
  return std::find(of_side.begin(), of_side.end(), r.region) != of_side.end();
}

std::string FrameState::isolated_text() const {
  std::string out;
  for (std::size_t i = 0; i < reps_.size(); ++i) {
    if (spec_.isolate[i].empty()) continue;
    const std::string owner = reps_.size() == 1 ? "" : i == 0 ? " of A" : " of B";
    out += (out.empty() ? "" : "; ") + region_words(*reps_[i], spec_.isolate[i], owner);
  }
  return out;
}

std::string FrameState::event_text() const {
  if (const std::string regions = isolated_text(); !regions.empty()) return regions;
  const trace::Event& e = cursor_.event();
  if (trace_.header.construction) {
    if (e.kind == EventKind::step)
      return "the body, " + render::counted(reps_[0]->real_face_count(), "face", "faces");
    return e.kind == EventKind::pass_end ? pass_words(*pass_here()) : built_words(e);
  }
  const std::string side = e.side == Side::a ? "A" : "B";
  const auto face_of = [&](Side of) {
    return reps_[static_cast<std::size_t>(of)]->face_of_simplex(e.simplex(of));
  };
  const auto face = [&](Side of) {
    const FaceId f = face_of(of);
    return (reps_[static_cast<std::size_t>(of)]->is_real(f) ? "face " : "pseudo face ") + std::to_string(f);
  };
  const std::string region =
      "region " + std::to_string(e.region()) + (reps_.size() == 1 ? "" : " of " + side);
  switch (e.kind) {
    case EventKind::step:
      return first_wrappers_text();
    case EventKind::face_test:
      return "face test " + std::to_string(face_of(Side::a)) + " against " +
             std::to_string(face_of(Side::b)) + ": " + std::string(trace::name_of(e.meet));
    case EventKind::refine:
      return "refine " + region + ": " + render::counted(e.b, "face", "faces") + " under it";
    case EventKind::coarsen:
      return region + " added";
    case EventKind::contact:
      return "contact: " + face(Side::a) + " of A meets " + face(Side::b) + " of B";
    case EventKind::result:
      return result_text();
    case EventKind::plane_test:
      return "simplex " + std::to_string(e.a) + " of A and " + std::to_string(e.b) +
             " of B: parted by the plane of " + side + "'s";
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

std::string FrameState::first_wrappers_text() const {
  const auto has_none = [](const LrbRep* rep) { return rep->region_count() == 0; };
  if (reps_.size() == 1)
    return has_none(reps_[0]) ? "the body itself, which has no wrapper" : "the outermost wrapper";
  const bool a = has_none(reps_[0]), b = has_none(reps_[1]);
  if (a && b) return "the bodies themselves, which have no wrappers";
  if (a || b)
    return std::string(a ? "A itself, which has no wrapper; B's" : "B itself, which has no wrapper; A's") +
           " is the outermost one";
  return "both wrappers are the outermost ones";
}

std::string FrameState::open_text() const {
  const bool a = !reps_[0]->closed(), b = !reps_[1]->closed();
  return a && b ? "undefined, for both bodies are open"
         : a    ? "undefined, for A is open"
                : "undefined, for B is open";
}

std::string FrameState::node_pair_text(const trace::Event& e) {
  const trace::NodeWork work = e.work();
  const trace::NodeEnd end = e.node_end();
  std::string out = "nodes " + std::to_string(e.a) + " of A and " + std::to_string(e.b) + " of B: ";
  if (work.met == 0)
    return out + (end.apart                     ? "apart along " + std::string(name_of(end.axis))
                  : end.step == NodeStep::whole ? "apart across an edge of each"
                                                : "no boxes in them meet");
  if (end.step != NodeStep::leaves)
    return out + render::counted(work.met, "pair of boxes meets", "pairs of boxes meet");
  return out + render::counted(work.met, "pair of faces", "pairs of faces") + ", " +
         render::counted(work.met - work.parted, "left to test", "left to test");
}

std::string FrameState::result_text() const {
  const std::string measured = measured_text();
  if (measured.empty()) return relation_text();
  const Relation relation = cursor_.step()->result.relation;
  return (relation == Relation::separate ? "separate: " : relation_text() + "; ") + measured;
}

std::string FrameState::relation_text() const {
  const trace::StepResult& r = cursor_.step()->result;
  if (const Separation* proof = proof_here())
    return "separate: wrappers of " + render::group_digits(proof->face_count[0]) + " and " +
           render::counted(proof->face_count[1], "face prove it", "faces prove it");
  if (r.relation == Relation::unresolved)
    return std::isfinite(r.error_bound)
               ? "unresolved: in contact, or no further apart than " + render::short_number(r.error_bound)
               : "unresolved: the limit came before the coarsest wrappers were compared";
  if (const WalkExplanation* walk = parting_here()) {
    const trace::Step& step = *cursor_.step();
    const std::string words = parting_words(*walk, *reps_[0], step.pose_a, *reps_[1], step.pose_b);
    if (!words.empty()) return "separate: " + words;
  }
  const bool open = !reps_[0]->closed() || !reps_[1]->closed();
  return (r.relation == Relation::undefined && open ? open_text() : relation_words(r.relation)) + ": " +
         render::counted(r.pair_count, "pair of faces meets", "pairs of faces meet");
}

render::Overlay FrameState::overlay(const std::string& title) const {
  render::Overlay o;
  o.title = title;
  if (reps_.size() > 1) o.title += "  ·  step " + std::to_string(step());
  o.event = event_text();
  o.event_colour = parting_here() != nullptr ? kPartingColour
                   : way_out_here()          ? kWayOutColour
                                    : style_of(spec_).of(render::palette::event(cursor_.event().kind));
  o.style = style_name(spec_);
  if (trace_.header.construction) {
    add_construction(o);
    return o;
  }
  const trace::Totals t = totals();
  if (reps_.size() == 1) {
    o.counters = {{"wrapper", render::group_digits(cursor_.boundary_size(Side::a)) + " faces"},
                  {"refined", render::group_digits(t.refinements[0] - t.coarsenings[0]) + " of " +
                                  render::group_digits(reps_[0]->region_count()) + " regions"}};
  } else {
    const Separation* proof = proof_here();
    const std::uint64_t refined[2] = {proof != nullptr ? proof->refined[0].size() : t.refinements[0],
                                      proof != nullptr ? proof->refined[1].size() : t.refinements[1]};
    const auto name_of_wrapper = [&](Side side) {
      const bool has = reps_[static_cast<std::size_t>(side)]->region_count() > 0;
      return std::string(has ? "wrapper " : "no wrapper, ") + (side == Side::a ? "A" : "B");
    };
    o.counters = {{name_of_wrapper(Side::a), render::group_digits(boundary_size(Side::a))},
                  {name_of_wrapper(Side::b), render::group_digits(boundary_size(Side::b))},
                  {"refined", render::group_digits(refined[0]) + " + " + render::group_digits(refined[1])},
                  {"face tests", render::group_digits(t.face_tests)},
                  {"contacts", render::group_digits(t.contacts)}};
    if (!trace_.header.engine.empty()) {  // it has no wrappers
      o.counters.erase(o.counters.begin(), o.counters.begin() + 3);
      o.counters.insert(o.counters.begin(), {"pairs of boxes", render::group_digits(t.node_pairs)});
    }
    if (const std::size_t wrong = wrong_here().size(); wrong > 0)
      o.counters.push_back({"wrong pairs", render::group_digits(wrong)});
    if (const trace::StepResult* answer = answer_here(); answer && trace_.header.request.is_coarse())
      o.counters.push_back({"error bound", error_bound_text(answer->error_bound)});
  }
  return o;
}

void FrameState::add_construction(render::Overlay& o) const {
  std::uint64_t made = 0;
  for (const trace::PassSummary& p : passes_)
    if (p.last <= cursor_.position()) made += p.regions;
  if (const trace::PassSummary* pass = pass_here(); pass != nullptr) {
    if (pass->last > cursor_.position()) made += built_here().size();
    o.title += "  ·  " + stage_words(*pass);
  }
  o.counters = {
      {"hull", render::counted(cursor_.boundary_size(Side::a), "face", "faces")},
      {"regions", render::group_digits(made) + " of " + render::group_digits(reps_[0]->region_count())}};
}

std::string FrameState::construction_caption() const {
  std::string text = event_text();
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  const trace::PassSummary* pass = pass_here();
  if (!at_pass_end())
    return text + ". Hull: " + render::counted(cursor_.boundary_size(Side::a), "face", "faces") + ".";
  text += ". " + std::string(name_of(pass->stage));
  if (pass->most_off > 0)
    text += " by caps at most " + render::short_number(pass->most_off) +
            " off the body (the farthest: " + render::short_number(pass->off) + ")";
  if (pass->covered > 0)
    text += "; " + render::counted(pass->accepted(), "cap", "caps") + " of " +
            render::counted(pass->lids, "face", "faces") + " over " + render::group_digits(pass->covered);
  return text + ".";
}

std::string FrameState::short_caption() const {
  if (trace_.header.construction) {
    const std::uint32_t faces = cursor_.boundary_size(Side::a);
    const bool built = faces == reps_[0]->outermost_faces().size();
    const trace::PassSummary* pass = pass_here();
    if (pass == nullptr) return "the body, " + render::counted(faces, "face", "faces");
    return "pass " + std::to_string(pass->number()) + (built ? ", the outermost wrapper" : "") + ", " +
           render::counted(faces, "face", "faces");
  }
  if (reps_.size() == 1) {
    const trace::Totals t = totals();
    const std::uint64_t refined = t.refinements[0] - t.coarsenings[0], all = reps_[0]->region_count();
    const std::string state = all == 0         ? "the body itself, which has no wrappers"
                              : refined == 0   ? "outermost wrapper"
                              : refined == all ? "the body itself"
                                               : render::group_digits(refined) + " of " +
                                                     render::counted(all, "region", "regions") + " refined";
    return state + ", " + render::counted(cursor_.boundary_size(Side::a), "face", "faces");
  }
  return "step " + std::to_string(step()) + ": " + event_text();
}

std::string FrameState::caption() const {
  if (trace_.header.construction) return construction_caption();
  const trace::Totals t = totals();
  std::string out = reps_.size() > 1 ? "Step " + std::to_string(step()) + ", event " : "Event ";
  out += std::to_string(cursor_.position()) + ": " + event_text() + ". ";
  out += reps_.size() == 1
             ? "Wrapper: " + render::group_digits(cursor_.boundary_size(Side::a)) + " faces."
             : "Wrappers: " + render::group_digits(boundary_size(Side::a)) + " + " +
                   render::group_digits(boundary_size(Side::b)) + " faces; " +
                   render::counted(t.face_tests, "face test", "face tests") + ", " +
                   render::counted(t.refinements[0] + t.refinements[1], "refinement", "refinements") + ".";
  if (const trace::StepResult* answer = answer_here(); answer && trace_.header.request.is_coarse())
    out += " Error bound: " + error_bound_text(answer->error_bound) +
           (answer->finished ? "." : "; a limit was reached.");
  return out;
}

}  // namespace lrb::run

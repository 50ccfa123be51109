#include "scenarios/frames/frame_state.hpp"

#include <algorithm>
#include <filesystem>

#include "scenarios/frames/face_colours.hpp"
#include "scenarios/record/moments.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/style.hpp>
namespace lrb::frames {
namespace {

/// Returns a mesh's name without folder and extension.
std::string short_name(const LrbRep& rep) {
  return std::filesystem::path(rep.name()).stem().string();
}

}  // namespace

FrameState::FrameState(RecordedRun run, const pictures::FrameSpec& spec, bool point_out_refined)
    : run_(std::move(run)),
      trace_(*run_.trace),
      spec_(spec),
      point_out_refined_(point_out_refined),
      cursor_(trace_, run_.reps),
      passes_(trace::passes_of(trace_)) {}

void FrameState::seek(trace::EventId event) {
  cursor_.seek(event);
  now_ = moment();
}

FrameState::Moment FrameState::moment() const {
  Moment m;
  const std::size_t step = cursor_.step_number();
  m.is_step_end = cursor_.position() == record::last_event(trace_, step);
  if (m.is_step_end) {
    if (const auto& results = results_of(run_); step < results.size()) m.result = &results[step];
    if (run_.wrong != nullptr && step < run_.wrong->size()) m.wrong = (*run_.wrong)[step].pairs;
    if (cursor_.step()->finished) add_answer(m);
  }
  add_pass(m);
  return m;
}

void FrameState::add_answer(Moment& m) const {
  m.answer = &cursor_.step()->result;
  if (m.answer->separation) m.proof = &*m.answer->separation;
  if (m.answer->distance) m.gap = gap_of(*m.answer->distance);
  if (m.answer->clash) {
    std::span<const ContactRegion> contacts;
    if (m.result != nullptr) contacts = m.result->regions;
    m.separation_vector = separation_vector_of(*m.answer->clash, bodies(), contacts);
  }
  if (shows_separating_plane(m))
    m.separating = explain_walk(rep(Side::a), pose(Side::a), rep(Side::b), pose(Side::b));
}

bool FrameState::shows_separating_plane(const Moment& m) const {
  const CollideRequest& request = trace_.header.request;
  return !is_single() && m.proof == nullptr && !m.answer->distance && !m.answer->near && !m.answer->points &&
         m.answer->relation == Relation::separate && request.recursion == Recursion::complete &&
         !request.is_coarse() && trace_.header.engine.empty() &&
         spec_.colour_by < pictures::FrameSpec::ColourBy::face_tests;
}

void FrameState::add_pass(Moment& m) const {
  // The last pass that has begun.
  const auto after = std::find_if(passes_.begin(), passes_.end(),
                                  [&](const trace::PassSummary& p) { return p.first > cursor_.position(); });
  if (after == passes_.begin()) return;
  m.pass = &*(after - 1);
  m.is_pass_end = m.pass->last == cursor_.position() && m.pass->regions > 0;
  if (cursor_.event().kind == EventKind::closed) return;
  for (trace::EventId e = m.pass->first; e <= cursor_.position(); ++e)
    if (trace_.events[e].kind == EventKind::region) m.built.push_back(trace_.events[e].region());
}

std::vector<std::uint8_t> FrameState::met(Side side) const {
  if (!trace_.header.request.is_coarse()) return {};
  const LrbRep& rep = this->rep(side);
  std::vector<std::uint8_t> out(rep.face_count());
  for (trace::EventId e = cursor_.step()->first_event; e <= cursor_.position(); ++e) {
    const trace::Event& event = trace_.events[e];
    if (event.kind == EventKind::contact) out[rep.face_of_simplex(event.simplex(side))] = 1;
  }
  return out;
}

const trace::TreeShape* FrameState::tree_of(Side side) const {
  if (run_.trees == nullptr || run_.trees->empty()) return nullptr;
  return &(*run_.trees)[static_cast<std::size_t>(side)];
}

std::span<const trace::Event> FrameState::events_so_far() const {
  const trace::EventId first = cursor_.step()->first_event;
  return {trace_.events.data() + first, cursor_.position() + std::size_t{1} - first};
}

std::vector<double> FrameState::values_of(Side side) const {
  const auto i = static_cast<std::size_t>(side);
  if (run_.face_values != nullptr) return (*run_.face_values)[i];
  return grouped(face_values(spec_.colour_by, *run_.reps[i], side, events_so_far(), tree_of(side)),
                 spec_.colour_per, *run_.reps[i]);
}

FrameState::SceneParts FrameState::scene_parts(bool wrapper) const {
  SceneParts out;
  for (std::size_t i = 0; i < run_.reps.size(); ++i) {
    const Side side = static_cast<Side>(i);
    out.values[i] = values_of(side);
    if (!is_single()) out.in_contact[i] = met(side);
    if (now_.proof == nullptr) continue;
    out.proving.emplace_back(*run_.reps[i]);
    for (const RegionId r : now_.proof->refined[i]) out.proving.back().refine(r);
  }
  // Bodies refer to the parts: these must be complete.
  for (std::size_t i = 0; i < run_.reps.size(); ++i) {
    const Side side = static_cast<Side>(i);
    render::SceneBody body;
    body.rep = run_.reps[i];
    if (wrapper) body.wrapper = now_.proof != nullptr ? &out.proving[i] : &cursor_.wrapper(side);
    body.in_contact = out.in_contact[i];
    body.pose = cursor_.pose(side);
    body.face_values = out.values[i];
    body.name = (is_single() ? "" : i == 0 ? "A " : "B ") + short_name(*run_.reps[i]);
    out.bodies.push_back(std::move(body));
  }
  return out;
}

render::SceneHighlight FrameState::scene_highlight(bool wrapper, bool plain) const {
  render::SceneHighlight highlight;
  if (wrapper && !plain && point_out_refined_)
    for (const trace::RefinedRegion& r : cursor_.refined())
      if (is_shown(r)) highlight.refining[static_cast<std::size_t>(r.side)].push_back(r.region);
  if (const auto pair = cursor_.pair_under_test(); wrapper && !plain && pair && !now_.is_step_end)
    highlight.under_test = {pair->simplex_a, pair->simplex_b};
  if (now_.result != nullptr) highlight.contacts = now_.result->regions;
  if (wrapper && trace_.header.construction) highlight.built = now_.built;
  return highlight;
}

render::SceneOptions FrameState::scene_options(const SceneParts& parts) const {
  render::SceneOptions options;
  switch (spec_.colour_by) {
    case pictures::FrameSpec::ColourBy::kind:
      break;
    case pictures::FrameSpec::ColourBy::layer:
      options.colour_by = render::ColourBy::layer;
      break;
    case pictures::FrameSpec::ColourBy::region:
      options.colour_by = render::ColourBy::region;
      break;
    default:
      options.colour_by = render::ColourBy::value;
      options.value_name = io::in_words(name_of(spec_.colour_by));
      if (spec_.colour_per != pictures::FrameSpec::ColourPer::face)
        options.value_name += " in the " + std::string(name_of(spec_.colour_per));
      else if (spec_.colour_by == pictures::FrameSpec::ColourBy::box_tests)
        options.value_range = scale_without_the_smallest(parts.values);
      if (!run_.value_name.empty()) options.value_name = run_.value_name;
      if (run_.value_range) options.value_range = run_.value_range;
      break;
  }
  options.explode = spec_.explode;
  options.contact_rims = true;
  options.style = spec_.style;
  options.scale = static_cast<float>(spec_.scale()) * style_of(spec_.style).weight;
  options.isolate = spec_.isolate;
  options.ghost_rest = spec_.ghost_rest;
  return options;
}

namespace {

/// Multiplies the sizes of lines, points and labels.
void enlarge(render::DrawList& list, float factor) {
  for (render::EdgeStyle& e : list.edge_styles) e.width *= factor;
  for (render::DrawLine& l : list.lines)
    for (float* size : {&l.width, &l.dash, &l.halo_width}) *size *= factor;
  for (render::DrawPoint& p : list.points)
    for (float* size : {&p.radius, &p.halo_width}) *size *= factor;
  for (render::DrawLabel& l : list.labels)
    for (float* size : {&l.height, &l.dx, &l.dy}) *size *= factor;
}

}  // namespace

void FrameState::add_marks(render::Scene& scene, bool plain) const {
  const render::Style& style = style_of(spec_.style);
  if (now_.separating && !plain)
    pictures::add_separating_plane(scene.list, *now_.separating, bodies(), style);
  if (now_.gap) pictures::add_gap(scene, *now_.gap, style);
  if (now_.answer != nullptr && now_.answer->near)
    pictures::add_near_pairs(scene, near_marks(*now_.answer->near), style);
  if (now_.answer != nullptr && now_.answer->manifold)
    pictures::add_contact_points(scene, contact_marks(*now_.answer->manifold), now_.answer->manifold->margin,
                                 pictures::size_of(bodies()), style);
  if (now_.answer != nullptr && now_.answer->points)
    pictures::add_point_distances(scene, point_marks(*now_.answer->points), style);
  if (now_.separation_vector)
    pictures::add_separation_vector(scene, *now_.separation_vector, run_.reps[0]->dim(), style);
  if (!plain && !now_.wrong.empty()) {
    pictures::add_wrong_pairs(scene.list, now_.wrong, bodies(), style.paper);
    scene.key.push_back({render::LegendItem::Mark::line, render::palette::kWrong, "wrong pair"});
  }
  for (const Side side : {Side::a, Side::b})
    if (const trace::TreeShape* tree = tree_of(side); spec_.node_boxes && tree != nullptr)
      add_node_boxes(scene, *tree, side, pose(side), *spec_.node_boxes, events_so_far(), style);
}

render::Scene FrameState::scene(bool wrapper, bool plain) const {
  const SceneParts parts = scene_parts(wrapper);
  render::SceneOptions options = scene_options(parts);
  options.borders = plain;
  render::Scene scene = render::build_scene(parts.bodies, scene_highlight(wrapper, plain), options);
  render::Scene marks;  // in pixels of the screen
  add_marks(marks, plain);
  enlarge(marks.list, options.scale);
  scene.list.append(marks.list);
  scene.key.insert(scene.key.end(), marks.key.begin(), marks.key.end());
  return scene;
}

bool FrameState::is_shown(const trace::RefinedRegion& r) const {
  if (spec_.isolate[0].empty() && spec_.isolate[1].empty()) return true;
  const std::vector<RegionId>& of_side = spec_.isolate[static_cast<std::size_t>(r.side)];
  return std::find(of_side.begin(), of_side.end(), r.region) != of_side.end();
}

}  // namespace lrb::frames

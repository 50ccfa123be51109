#include <algorithm>
#include <stdexcept>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/replay.hpp>
namespace lrb::trace {

namespace {

std::string describe(const BodyInfo& info) {
  return "\"" + printable_name(info.name) + "\" (" + std::to_string(info.total_faces) + " faces, " +
         std::to_string(info.regions) + " regions, hash " + to_hex(info.hash) + ")";
}

}  // namespace

void require_same_body(const BodyInfo& recorded, const LrbRep& rep, const std::string& who) {
  BodyInfo given = describe_body(rep, recorded.source);
  given.name = recorded.name;  // the name may differ: the hash identifies the body
  if (given == recorded) return;
  given.name = rep.name();
  throw InputError("trace: body " + who + ": expected " + describe(recorded) + " as recorded, found " +
                   describe(given) + "; give the recorded LRB-rep, or record again");
}

Cursor::Cursor(const Trace& trace, const LrbRep& a, const LrbRep& b)
    : Cursor(trace, std::vector<const LrbRep*>{&a, &b}) {}

Cursor::Cursor(const Trace& trace, const LrbRep& a) : Cursor(trace, std::vector<const LrbRep*>{&a}) {}

Cursor::Cursor(const Trace& trace, std::vector<const LrbRep*> reps)
    : trace_(&trace), replay_(reps, trace.header.request.wrapper, trace.header.construction) {
  check_trace(trace, "trace");
  if (reps.size() != trace.header.bodies.size())
    throw InputError("trace: expected the " + std::to_string(trace.header.bodies.size()) +
                     " bodies of the recording, found " + std::to_string(reps.size()));
  for (std::size_t i = 0; i < reps.size(); ++i)
    require_same_body(trace.header.bodies[i], *reps[i], std::string(name_of(static_cast<Side>(i))));
  // Index the events that change a wrapper: seeking replays only these.
  for (EventId e = 0; e < trace.events.size(); ++e) {
    const Event& event = trace.events[e];
    if (event.kind == EventKind::step || event.changes_wrapper()) changes_.push_back(e);
  }
}

void Cursor::apply_to(EventId event) {
  const Event& e = trace_->events[event];
  if (!replay_.apply(e, trace_->events)) return;
  const std::uint32_t size = replay_.boundary_size(e.side);
  const std::uint32_t recorded = e.wrapper_change().wrapper_faces;
  if (recorded == kNull || recorded == size) return;
  rewind();
  throw InputError("trace: event " + std::to_string(event) + " (" + std::string(name_of(e.kind)) +
                   " region " + std::to_string(e.region()) + " of " + std::string(name_of(e.side)) +
                   "): found a wrapper of " + std::to_string(size) + " faces, expected " +
                   std::to_string(recorded) + "; the trace is damaged; record it again");
}

void Cursor::rewind() {
  replay_.reset();
  applied_ = step_ = 0;
  position_ = kNull;
}

void Cursor::seek(EventId event) {
  if (event != kNull && event >= trace_->events.size())
    throw std::out_of_range("Cursor::seek: event " + std::to_string(event) + " of " +
                            std::to_string(trace_->events.size()));
  if (event == kNull) return rewind();
  // The number of changes up to the target determines the state of the wrappers.
  const std::size_t step = trace_->step_of(event);
  const auto count_up_to = [&](EventId e) {
    return static_cast<std::size_t>(std::upper_bound(changes_.begin(), changes_.end(), e) - changes_.begin());
  };
  const std::size_t target = count_up_to(event);
  if (target != applied_) {
    // Each step starts from the outermost wrappers, so that nothing before the target's step matters. Going
    // backward means replaying from the beginning of that step.
    const std::size_t begin = count_up_to(trace_->steps[step].first_event) - 1;
    for (std::size_t i = target > applied_ ? std::max(applied_, begin) : begin; i < target; ++i)
      apply_to(changes_[i]);
    applied_ = target;
  }
  position_ = event;
  step_ = step;
}

bool Cursor::next() {
  const std::size_t to = at_start() ? 0 : position_ + std::size_t{1};
  if (to >= trace_->events.size()) return false;
  seek(static_cast<EventId>(to));
  return true;
}

bool Cursor::previous() {
  if (at_start()) return false;
  seek(position_ == 0 ? kNull : position_ - 1);
  return true;
}

bool Cursor::next(EventKind kind) {
  for (std::size_t e = at_start() ? 0 : position_ + std::size_t{1}; e < trace_->events.size(); ++e) {
    if (trace_->events[e].kind != kind) continue;
    seek(static_cast<EventId>(e));
    return true;
  }
  return false;
}

Pose Cursor::pose(Side side) const {
  if (at_start()) return {};
  return side == Side::a ? step()->pose_a : step()->pose_b;
}

std::optional<TestedPair> Cursor::pair_under_test() const {
  if (at_start() || body_count() < 2) return std::nullopt;
  EventId id = position_;
  const auto is_pair = [&](EventId e) {
    const EventKind kind = trace_->events[e].kind;
    return kind == EventKind::face_test || kind == EventKind::contact;
  };
  // A refinement has no pair of its own; its cause is the test that hit.
  if (!is_pair(id)) id = event().cause;
  if (id == kNull || !is_pair(id)) return std::nullopt;
  const Event& e = trace_->events[id];
  return TestedPair{.simplex_a = e.simplex(Side::a),
                    .simplex_b = e.simplex(Side::b),
                    .face_a = wrapper(Side::a).rep().face_of_simplex(e.simplex(Side::a)),
                    .face_b = wrapper(Side::b).rep().face_of_simplex(e.simplex(Side::b)),
                    .meet = e.meet,
                    .event = id};
}

std::vector<RefinedRegion> Cursor::refined() const {
  std::vector<RefinedRegion> out;
  if (at_start()) return out;
  const EventId cause = event().cause;
  // Scan back over consecutive refinements of the same cause.
  for (EventId id = position_;; --id) {
    const Event& e = trace_->events[id];
    if (e.kind != EventKind::refine || e.cause != cause) break;
    out.push_back({e.side, e.region(), id});
    if (id == 0 || cause == kNull) break;
  }
  std::reverse(out.begin(), out.end());
  return out;
}

namespace {

/// Returns the number of the region's faces on the boundary. Refining or coarsening a region affects only
/// these.
std::uint32_t visible_faces(const Wrapper& wrapper, RegionId region) {
  const std::span<const FaceId> faces = wrapper.rep().collector(region);
  return static_cast<std::uint32_t>(
      std::count_if(faces.begin(), faces.end(), [&](FaceId f) { return wrapper.on_boundary(f); }));
}

/// Returns the face that a refinement in unregularised mode removes; kNull: all faces of the region.
FaceId refined_face(const Event& event, std::span<const Event> events, const LrbRep& rep) {
  if (event.cause == kNull || events[event.cause].kind != EventKind::face_test) return kNull;
  const Event& test = events[event.cause];
  // The tested face alone is removed if it is a lid of the region; otherwise the whole region is refined.
  const FaceId face = rep.face_of_simplex(test.simplex(event.side));
  return rep.inner_cell(face) == event.region() ? face : kNull;
}

void change(Wrapper& wrapper, const Event& event, std::span<const Event> events) {
  if (event.kind != EventKind::refine) {
    wrapper.coarsen(event.region());
    return;
  }
  const FaceId face =
      wrapper.mode() == WrapperMode::unregularised ? refined_face(event, events, wrapper.rep()) : kNull;
  if (face == kNull)
    wrapper.refine(event.region());
  else
    wrapper.refine_face(face);
}

}  // namespace

Replay::Replay(std::span<const LrbRep* const> reps, WrapperMode mode, bool bare) : bare_(bare) {
  for (const LrbRep* rep : reps)
    if (rep) wrappers_.emplace_back(*rep, mode);
  reset();
}

void Replay::reset() {
  for (std::size_t i = 0; i < wrappers_.size(); ++i) {
    wrappers_[i].reset();
    if (bare_) wrappers_[i].refine_all();
    const LrbRep& rep = wrappers_[i].rep();
    sizes_[i] = bare_ ? rep.real_face_count() : static_cast<std::uint32_t>(rep.outermost_faces().size());
  }
}

bool Replay::apply(const Event& event, std::span<const Event> events) {
  if (event.kind == EventKind::step) reset();
  if (!event.changes_wrapper()) return false;
  const auto side = static_cast<std::size_t>(event.side);
  // Only faces of the region itself can enter or leave the boundary: update its size by their difference.
  const std::uint32_t before = visible_faces(wrappers_[side], event.region());
  change(wrappers_[side], event, events);
  sizes_[side] += visible_faces(wrappers_[side], event.region()) - before;
  return true;
}

}  // namespace lrb::trace

#include <algorithm>
#include <bit>
#include <initializer_list>
#include <numeric>
#include <tuple>
#include <utility>

#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

namespace {

std::array<double, 3> array_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::optional<std::array<double, 2>> ends_of(const std::optional<ProvedInterval>& interval) {
  if (!interval) return std::nullopt;
  return std::array<double, 2>{interval->lower, interval->upper};
}

std::string interval_text(double lower, double upper, std::size_t looks) {
  return "[" + io::exact_text(lower) + ", " + io::exact_text(upper) + "] in " + std::to_string(looks) +
         " steps";
}

}  // namespace

MeasuredDistance measured(const DistanceResult& result, std::vector<Bounds> history) {
  return {result.lower,
          result.upper,
          result.solids_meet(),
          {array_of(result.witness[0].point), array_of(result.witness[1].point)},
          std::move(history)};
}

MeasuredClash measured(const ClashResult& result, std::vector<Bounds> history) {
  return {result.kind,
          result.reason,
          result.shares_faces,
          {result.distance.lower, result.distance.upper},
          ends_of(result.depth),
          ends_of(result.volume),
          array_of(result.translation),
          std::move(history),
          result.finished};
}

MeasuredNearPairs measured(const NearPairsResult& result, double within) {
  MeasuredNearPairs out{result, within, {}};
  std::vector<NearPair> nearest(std::min(MeasuredNearPairs::kMaxListed, result.pairs.size()));
  // Ties are resolved by the order of pairs, so that the list is reproducible.
  std::partial_sort_copy(result.pairs.begin(), result.pairs.end(), nearest.begin(), nearest.end(),
                         [](const NearPair& x, const NearPair& y) {
                           return std::tuple(x.lower, x.a, x.b) < std::tuple(y.lower, y.a, y.b);
                         });
  for (const NearPair& p : nearest)
    out.nearest.push_back({p.a, p.b, p.lower, p.upper, {array_of(p.point[0]), array_of(p.point[1])}});
  return out;
}

MeasuredManifolds measured(const ManifoldResult& result, double margin) {
  MeasuredManifolds out{margin, result.manifolds.size(), 0, {}};
  for (std::uint32_t i = 0; i < result.manifolds.size(); ++i) {
    const ContactManifold& m = result.manifolds[i];
    out.found += m.points.size();
    for (const ManifoldPoint& p : m.points)
      if (out.contacts.size() < MeasuredManifolds::kMaxListed)
        out.contacts.push_back(
            {p.id, i, p.depth, array_of(m.normal), {array_of(p.point[0]), array_of(p.point[1])}});
  }
  return out;
}

MeasuredPoints measured(std::span<const PointDistance> distances, std::span<const Eigen::Vector3d> points,
                        bool has_sides) {
  MeasuredPoints out;
  out.count = points.size();
  out.has_sides = has_sides;
  std::vector<std::uint32_t> order(distances.size());
  std::iota(order.begin(), order.end(), 0U);
  for (const PointDistance& d : distances) {
    out.inside += d.side == Where::inside;
    out.on_surface += d.side == Where::on_surface;
  }
  std::vector<std::uint32_t> smallest(std::min(MeasuredPoints::kMaxListed, order.size()));
  std::partial_sort_copy(
      order.begin(), order.end(), smallest.begin(), smallest.end(), [&](std::uint32_t x, std::uint32_t y) {
        return std::tuple(distances[x].signed_lower(), x) < std::tuple(distances[y].signed_lower(), y);
      });
  for (const std::uint32_t i : smallest) {
    const PointDistance& d = distances[i];
    out.smallest.push_back({i,
                            d.closest.face,
                            d.signed_lower(),
                            d.signed_upper(),
                            {array_of(points[i]), array_of(d.closest.point)}});
  }
  return out;
}

MeasuredApproach measured(const FirstContactResult& result, std::vector<ContactBounds> history) {
  return {result.outcome, result.t0, result.t1, std::nullopt, std::nullopt, std::move(history)};
}

std::string to_text(const MeasuredDistance& m) {
  return interval_text(m.lower, m.upper, m.history.size());
}

std::string to_text(const MeasuredClash& m) {
  std::string out(name_of(m.kind));
  if (m.reason != ClashReason::none) out += ": " + std::string(name_of(m.reason));
  if (m.depth) out += ", depth " + interval_text((*m.depth)[0], (*m.depth)[1], m.history.size());
  return out;
}

std::string to_text(const MeasuredNearPairs& m) {
  std::string out = std::to_string(m.found) + " pairs within " + io::exact_text(m.within);
  if (!m.nearest.empty())
    out +=
        ", nearest [" + io::exact_text(m.nearest[0].lower) + ", " + io::exact_text(m.nearest[0].upper) + "]";
  return out;
}

std::string to_text(const MeasuredManifolds& m) {
  std::string out = std::to_string(m.manifolds) + " manifolds, " + std::to_string(m.found) + " points";
  if (!m.contacts.empty()) out += ", the first at depth " + io::exact_text(m.contacts[0].depth);
  return out;
}

std::string to_text(const MeasuredPoints& m) {
  std::string out = std::to_string(m.inside) + " of " + std::to_string(m.count) + " points inside, " +
                    std::to_string(m.on_surface) + " on the surface";
  if (!m.smallest.empty())
    out += ", smallest distance [" + io::exact_text(m.smallest[0].lower) + ", " +
           io::exact_text(m.smallest[0].upper) + "]";
  return out;
}

std::string to_text(const MeasuredApproach& m) {
  std::string out = std::string(name_of(m.outcome)) + " " + interval_text(m.t0, m.t1, m.history.size());
  if (m.step) out += ", step " + io::exact_text((*m.step)[1]);
  return out;
}

const char* lrbscope_version() {
  return LRB_VERSION;
}

BodyInfo describe_body(const LrbRep& rep, std::string source) {
  BodyInfo info;
  info.name = rep.name();
  info.source = std::move(source);
  info.hash = rep.hash();
  info.dim = static_cast<std::uint32_t>(rep.dim());
  info.closed = rep.closed();
  info.real_faces = rep.real_face_count();
  info.total_faces = rep.face_count();
  info.outer_faces = static_cast<std::uint32_t>(rep.outermost_faces().size());
  info.regions = rep.region_count();
  info.layers = rep.layer_count();
  info.real_simplices = rep.real_simplex_count();
  info.simplices = rep.simplex_count();
  return info;
}

std::span<const Event> Trace::events_of(std::size_t step) const {
  // Both ends are clamped: a trace truncated by its cap has steps without stored events.
  const std::size_t begin = std::min<std::size_t>(steps[step].first_event, events.size());
  const std::size_t end = step + 1 < steps.size()
                              ? std::min<std::size_t>(steps[step + 1].first_event, events.size())
                              : events.size();
  return {events.data() + begin, end - begin};
}

std::size_t Trace::step_of(EventId event) const {
  // Binary search for the last step that begins at or before the event.
  const auto after = std::upper_bound(steps.begin(), steps.end(), event,
                                      [](EventId e, const Step& s) { return e < s.first_event; });
  return static_cast<std::size_t>(after - steps.begin()) - 1;
}

std::span<const VertexId> Trace::vertices_of(const Event& patch) const {
  if (patch.kind != EventKind::patch || patch.boundary == kNull) return {};
  return std::span(patch_vertices).subspan(patch.boundary, patch.patch().interior);
}

bool Trace::has_engine_reports() const {
  return std::any_of(steps.begin(), steps.end(), [](const Step& s) { return s.result.engine.has_value(); });
}

bool equal(const Pose& x, const Pose& y) {
  // Bitwise, so that -0 and 0 differ and NaN equals itself.
  const auto same = [](double p, double q) {
    return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
  };
  return std::equal(x.r.data(), x.r.data() + 9, y.r.data(), same) &&
         std::equal(x.t.data(), x.t.data() + 3, y.t.data(), same);
}

namespace {

bool equal(const Step& x, const Step& y) {
  return x.index == y.index && trace::equal(x.pose_a, y.pose_a) && trace::equal(x.pose_b, y.pose_b) &&
         x.first_event == y.first_event && x.events_seen == y.events_seen && x.finished == y.finished &&
         x.result == y.result;
}

/// Checks the parts of one trace; every failure is one line that names the event or step.
class Checker {
 public:
  Checker(const Trace& t, const std::string& where) : t_(t), where_(where) {}

  void run() {
    check_sizes();
    check_steps();
    for (EventId e = 0; e < t_.events.size(); ++e) check_event(e);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(where_ + ": " + what + "; the trace is damaged; record it again");
  }

  void require(bool ok, const char* what) const {
    if (!ok) fail(what);
  }

  void check_sizes() const {
    // Array sizes first: later checks index by them.
    require(t_.header.bodies.size() == 1 || t_.header.bodies.size() == 2, "expected one body or two");
    require(!t_.header.construction || t_.header.bodies.size() == 1, "a construction has one body");
    require(t_.events.size() <= kMaxId, "too many events");
    require(t_.events_seen >= t_.events.size(), "fewer events seen than stored");
    require(t_.wall_ns.size() == (t_.header.clock == Clock::wall ? t_.events.size() : 0),
            "expected one time per event for the wall clock, and none for the event clock");
    for (std::size_t i = 1; i < t_.wall_ns.size(); ++i)
      if (t_.wall_ns[i] <= t_.wall_ns[i - 1])
        fail("event " + std::to_string(i) + ": its time must be later than the previous event");
    require(t_.events.empty() || (!t_.steps.empty() && t_.steps.front().first_event == 0),
            "the first event does not begin the first step");
  }

  void check_steps() const {
    // Steps partition the events: their counts add up, and each stored step begins with its step event.
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < t_.steps.size(); ++i) check_step(i), seen += t_.steps[i].events_seen;
    if (seen != t_.events_seen) fail("the events of the steps do not add up to the total");
    const auto begun = std::count_if(t_.events.begin(), t_.events.end(),
                                     [](const Event& e) { return e.kind == EventKind::step; });
    const auto stored = std::count_if(t_.steps.begin(), t_.steps.end(),
                                      [&](const Step& s) { return s.first_event < t_.events.size(); });
    if (begun != stored) fail("the number of step events differs from the number of steps");
  }

  void check_step(std::size_t i) const {
    const Step& s = t_.steps[i];
    const std::string name = "step " + std::to_string(i);
    if (!s.pose_a.r.allFinite() || !s.pose_a.t.allFinite() || !s.pose_b.r.allFinite() ||
        !s.pose_b.t.allFinite())
      fail(name + ": its poses are not finite");
    if (s.first_event > t_.events.size()) fail(name + ": its first event does not exist");
    if (i > 0 && s.first_event < t_.steps[i - 1].first_event)
      fail(name + ": begins before the step before it");
    if (i > 0 && s.index <= t_.steps[i - 1].index) fail(name + ": its number does not ascend");
    if (s.first_event < t_.events.size()) {
      const Event& e = t_.events[s.first_event];
      if (e.kind != EventKind::step || e.a != s.index) fail(name + ": its first event is not its step event");
    }
    if (s.events_seen < t_.events_of(i).size()) fail(name + ": fewer events seen than stored");
    if (!(s.result.error_bound >= 0)) fail(name + ": its error bound is negative");
    if (s.result.separation) check_separation(*s.result.separation, name);
    if (s.result.engine) check_report(*s.result.engine, s, name);
  }

  void check_report(const EngineReport& report, const Step& step, const std::string& name) const {
    for (const std::vector<EngineReport::Mark>* marks : {&report.counts, &report.phases}) {
      std::uint32_t before = 0;
      for (const EngineReport::Mark& mark : *marks) {
        if (mark.name >= t_.header.names.size())
          fail(name + ": a counter or phase of the engine has no name");
        if (mark.at < before || mark.at > step.events_seen)
          fail(name + ": a counter or phase of the engine is out of order");
        before = mark.at;
      }
    }
  }

  void check_separation(const Separation& separation, const std::string& step) const {
    const std::vector<BodyInfo>& bodies = t_.header.bodies;
    if (bodies.size() < 2) fail(step + ": a separation needs two bodies");
    for (std::size_t side = 0; side < 2; ++side)
      for (const RegionId r : separation.refined[side])
        if (r >= bodies[side].regions) fail(step + ": its separation refers to a region that does not exist");
  }

  void check_event(EventId id) const {
    const Event& e = t_.events[id];
    const auto bad = [&](const char* what) {
      fail("event " + std::to_string(id) + " (" + std::string(name_of(e.kind)) + "): " + what);
    };
    // Check enumerators before use: a damaged file may contain any byte.
    if (static_cast<std::size_t>(e.kind) >= kEventKinds) bad("unknown kind");
    if (e.side != Side::a && e.side != Side::b) bad("unknown side");
    if (static_cast<std::size_t>(e.meet) >= kEnumNames<exact::Meet>.size()) bad("unknown meet");
    if (e.cause != kNull && e.cause >= id) bad("its cause is not an earlier event");
    const std::size_t bodies = t_.header.bodies.size();
    // References to simplices and regions must exist in the recorded bodies: replay and pictures index by
    // them.
    switch (e.kind) {
      case EventKind::face_test:
      case EventKind::contact:
      case EventKind::plane_test:
        if (bodies < 2) bad("needs two bodies");
        if (e.a >= t_.header.bodies[0].simplices) bad("A has no such simplex");
        if (e.b >= t_.header.bodies[1].simplices) bad("B has no such simplex");
        if (e.kind == EventKind::face_test && e.detail >= kEnumNames<TestedBy>.size()) bad("unknown tester");
        break;
      case EventKind::refine:
      case EventKind::coarsen:
        if (static_cast<std::size_t>(e.side) >= bodies) bad("no such body");
        if (e.a >= t_.header.bodies[static_cast<std::size_t>(e.side)].regions) bad("no such region");
        break;
      case EventKind::result:
        if (e.a >= kEnumNames<Relation>.size()) bad("unknown relation");
        break;
      case EventKind::node_pair:
        if (bodies < 2) bad("needs two bodies");
        if (static_cast<std::size_t>(e.node_end().step) >= kEnumNames<NodeStep>.size()) bad("unknown step");
        if (e.work().rejected + e.work().certain > e.work().met)
          bad("more pairs are rejected or decided than intersect");
        if (static_cast<std::size_t>(e.node_end().axis) >= kEnumNames<BoxAxis>.size()) bad("unknown axis");
        break;
      case EventKind::point:
        if (static_cast<std::size_t>(e.detail) >= kEnumNames<Where>.size()) bad("unknown place");
        break;
      case EventKind::begin:
      case EventKind::end:
        if (e.a >= kEnumNames<Phase>.size()) bad("unknown phase");
        break;
      case EventKind::pass:
      case EventKind::patch:
      case EventKind::cap:
      case EventKind::region:
      case EventKind::merged:
      case EventKind::pass_end:
      case EventKind::closed:
        check_built(id);
        break;
      case EventKind::step:
        break;
    }
  }

  /// Checks an event of a construction.
  void check_built(EventId id) const {
    const Event& e = t_.events[id];
    const auto bad = [&](const char* what) {
      fail("event " + std::to_string(id) + " (" + std::string(name_of(e.kind)) + "): " + what);
    };
    const auto has_cause = [&](std::initializer_list<EventKind> kinds) {
      return e.cause != kNull &&
             std::find(kinds.begin(), kinds.end(), t_.events[e.cause].kind) != kinds.end();
    };
    // Construction events occur in construction traces only, and have causes of fixed kinds.
    if (!t_.header.construction) bad("only the trace of a construction has such an event");
    if (e.side != Side::a) bad("no such body");
    const bool names_region = e.kind == EventKind::region || e.kind == EventKind::merged;
    if (names_region && e.a >= t_.header.bodies[0].regions) bad("no such region");
    if (names_region && !has_cause({EventKind::cap, EventKind::pass}))
      bad("its cause is neither a cap nor a pass");
    if (e.kind == EventKind::pass && e.detail >= kEnumNames<BuildStage>.size()) bad("unknown stage");
    if (e.kind == EventKind::pass && !(e.deviation() >= 0))
      bad("its deviation is not a number of at least 0");
    if (e.kind == EventKind::cap && e.detail >= kEnumNames<CapVerdict>.size()) bad("unknown verdict");
    if (e.kind == EventKind::cap && !has_cause({EventKind::patch})) bad("its cause is not a patch");
    if (e.kind == EventKind::patch && e.boundary != kNull &&
        std::size_t{e.boundary} + e.depth_a > t_.patch_vertices.size())
      bad("its vertices are missing");
    const bool in_pass = e.kind == EventKind::patch || e.kind == EventKind::pass_end;
    if (in_pass && !has_cause({EventKind::pass})) bad("its cause is not a pass");
  }

  const Trace& t_;
  const std::string& where_;
};

}  // namespace

bool operator==(const Trace& x, const Trace& y) {
  return x.header == y.header &&
         std::equal(x.steps.begin(), x.steps.end(), y.steps.begin(), y.steps.end(),
                    [](const Step& p, const Step& q) { return equal(p, q); }) &&
         x.events == y.events && x.wall_ns == y.wall_ns && x.events_seen == y.events_seen &&
         x.patch_vertices == y.patch_vertices;
}

void check_trace(const Trace& trace, const std::string& where) {
  Checker(trace, where).run();
}

}  // namespace lrb::trace

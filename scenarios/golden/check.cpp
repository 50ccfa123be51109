#include "scenarios/golden/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <span>
#include <unordered_map>

#include "render/gl.hpp"
#include "render/page_palette.hpp"
#include "scenarios/record/engine_run.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::golden {
namespace {

std::string rep_text(const trace::BodyInfo& body) {
  return render::group_digits(body.regions) + " regions in " + std::to_string(body.layers) + " layers, " +
         render::group_digits(body.outer_faces) + " outermost faces";
}

/// Reports whether a body's mesh has changed or only its LRB-rep.
std::string body_cause(const Golden& golden, const GoldenRun& run, std::size_t i,
                       const trace::BodyInfo& expected, const trace::BodyInfo& found) {
  const std::string who = "body " + std::string(name_of(static_cast<Side>(i))) + " (" + found.name + "): ";
  const std::string built = rep_text(expected) + " -> " + rep_text(found);
  if (i >= golden.facts.meshes.size())
    return who + "its mesh or its LRB-rep changed: " + built +
           " (this golden does not record which; approve it again to record it)";
  const Mesh mesh = run.recording.bodies[i].rep.real_mesh();
  if (mesh_hash(mesh) == golden.facts.meshes[i])
    return who + "the mesh is unchanged, but its LRB-rep was built differently: " + built;
  if (i < golden.meshes.size() && golden.meshes[i])
    return who + "its mesh changed: " + mesh_difference(*golden.meshes[i], mesh);
  const std::string faces = render::group_digits(found.real_faces);
  if (found.real_faces == expected.real_faces)
    return who + "its mesh changed: " + faces + " faces as before, with other corners";
  return who + "its mesh changed: " + render::group_digits(expected.real_faces) + " -> " + faces + " faces";
}

/// Names the fields of the request that differ from the approved one.
std::string request_cause(const CollideRequest& x, const CollideRequest& y) {
  std::string names;
  for_each_field<CollideRequest>([&](const auto& field) {
    if (x.*field.member != y.*field.member) names.append(names.empty() ? "" : ", ").append(field.name);
  });
  return names.empty() ? names : "the query request changed: " + names;
}

/// Names the first pose that differs from the approved one.
std::string pose_cause(const trace::Trace& x, const trace::Trace& y) {
  for (std::size_t i = 0; i < std::min(x.steps.size(), y.steps.size()); ++i)
    for (const auto& [name, pose] : {std::pair{"A", &trace::Step::pose_a}, {"B", &trace::Step::pose_b}}) {
      const Pose &p = x.steps[i].*pose, &q = y.steps[i].*pose;
      if (trace::equal(p, q)) continue;
      // The linear part: a rotation by this angle, or another change.
      std::string how;
      if (p.r != q.r) {
        const Eigen::Matrix3d turn = q.r * p.r.inverse();
        const bool rotation = (turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9;
        const double half_chord = (turn - Eigen::Matrix3d::Identity()).norm() / std::sqrt(8.0);
        how = !rotation ? "its matrix changed"
                        : "it is rotated by " +
                              render::short_number(2 * std::asin(std::min(half_chord, 1.0)) * 180 /
                                                   std::numbers::pi) +
                              " degrees";
      }
      if (p.t != q.t)
        how += (how.empty() ? "" : ", ") + std::string("its origin is displaced by ") +
               render::short_number((q.t - p.t).norm());
      return "step " + std::to_string(y.steps[i].index) + ": body " + name + " moved: " + how;
    }
  return {};
}

/// Returns one line for each changed input of the run: the scenario's keys, a body's mesh, how its LRB-rep
/// was built, the request, a pose, the version of lrbscope.
std::vector<std::string> find_causes(const Golden& golden, const GoldenRun& run) {
  const trace::TraceHeader &x = golden.trace.header, &y = run.recording.trace.header;
  std::vector<std::string> out;
  bool is_mesh_changed = false;
  if (!golden.facts.scenario.empty() && !run.text.empty()) {
    const std::string keys = scenario_difference(golden.facts.scenario, compact_json(run.text));
    if (!keys.empty()) out.push_back("the scenario changed: " + keys);
  } else if (x.scenario_hash != run.scenario.hash && !golden.spec.is_capture()) {
    out.emplace_back("the scenario file changed since it was approved");
  }
  for (std::size_t i = 0; i < std::min(x.bodies.size(), y.bodies.size()); ++i)
    if (x.bodies[i].hash != y.bodies[i].hash) {
      out.push_back(body_cause(golden, run, i, x.bodies[i], y.bodies[i]));
      is_mesh_changed = true;
    }
  if (const std::string words = request_cause(x.request, y.request); !words.empty()) out.push_back(words);
  // The poses of an approach follow from the meshes.
  const bool follows = is_mesh_changed && !golden.spec.is_capture() &&
                       run.scenario.motion.kind == spec::Motion::Kind::approach;
  if (const std::string words = pose_cause(golden.trace, run.recording.trace); !words.empty() && !follows)
    out.push_back(words);
  if (out.empty() && golden.spec.is_capture() && x.scenario_hash != run.scenario.hash)
    out.emplace_back("the bodies or the poses of the capture changed since it was approved");
  if (x.lrbscope != y.lrbscope)
    out.push_back("approved with lrbscope " + x.lrbscope + ", run with " + y.lrbscope);
  return out;
}

using Events = std::span<const trace::Event>;

/// Returns true if two events are the same action. Causes are not compared: they are event numbers, which
/// shift.
bool same_action(const trace::Event& x, const trace::Event& y) {
  return x.kind == y.kind && x.side == y.side && x.a == y.a && x.b == y.b && x.meet == y.meet;
}

/// Returns the index of the next event after `from` with the same action, or events.size() if there is no
/// such event.
std::size_t find_after(Events events, std::size_t from, const trace::Event& action) {
  for (std::size_t i = from + 1; i < events.size(); ++i)
    if (same_action(events[i], action)) return i;
  return events.size();
}

/// Returns "; the step has 53 contacts instead of 54", or "".
std::string contacts_text(Events expected, Events actual) {
  const std::uint64_t x = trace::count_events(expected).contacts, y = trace::count_events(actual).contacts;
  return x == y ? ""
                : "; the step has " + std::to_string(y) + (y == 1 ? " contact" : " contacts") +
                      " instead of " + std::to_string(x);
}

std::string several(const char* what, std::size_t count, trace::EventId first, const trace::Event& event) {
  if (count == 1) return "event " + std::to_string(first) + " " + what + ": " + trace::describe(event);
  return std::to_string(count) + " events " + what + ", event " + std::to_string(first) +
         " first: " + trace::describe(event);
}

/// Describes a divergence by the events that follow it in its step: swapped, lost, added or replaced. Returns
/// one line; empty if the divergence is not at an event.
std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence) {
  if (!divergence.event || !divergence.step) return {};
  const Events x = expected.events_of(*divergence.step), y = actual.events_of(*divergence.step);
  const trace::EventId event = *divergence.event;
  const std::size_t i = event - expected.steps[*divergence.step].first_event;
  const bool in_x = i < x.size(), in_y = i < y.size();
  if (!in_x && !in_y) return {};
  const std::string contacts = contacts_text(x, y);
  if (!in_y) return several("lost", x.size() - i, event, x[i]) + contacts;
  if (!in_x) return several("added", y.size() - i, event, y[i]) + contacts;
  if (x[i].kind == y[i].kind && x[i].side == y[i].side && x[i].a == y[i].a && x[i].b == y[i].b)
    return {};  // the same action with another outcome: the message names the field
  const std::size_t found_in_x = find_after(x, i, y[i]), found_in_y = find_after(y, i, x[i]);
  const bool y_comes = found_in_x < x.size(), x_comes = found_in_y < y.size();
  if (y_comes && x_comes) {
    if (found_in_x != found_in_y) return "the events are in a different order" + contacts;
    return "events " + std::to_string(event) + " and " + std::to_string(event + found_in_x - i) +
           " are swapped: " + trace::describe(x[i]) + "; " + trace::describe(y[i]) + contacts;
  }
  if (y_comes) return several("lost", found_in_x - i, event, x[i]) + contacts;
  if (x_comes) return several("added", found_in_y - i, event, y[i]) + contacts;
  return "expected " + trace::describe(x[i]) + "; found " + trace::describe(y[i]) + contacts;
}

std::string size_text(const render::Image& image) {
  return std::to_string(image.width()) + "x" + std::to_string(image.height());
}

std::uint32_t packed(render::Rgba c) {
  return static_cast<std::uint32_t>(c.r) << 16 | static_cast<std::uint32_t>(c.g) << 8 | c.b;
}

/// Returns true if a channel of two colours differs by more than processors and drivers explain.
bool differ_strongly(render::Rgba x, render::Rgba y) {
  return std::max({std::abs(x.r - y.r), std::abs(x.g - y.g), std::abs(x.b - y.b)}) >
         render::ImageTolerance{}.large;
}

/// The colour change shared by most of the strongly different pixels.
std::string commonest_change(const render::Image& expected, const render::Image& actual) {
  std::unordered_map<std::uint64_t, std::uint64_t> counts;
  for (std::size_t i = 0; i < expected.pixels().size(); ++i) {
    const render::Rgba e = expected.pixels()[i], a = actual.pixels()[i];
    if (differ_strongly(e, a)) ++counts[static_cast<std::uint64_t>(packed(e)) << 32 | packed(a)];
  }
  std::uint64_t change = 0, most = 0;
  for (const auto& [key, count] : counts)
    if (count > most || (count == most && key < change)) change = key, most = count;
  if (most == 0) return {};
  const auto colour = [](std::uint64_t c) {
    return render::css({std::uint8_t(c >> 16), std::uint8_t(c >> 8), std::uint8_t(c), 255});
  };
  return "most often " + colour(change >> 32) + " -> " + colour(change) + " (" + std::to_string(most) +
         (most == 1 ? " pixel)" : " pixels)");
}

std::string text_of(const render::DecodedPng& png, const std::string& key) {
  for (const auto& [name, value] : png.text)
    if (name == key) return value;
  return {};
}

std::vector<std::string> parts_of(const std::string& words) {
  const std::string between = "; ";
  std::vector<std::string> out;
  for (std::size_t at = 0;;) {
    const std::size_t end = words.find(between, at);
    out.push_back(words.substr(at, end - at));
    if (end == std::string::npos) return out;
    at = end + between.size();
  }
}

/// Returns the first part in which the descriptions of two cameras differ, and the number of further
/// differing parts.
std::string moved_text(const std::string& expected, const std::string& actual) {
  const std::vector<std::string> x = parts_of(expected), y = parts_of(actual);
  if (x.size() != y.size()) return "the camera changed: the number of views differs";
  std::size_t first = x.size(), more = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] == y[i]) continue;
    if (first < x.size()) ++more;
    first = std::min(first, i);
  }
  return "the camera moved: expected " + x[first] + ", found " + y[first] +
         (more > 0 ? ", and in " + std::to_string(more) + (more == 1 ? " more value" : " more values") : "");
}

/// Describes a picture's difference: another event, another camera, or other colours or shapes.
std::string explain(const render::DecodedPng& expected, const frames::PaintedFrame& actual) {
  std::string out;
  const std::string event = text_of(expected, "lrbscope:event"), found = std::to_string(actual.event);
  if (!event.empty() && event != found) out += "drawn after event " + found + " instead of " + event + "; ";
  const std::string camera = text_of(expected, kCameraText), now = camera_text(actual.cameras);
  if (!camera.empty() && camera != now) return out + moved_text(camera, now);
  if (!camera.empty()) out += "the camera is the same; ";
  return out + commonest_change(expected.image, actual.image);
}

/// Returns a picture in which all that is not compared is as approved; `ignored` counts these pixels.
render::Image masked(const render::Image& expected, render::Image actual, const GoldenSpec& spec,
                     std::uint64_t& ignored) {
  if (spec.ignore.empty() && spec.only.empty()) return actual;
  if (expected.width() != actual.width() || expected.height() != actual.height()) return actual;
  std::vector<char> compared(actual.pixels().size(), spec.only.empty());
  const auto mark = [&](const render::PixelRect& r, bool value) {
    for (int y = r.y; y < std::min(r.bottom(), actual.height()); ++y)
      for (int x = r.x; x < std::min(r.right(), actual.width()); ++x)
        compared[static_cast<std::size_t>(y) * actual.width() + x] = value;
  };
  for (const render::PixelRect& r : spec.only) mark(r, true);
  for (const render::PixelRect& r : spec.ignore) mark(r, false);
  for (std::size_t i = 0; i < compared.size(); ++i)
    if (!compared[i]) actual.pixels()[i] = expected.pixels()[i], ++ignored;
  return actual;
}

}  // namespace

ImageVerdict check_frame(const std::vector<GoldenImage>& variants, const frames::PaintedFrame& actual,
                         std::size_t frame, const GoldenSpec& spec) {
  const render::ImageTolerance& tolerance = spec.tolerance;
  ImageVerdict best;
  best.frame = frame;
  best.has_actual = true;
  best.file = golden_image_file(frame);
  if (variants.empty()) {
    best.text = "not approved yet";
    return best;
  }
  for (const GoldenImage& variant : variants) {
    if (variant.damage.empty()) continue;
    best.file = variant.file;
    best.text = variant.damage;
    return best;
  }
  best.has_expected = true;
  render::ImageDifference least;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const render::Image& expected = variants[i].png.image;
    std::uint64_t ignored = 0;
    const render::Image found = masked(expected, actual.image, spec, ignored);
    const bool equal = expected == found;
    render::ImageDifference d;
    bool passed = equal;
    if (!equal) {
      d = render::compare(expected, found, tolerance);
      d.pixels -= std::min(ignored, d.pixels);
      d.equal -= std::min(ignored, d.equal);
      passed = d.within(tolerance);
    }
    const bool nearer = passed != best.passed            ? passed
                        : d.same_size != least.same_size ? d.same_size
                                                         : d.large < least.large;
    if (i > 0 && !equal && !nearer) continue;
    least = d;
    best.variant = i;
    best.file = variants[i].file;
    best.passed = passed;
    best.equal = equal;
    best.text = equal ? "the images are identical"
                : d.same_size
                    ? d.text(tolerance)
                    : "expected " + size_text(expected) + " pixels, found " + size_text(actual.image);
    if (equal) return best;
  }
  if (!best.passed && least.same_size) {
    best.change = explain(variants[best.variant].png, actual);
    if (!best.change.empty()) best.text += "; " + best.change;
  }
  return best;
}

namespace {

std::vector<ImageVerdict> check_frames(const Golden& golden, const GoldenRun& run) {
  static const std::vector<GoldenImage> none;
  std::vector<ImageVerdict> out;
  for (std::size_t i = 0; i < run.frames.size(); ++i)
    out.push_back(
        check_frame(i < golden.frames.size() ? golden.frames[i] : none, run.frames[i], i, golden.spec));
  for (std::size_t i = run.frames.size(); i < golden.frames.size(); ++i) {
    if (golden.frames[i].empty()) continue;
    ImageVerdict missing;
    missing.frame = i;
    missing.file = golden.frames[i][0].file;
    missing.has_expected = golden.frames[i][0].damage.empty();
    missing.text = "approved, but the run has only " + std::to_string(run.frames.size()) + " frames";
    out.push_back(missing);
  }
  return out;
}

}  // namespace

bool GoldenVerdict::images_passed() const {
  return std::all_of(images.begin(), images.end(), [](const ImageVerdict& v) { return v.passed; });
}

namespace {

/// Describes the answers that changed: of another engine first how many are wrong; pairs before verdicts.
std::string answer_cause(const GoldenVerdict& v, const GoldenRun& run) {
  const record::EngineTotals totals = record::totals_of(run.recording);
  const bool is_wrong = run.recording.trace.has_engine_reports() && totals.wrong_queries > 0;
  const auto of = [&](const char* what) {
    return std::ranges::find_if(v.effects, [&](const Effect& e) { return e.what == what; });
  };
  auto first = of("pairs");
  if (first == v.effects.end()) first = of("relation");
  if (first == v.effects.end()) first = v.effects.begin();
  return (is_wrong ? totals.words() : "the answers changed") + "; step " + std::to_string(first->step) +
         ": " + first->what + ": expected " + first->expected + ", found " + first->found;
}

/// Describes what the program does differently if none of its inputs changed.
std::string program_cause(const GoldenVerdict& v, const Golden& golden, const GoldenRun& run) {
  const std::string same = "the inputs and the version are as approved";
  if (v.answers_differ) return answer_cause(v, run) + "; " + same;
  if (v.divergence)
    return same + ", but the program runs differently: " +
           (v.diagnosis.empty() ? v.divergence->message() : v.diagnosis);
  for (const ImageVerdict& image : v.images) {
    if (image.passed || !image.has_actual || !image.has_expected) continue;
    const std::string &x = golden.facts.renderer, &y = render::gl_version();
    if (!x.empty() && x != y) return "pictures were approved with " + x + ", and drawn with " + y;
    return same + ", but pictures are drawn differently" + (image.change.empty() ? "" : ": " + image.change);
  }
  for (const ImageVerdict& image : v.images)
    if (!image.passed) return image.file + ": " + image.text;
  return same + ", but the program runs differently";
}

}  // namespace

GoldenVerdict check_golden(const Golden& golden, const GoldenRun& run) {
  GoldenVerdict out;
  out.effects = find_effects(golden, run);
  if (golden.spec.compares(Level::answers))
    out.answers_differ = std::any_of(out.effects.begin(), out.effects.end(),
                                     [](const Effect& e) { return e.kind == Effect::Kind::answer; });
  if (golden.spec.compares(Level::events)) {
    out.divergence = trace::first_divergence(golden.trace, run.recording.trace);
    if (out.divergence) out.diagnosis = diagnose(golden.trace, run.recording.trace, *out.divergence);
  }
  if (golden.spec.compares(Level::work)) out.more_work = find_more_work(golden, run);
  if (golden.spec.compares(Level::pictures)) out.images = check_frames(golden, run);
  if (out.passed()) return out;
  out.causes = find_causes(golden, run);
  if (!out.causes.empty()) {
    out.group = out.causes.front();
    return out;
  }
  out.causes.push_back(program_cause(out, golden, run));
  // Numbers of steps, events and pixels differ from golden to golden, even if their cause is one.
  for (const char c : out.causes.front())
    if (c < '0' || c > '9') out.group.push_back(c);
  return out;
}

}  // namespace lrb::golden

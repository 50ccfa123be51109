#include "scenarios/golden/check.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>

#include "render/flip.hpp"
#include "render/gl.hpp"
#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/zip.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/record_fields.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::golden {
namespace {

std::string rep_text(const trace::BodyInfo& body) {
  return render::group_digits(body.regions) + " regions in " + std::to_string(body.layers) + " layers, " +
         render::group_digits(body.outer_faces) + " outermost faces";
}

/// The inputs of a run of two bodies, or of a crowd.
struct Inputs {
  std::uint64_t hash = 0;  ///< of the scenario's file
  const std::vector<trace::BodyInfo>& bodies;
  const CollideRequest& request;
  const std::string& lrbscope;
};

Inputs inputs_of(const trace::TraceHeader& header) {
  return {header.scenario_hash, header.bodies, header.request, header.lrbscope};
}
Inputs inputs_of(const crowd::CrowdTrace& trace) {
  return {trace.crowd.hash, trace.bodies, trace.crowd.request, trace.lrbscope};
}

/// Reports whether a body's mesh has changed or only its LRB-rep.
std::string body_cause(const Golden& golden, const GoldenRun& run, std::size_t i,
                       const trace::BodyInfo& expected, const trace::BodyInfo& found) {
  const std::string who =
      (run.crowd ? run.crowd->crowd.kinds[i].name : "body " + std::string(name_of(static_cast<Side>(i)))) +
      " (" + found.name + "): ";
  const std::string built = rep_text(expected) + " -> " + rep_text(found);
  if (i >= golden.facts.meshes.size())
    return who + "its mesh or its LRB-rep changed: " + built +
           " (this golden does not record which; approve it again to record it)";
  const Mesh mesh = run.bodies()[i].rep.real_mesh();
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
      return "step " + std::to_string(y.steps[i].index) + ": body " + name +
             " moved: its origin is displaced by " + render::short_number((q.t - p.t).norm());
    }
  return {};
}

}  // namespace

std::vector<std::string> find_causes(const Golden& golden, const GoldenRun& run) {
  const Inputs x = golden.crowd ? inputs_of(*golden.crowd) : inputs_of(golden.trace.header),
               y = run.crowd ? inputs_of(run.crowd->trace) : inputs_of(run.recording.trace.header);
  std::vector<std::string> out;
  if (!golden.facts.scenario.empty() && !run.text.empty()) {
    const std::string keys = scenario_difference(golden.facts.scenario, compact_json(run.text));
    if (!keys.empty()) out.push_back("the scenario changed: " + keys);
  } else if (x.hash != run.scenario.hash) {
    out.emplace_back(golden.spec.is_capture()
                         ? "the bodies or the poses of the capture changed since it was approved"
                         : "the scenario file changed since it was approved");
  }
  if (run.crowd)
    if (const std::string words = kinds_cause(*golden.crowd, run.crowd->trace); !words.empty())
      out.push_back(words);
  for (std::size_t i = 0; i < std::min(x.bodies.size(), y.bodies.size()); ++i)
    if (x.bodies[i].hash != y.bodies[i].hash)
      out.push_back(body_cause(golden, run, i, x.bodies[i], y.bodies[i]));
  if (const std::string words = request_cause(x.request, y.request); !words.empty()) out.push_back(words);
  if (const std::string words = run.crowd ? crowd_pose_cause(*golden.crowd, run.crowd->trace)
                                          : pose_cause(golden.trace, run.recording.trace);
      !words.empty())
    out.push_back(words);
  if (x.lrbscope != y.lrbscope)
    out.push_back("approved with lrbscope " + x.lrbscope + ", run with " + y.lrbscope);
  return out;
}

namespace {

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

}  // namespace

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

namespace {

std::string size_text(const render::Image& image) {
  return std::to_string(image.width()) + "x" + std::to_string(image.height());
}

std::string hex_colour(std::uint32_t rgb) {
  char text[8];
  std::snprintf(text, sizeof text, "#%06x", static_cast<unsigned>(rgb));
  return text;
}

std::uint32_t packed(render::Rgba c) {
  return static_cast<std::uint32_t>(c.r) << 16 | static_cast<std::uint32_t>(c.g) << 8 | c.b;
}

/// The colour change shared by most of the strongly different pixels.
std::string commonest_change(const render::Image& expected, const render::Image& actual) {
  const int large = render::ImageTolerance{}.large;
  std::unordered_map<std::uint64_t, std::uint64_t> counts;
  for (std::size_t i = 0; i < expected.pixels().size(); ++i) {
    const render::Rgba e = expected.pixels()[i], a = actual.pixels()[i];
    if (std::max({std::abs(e.r - a.r), std::abs(e.g - a.g), std::abs(e.b - a.b)}) > large)
      ++counts[static_cast<std::uint64_t>(packed(e)) << 32 | packed(a)];
  }
  std::uint64_t change = 0, most = 0;
  for (const auto& [key, count] : counts)
    if (count > most || (count == most && key < change)) change = key, most = count;
  if (most == 0) return {};
  return "most often " + hex_colour(static_cast<std::uint32_t>(change >> 32)) + " -> " +
         hex_colour(static_cast<std::uint32_t>(change)) + " (" + std::to_string(most) +
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
std::string explain(const render::DecodedPng& expected, const run::PaintedFrame& actual) {
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

ImageVerdict check_frame(const std::vector<GoldenImage>& variants, const run::PaintedFrame& actual,
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
    std::string flip;  // the mean FLIP of a picture beyond the tolerance
    bool passed = equal;
    if (!equal) {
      d = render::compare(expected, found, tolerance);
      d.pixels -= std::min(ignored, d.pixels);
      d.equal -= std::min(ignored, d.equal);
      passed = d.within(tolerance);
      if (!passed && d.same_size) {
        const double pixels = static_cast<double>(found.pixels().size());
        const double mean = render::mean_flip(expected, found) * pixels /
                            std::max<double>(1, pixels - static_cast<double>(ignored));
        passed = mean <= spec.flip;
        flip = "; mean FLIP " + io::fixed_text(mean, 4) +
               (spec.flip > 0 ? " (allowed " + render::short_number(spec.flip) + ")" : "");
      }
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
                    ? d.text(tolerance) + flip
                    : "expected " + size_text(expected) + " pixels, found " + size_text(actual.image);
    if (equal) return best;
  }
  if (!best.passed && least.same_size) {
    best.change = explain(variants[best.variant].png, actual);
    if (!best.change.empty()) best.text += "; " + best.change;
  }
  return best;
}

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

/// Describes what the program does differently if none of its inputs changed.
std::string program_cause(const GoldenVerdict& v, const Golden& golden) {
  const std::string same = "the inputs and the version are as approved";
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
  if (golden.spec.compares(Level::events) && run.crowd) {
    out.divergence = first_divergence(*golden.crowd, run.crowd->trace);
  } else if (golden.spec.compares(Level::events)) {
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
  out.causes.push_back(program_cause(out, golden));
  // Numbers of steps, events and pixels differ from golden to golden, even if their cause is one.
  for (const char c : out.causes.front())
    if (c < '0' || c > '9') out.group.push_back(c);
  return out;
}

namespace fs = std::filesystem;
namespace {

void check_variant(const std::string& variant) {
  const bool plain = variant.size() <= 64 && std::all_of(variant.begin(), variant.end(), [](char c) {
                       return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                              c == '_' || c == '-';
                     });
  if (!plain) throw InputError("--variant: expected 1 to 64 letters, digits, - and _");
}

/// Adds what was done with a file, or with `dry` would be done. A removed file that is written again was
/// replaced.
void note_change(std::vector<std::string>& done, bool dry, const std::string& what, const fs::path& file) {
  const auto line = [&](const std::string& word) {
    return (dry ? "would be " : "") + word + " " + file.generic_string();
  };
  const bool replaced = std::erase(done, line("removed")) > 0;
  done.push_back(line(replaced ? "replaced" : what));
}

/// Writes into one golden's folder, and records what it wrote. `dry`: only records it.
class Approval {
 public:
  Approval(const std::string& folder, const GoldenRun& run, bool dry)
      : folder_(folder), run_(run), dry_(dry) {}

  void spec(const GoldenSpec& spec, const GoldenFacts& facts) {
    const std::filesystem::path folder(folder_);
    if (!dry_) write_golden_spec(folder.parent_path().string(), folder.filename().string(), spec, facts);
    say("approved", kGoldenSpec);
  }
  void trace() {
    if (!dry_) save_run_trace(run_, folder_ + "/" + kGoldenTrace);
    say("approved", kGoldenTrace);
  }
  void frame(std::size_t i, const std::string& variant) {
    render::PngOptions png;
    png.text = golden_text(run_, i);
    const std::string file = golden_image_file(i, variant);
    if (!dry_) render::write_png(run_.frames[i].image, folder_ + "/" + file, png);
    say("approved", file);
  }
  /// Keeps the meshes of bodies from files. Generated bodies are defined by their scenario.
  void meshes() {
    for (std::size_t i = 0; i < run_.bodies().size(); ++i) {
      if (run_.scenario.bodies[i].file.empty()) continue;
      const LrbRep& rep = run_.bodies()[i].rep;
      const std::string file = kept_file(i, rep.dim());
      if (!dry_) write_mesh(rep.real_mesh(), folder_ + "/" + file);
      say("approved", file);
    }
  }
  void remove(const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      std::error_code error;
      if (!dry_) fs::remove(folder_ + "/" + file, error);
      say("removed", file);
    }
  }
  std::vector<std::string> done;

 private:
  void say(const std::string& what, const std::string& file) {
    note_change(done, dry_, what, fs::path(folder_) / file);
  }

  std::string folder_;
  const GoldenRun& run_;
  bool dry_;
};

/// Loads a golden. With `may_fail`, returns nullopt if its files are missing or damaged: approving replaces
/// them.
std::optional<Golden> load_if_sound(const std::string& goldens, const std::string& name, bool may_fail) {
  try {
    return load_golden(goldens, name);
  } catch (const InputError&) {
    if (!may_fail) throw;
    return std::nullopt;
  }
}

/// Returns true if a picture is approved: equal to a variant, or within the tolerance.
bool is_approved(const std::vector<GoldenImage>& variants, const render::Image& image, std::size_t frame,
                 const GoldenSpec& spec) {
  run::PaintedFrame found;
  found.image = image;
  return check_frame(variants, found, frame, spec).passed;
}

/// The files of a golden, as bytes, that approving could need.
struct ApprovableGolden {
  std::string name;
  std::vector<io::ZipEntry> files;  ///< without folder
  Golden golden;
};

/// Reads the goldens of a folder or archive that a test wrote. Files are found by their place,
/// .../approve/NAME/FILE, and must be files of a golden.
std::vector<ApprovableGolden> read_approvable(const std::string& from,
                                              const std::vector<std::string>& names) {
  std::vector<io::ZipEntry> entries;
  const auto place = [&](const std::string& path) {
    const fs::path p(path), parent = p.parent_path();
    return std::pair{
        parent.parent_path().filename() == kApprovable ? parent.filename().string() : std::string(),
        p.filename().string()};
  };
  const auto wanted = [&](const std::string& path) {
    const auto [name, file] = place(path);
    const bool named = names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    return named && !name.empty() && name != "." && name != ".." && is_golden_file(file);
  };
  if (fs::is_directory(from)) {
    for (const auto& file : fs::recursive_directory_iterator(from))
      if (file.is_regular_file() && wanted(file.path().generic_string()))
        entries.push_back({file.path().generic_string(), io::read_text(file.path().string())});
  } else {
    entries = io::unzip(io::read_text(from), from, wanted);
  }
  std::map<std::string, ApprovableGolden> found;
  for (io::ZipEntry& e : entries) {
    const auto [name, file] = place(e.name);
    found[name].name = name;
    found[name].files.push_back({file, std::move(e.bytes)});
  }
  for (const std::string& name : names)
    if (!found.count(name))
      throw InputError(printable_name(from) + ": has no failure of a golden " + printable_name(name));
  std::vector<ApprovableGolden> out;
  for (auto& [name, golden] : found) out.push_back(std::move(golden));
  return out;
}

std::vector<std::string> approve_all(Approval approval, const GoldenRun& run, const std::string& folder) {
  approval.remove(image_files_from(folder, 0));
  approval.trace();
  approval.meshes();
  for (std::size_t i = 0; i < run.frames.size(); ++i) approval.frame(i, {});
  return std::move(approval.done);
}

std::vector<std::string> approve_variant(Approval approval, const GoldenVerdict& verdict,
                                         const std::string& name, const std::string& variant) {
  if (verdict.divergence)
    throw InputError(name + ": " + verdict.divergence->message() +
                     "; events must match on all machines, so approve them first, without --variant");
  for (const ImageVerdict& image : verdict.images) {
    if (image.passed) continue;
    if (!image.has_actual || !image.has_expected)
      throw InputError(name + ": " + image.file + ": " + image.text +
                       "; approve it first, without --variant");
    approval.frame(image.frame, variant);
  }
  return std::move(approval.done);
}

/// Copies the files of one golden that differ from the approved ones. Returns one line for each.
std::vector<std::string> approve_files(const std::string& goldens, const ApprovableGolden& from, bool dry) {
  const std::string folder = (fs::path(goldens) / from.name).string();
  std::optional<io::FolderLock> lock;
  if (!dry) {
    make_folder(folder);
    lock.emplace(folder);
  }
  std::vector<std::string> done;
  const auto say = [&](const std::string& what, const std::string& file) {
    note_change(done, dry, what, fs::path(folder) / file);
  };
  const auto copy = [&](const std::string& file) {
    for (const io::ZipEntry& e : from.files)
      if (e.name == file) {
        if (!dry) write_file(folder + "/" + file, e.bytes);
        say("approved", file);
      }
  };
  const auto remove = [&](const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      std::error_code error;
      if (!dry) fs::remove(folder + "/" + file, error);
      say("removed", file);
    }
  };
  const std::optional<Golden> old =
      has_golden(goldens, from.name) ? load_if_sound(goldens, from.name, true) : std::nullopt;
  if (!old) {
    remove(image_files_from(folder, 0));
    for (const io::ZipEntry& e : from.files) copy(e.name);
    return done;
  }
  if (old->facts.meshes != from.golden.facts.meshes)
    for (const io::ZipEntry& e : from.files)
      if (e.name.ends_with(".ply") || e.name.ends_with(".obj")) copy(e.name);
  const bool same_kind = old->crowd.has_value() == from.golden.crowd.has_value();
  if (!same_kind || (old->crowd ? first_divergence(*old->crowd, *from.golden.crowd)
                                : trace::first_divergence(old->trace, from.golden.trace)))
    copy(kGoldenTrace);
  for (std::size_t i = 0; i < std::max(old->frames.size(), from.golden.frames.size()); ++i) {
    const bool has_new = i < from.golden.frames.size() && !from.golden.frames[i].empty();
    const std::vector<GoldenImage> variants =
        i < old->frames.size() ? old->frames[i] : std::vector<GoldenImage>();
    if (has_new && is_approved(variants, from.golden.frames[i][0].png.image, i, from.golden.spec)) continue;
    remove(image_files_of(folder, i));
    if (has_new) copy(golden_image_file(i));
  }
  if (old->spec != from.golden.spec || old->facts != from.golden.facts) copy(kGoldenSpec);
  return done;
}

}  // namespace

void write_golden(const std::string& goldens, const GoldenSpec& spec, const GoldenRun& run) {
  const std::string folder = (fs::path(goldens) / run.scenario.name).string();
  make_folder(folder);
  Approval approval(folder, run, false);
  approval.spec(spec, facts_of(run));
  approve_all(std::move(approval), run, folder);
}

std::vector<std::string> approve_from(const std::string& goldens, const std::string& from,
                                      const std::vector<std::string>& names, bool dry) {
  std::vector<ApprovableGolden> all = read_approvable(from, names);
  if (all.empty())
    throw InputError(printable_name(from) +
                     ": has no failures of goldens; expected the output folder of lrbscope "
                     "golden test, or a ZIP archive of it");
  // All of them must be sound before the first one is approved.
  const io::TemporaryFolder temporary;
  const std::string scratch = temporary.path.string();
  for (ApprovableGolden& g : all) {
    make_folder(scratch + "/" + g.name);
    for (const io::ZipEntry& e : g.files) write_file(scratch + "/" + g.name + "/" + e.name, e.bytes);
    try {
      g.golden = load_golden(scratch, g.name);
      for (const auto& variants : g.golden.frames)
        for (const GoldenImage& image : variants)
          if (!image.damage.empty()) throw InputError(image.damage);
    } catch (const InputError& e) {
      std::string what = e.what();
      if (const std::size_t at = what.find(scratch + "/"); at != std::string::npos)
        what.replace(at, scratch.size() + 1, printable_name(from) + ": ");
      throw InputError(what + "; nothing was approved");
    }
  }
  std::vector<std::string> done;
  for (const ApprovableGolden& g : all) {
    const std::vector<std::string> lines = approve_files(goldens, g, dry);
    done.insert(done.end(), lines.begin(), lines.end());
    if (lines.empty()) done.push_back("unchanged " + g.name);
  }
  return done;
}

std::vector<std::string> approve_golden(const std::string& goldens, const GoldenSpec& spec,
                                        const GoldenRun& run, const std::string& variant, bool dry) {
  const std::string name = run.scenario.name, folder = (fs::path(goldens) / name).string();
  check_variant(variant);
  const bool known = has_golden(goldens, name);
  if (!known && !variant.empty())
    throw InputError(name + ": has no golden yet; approve it first, without --variant");
  std::optional<io::FolderLock> lock;
  if (!dry) {
    make_folder(folder);
    lock.emplace(folder);
  }
  GoldenFacts facts = facts_of(run);
  const std::optional<Golden> old = known ? load_if_sound(goldens, name, variant.empty()) : std::nullopt;
  Approval approval(folder, run, dry);
  if (!old) {
    approval.spec(spec, facts);
    return approve_all(std::move(approval), run, folder);
  }
  Golden golden = *old;
  if (variant.empty()) golden.spec.levels = GoldenSpec{}.levels;  // approves all differences
  const GoldenVerdict verdict = check_golden(golden, run);
  if (!variant.empty()) return approve_variant(std::move(approval), verdict, name, variant);
  if (verdict.images_passed() && !old->facts.renderer.empty()) facts.renderer = old->facts.renderer;
  if (old->spec != spec || old->facts != facts) approval.spec(spec, facts);
  if (verdict.divergence) approval.trace();
  if (old->facts.meshes != facts.meshes) approval.meshes();
  for (const ImageVerdict& image : verdict.images) {
    if (image.passed) continue;
    approval.remove(image_files_of(folder, image.frame));
    if (image.has_actual) approval.frame(image.frame, {});
  }
  return std::move(approval.done);
}

}  // namespace lrb::golden

#include "scenarios/golden/check.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <unordered_map>

#include "render/image_diff.hpp"
#include "scenarios/golden/causes.hpp"
#include "scenarios/golden/diagnosis.hpp"

namespace lrb::golden {
namespace {

std::string size_words(const render::Image& image) {
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

/// The change of colour that most of the strongly different pixels have in common.
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
  return "most often " + hex_colour(static_cast<std::uint32_t>(change >> 32)) + " became " +
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

/// Returns the first part in which the words for two cameras differ, and how many more parts do.
std::string moved_words(const std::string& expected, const std::string& actual) {
  const std::vector<std::string> x = parts_of(expected), y = parts_of(actual);
  if (x.size() != y.size()) return "the camera changed: there were other views";
  std::size_t first = x.size(), more = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] == y[i]) continue;
    if (first < x.size()) ++more;
    first = std::min(first, i);
  }
  return "the camera moved: expected " + x[first] + ", found " + y[first] +
         (more > 0 ? ", and " + std::to_string(more) + " more such changes" : "");
}

/// Tells what is behind a difference: another moment, another camera, or else other colours or shapes.
std::string explain(const render::DecodedPng& expected, const run::PaintedFrame& actual) {
  std::string out;
  const std::string event = text_of(expected, "lrbscope:event"), found = std::to_string(actual.event);
  if (!event.empty() && event != found) out += "drawn after event " + found + " instead of " + event + "; ";
  const std::string camera = text_of(expected, kCameraText), now = camera_words(actual.cameras);
  if (!camera.empty() && camera != now) return out + moved_words(camera, now);
  if (!camera.empty()) out += "the camera is the same; ";
  return out + commonest_change(expected.image, actual.image);
}

ImageVerdict check_frame(const std::vector<GoldenImage>& variants, const run::PaintedFrame& actual,
                         std::size_t frame, const render::ImageTolerance& tolerance) {
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
  const std::uint64_t print = render::hash(actual.image);
  render::ImageDifference least;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const render::Image& expected = variants[i].png.image;
    const bool equal = render::hash(expected) == print;
    const render::ImageDifference d =
        equal ? render::ImageDifference{} : render::compare(expected, actual.image, tolerance);
    const bool passed = equal || d.within(tolerance);
    const bool nearer = passed != best.passed            ? passed
                        : d.same_size != least.same_size ? d.same_size
                                                         : d.large < least.large;
    if (i > 0 && !equal && !nearer) continue;
    least = d;
    best.variant = i;
    best.file = variants[i].file;
    best.passed = passed;
    best.equal = equal;
    best.text = equal ? "the images are equal"
                : d.same_size
                    ? d.text(tolerance)
                    : "expected " + size_words(expected) + " pixels, found " + size_words(actual.image);
    if (equal) return best;
  }
  if (!best.passed && least.same_size) {
    const std::string why = explain(variants[best.variant].png, actual);
    if (!why.empty()) best.text += "; " + why;
  }
  return best;
}

std::vector<ImageVerdict> check_frames(const Golden& golden, const GoldenRun& run) {
  static const std::vector<GoldenImage> none;
  std::vector<ImageVerdict> out;
  for (std::size_t i = 0; i < run.frames.size(); ++i)
    out.push_back(check_frame(i < golden.frames.size() ? golden.frames[i] : none, run.frames[i], i,
                              golden.spec.tolerance));
  for (std::size_t i = run.frames.size(); i < golden.frames.size(); ++i) {
    if (golden.frames[i].empty()) continue;
    ImageVerdict missing;
    missing.frame = i;
    missing.file = golden.frames[i][0].file;
    missing.has_expected = golden.frames[i][0].damage.empty();
    missing.text = "approved, but the run has " + std::to_string(run.frames.size()) + " frames only";
    out.push_back(missing);
  }
  return out;
}

}  // namespace

bool GoldenVerdict::images_passed() const {
  return std::all_of(images.begin(), images.end(), [](const ImageVerdict& v) { return v.passed; });
}

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
  if (golden.spec.compares(Level::pictures)) out.images = check_frames(golden, run);
  if (!out.passed()) out.causes = find_causes(golden, run);
  return out;
}

}  // namespace lrb::golden

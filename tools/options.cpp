#include "tools/options.hpp"

#include <charconv>
#include <thread>
#include <type_traits>

#include "scenarios/frames/animation.hpp"
#include "scenarios/frames/frames.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::tools {
namespace {

constexpr const char* kAutoUp = "auto";

/// Returns the option that sets a field of a request: "--max-tests" for max_tests.
template <class Value>
std::string option_of(Value CollideRequest::*member) {
  std::string out = "--";
  for_each_field<CollideRequest>([&](const auto& field) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype((field.member))>, Value CollideRequest::*>)
      if (field.member == member) out += field.name;
  });
  std::replace(out.begin(), out.end(), '_', '-');
  return out;
}

template <class Target>
void add_recursion(App& app, Target& recursion, const std::string& usual) {
  add_choice<Recursion>(
      app, option_of(&CollideRequest::recursion), recursion,
      "complete: never misses a contact; paper, paper_strict, paper_wrapper: the paper's algorithm, which "
      "can miss contacts; paper_boxes, paper_wrapper_boxes: the same with boxes, in fewer tests [" +
          usual + "]");
}

/// Adds an option that takes a count, at least 1.
void add_count(App& app, const std::string& name, std::uint64_t& count, const std::string& what) {
  app.add_option(name, count, "N", what)->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 62);
}

/// Reads --size.
void apply_size(const std::string& size, pictures::FrameSpec& spec) {
  if (size.empty()) return;
  const char* end = size.data() + size.size();
  const auto [x, e1] = std::from_chars(size.data(), end, spec.width);
  const bool has_x = e1 == std::errc() && x != end && *x == 'x';
  const auto [last, e2] = has_x ? std::from_chars(x + 1, end, spec.height)
                                : std::from_chars_result{x, std::errc::invalid_argument};
  constexpr int kLeast = 64, kMax = 8192;
  if (e2 != std::errc() || last != end || spec.width < kLeast || spec.height < kLeast || spec.width > kMax ||
      spec.height > kMax)
    throw InputError("--size: expected WIDTHxHEIGHT from 64x64 to 8192x8192, found \"" + size + "\"");
}

}  // namespace

void add_recursion_option(App& app, std::optional<Recursion>& recursion) {
  add_recursion(app, recursion, "as in the scenario");
}

void add_events_option(App& app, std::optional<EventLevel>& level) {
  add_choice<EventLevel>(
      app, "--events", level,
      "Events to record. faces: face tests, refinements, contacts; nodes: also tree-node pairs and phases; "
      "all: also face pairs rejected by a separating plane [faces, or as in the scenario]");
}

void add_clock_option(App& app, std::optional<trace::Clock>& clock) {
  add_choice<trace::Clock>(
      app, "--clock", clock,
      "Time in the trace. event: event numbers, the same bytes in every run; wall: nanoseconds, and "
      "microseconds of each step on the page");
}

void add_tex_option(App& app, bool& tex, const char* what) {
  app.add_flag("--tex", tex, std::string("Also write ") + what + " for LaTeX with the package booktabs");
}

void add_request_options(App& app, CollideRequest& request) {
  add_choice<Mode>(app, option_of(&CollideRequest::mode), request.mode,
                   "all: every pair; first: one pair, a crossing one if there is any; any: stop at the first "
                   "pair found");
  add_recursion(app, request.recursion, "complete");
  add_choice<Predicates>(
      app, option_of(&CollideRequest::predicates), request.predicates,
      "floating: no exact fallback; wrong wherever double precision cannot decide the sign");
  add_count(app, option_of(&CollideRequest::max_pairs), request.max_pairs,
            "Maximum number of pairs; a query that finds more is an error [" + std::to_string(kMaxPairs) +
                "; with contacts " + std::to_string(kMaxPairsWithContacts) + "]");
}

void add_coarse_options(App& app, CollideRequest& request) {
  app.add_option(option_of(&CollideRequest::tolerance), request.tolerance, "LENGTH",
                 "Maximum error, in mesh units: answer with the coarsest wrappers within it, and list their "
                 "pairs")
      ->not_negative();
  add_count(app, option_of(&CollideRequest::max_tests), request.max_tests,
            "Maximum number of face tests; on reaching it, return the finest result so far, with its error "
            "bound");
  app.add_option(option_of(&CollideRequest::max_time), request.max_time, "S",
                 "Time limit per query, in seconds; on reaching it, return the best result so far, with its "
                 "error bound")
      ->positive();
}

void add_repeat_option(App& app, std::uint32_t& repeat, const std::string& what) {
  app.add_option("--repeat", repeat, "N",
                 "Repeat the query of each " + what + " N times and add the median time, in microseconds")
      ->in_range(1, 1000000);
}

void add_join_option(App& app, bodies::Corners& corners) {
  app.add_flag_callback(
      "--no-join", [&corners] { corners = bodies::Corners::apart; },
      "Do not merge coincident vertices [merged where the surface would otherwise be open; face numbers do "
      "not change]. Always merged in STL files");
}

void add_build_options(App& app, BuildOptions& options) {
  app.add_option("--patch", options.patch_interior, "N", "Target number of interior vertices per patch")
      ->in_range(1, 1000)
      ->capture_default_str();
  app.add_option("--max-outer", options.max_outer_faces, "N",
                 "Target number of faces of the outermost wrapper")
      ->in_range(4, 1000)
      ->capture_default_str();
  app.add_option("--max-lids", options.max_lids, "N",
                 "Maximum number of lids of a region; 12 for --recursion paper_boxes [any number]")
      ->in_range(1, 1000);
  app.add_flag("--merge-planes", options.merge_planes,
               "First make faces in exactly one plane regions without volume; not in 2D, nor with --lean");
  app.add_flag("--lean", options.lean,
               "Build fewer pseudo faces (about 1.4 faces in total per real face instead of 2); wrappers fit "
               "less tightly");
  app.add_option("--seed", options.seed, "N", "Random seed of the builder")->capture_default_str();
  app.add_option("--threads", options.threads, "N",
                 "Number of threads [all cores]; the result does not depend on it")
      ->in_range(1, 1024);
}

void add_size_options(App& app, PictureOptions& options) {
  app.add_option("--size", options.size, "WxH", "Picture size, in pixels");
  app.add_option(
         "--dpi", options.dpi, "N",
         "Print resolution: same physical size as --size at 96 dpi, with more pixels; lines and text scale "
         "with it")
      ->in_range(spec::kMinDpi, spec::kMaxDpi);
  add_style_option(app, options, "screen");
}

void add_style_option(App& app, PictureOptions& options, const std::string& usual) {
  add_choice<render::StyleName>(
      app, "--style", options.style,
      "print: black on white, thin lines, distinguishable in greyscale; dark: for slides [" + usual + "]");
}

void add_picture_options(App& app, PictureOptions& options, bool auto_up) {
  add_size_options(app, options);
  app.add_flag("--transparent", options.transparent, "Transparent background");
  app.add_flag_callback(
      "--no-title", [&options] { options.titles = false; }, "Omit titles, event text and counters");
  app.add_flag_callback(
      "--no-legend", [&options] { options.legend = false; }, "Omit the legend and the colour bar");
  app.add_option_function<std::string>(
         "--format", [&options](const std::string& word) { options.svg = word == "svg"; }, "png|svg",
         "svg: also write frames and montage as SVG (2D bodies only)")
      ->one_of({"png", "svg"});
  add_choice<pictures::FrameSpec::At>(app, "--frames", options.at, "Events after which a frame is drawn");
  app.add_option("--every", options.every, "N", "Draw only every N-th of the frames selected by --frames")
      ->in_range(1, 1000000000);
  app.add_option("--most", options.most, "N", "Maximum number of frames, evenly spaced")->in_range(1, 10000);
  add_camera_options(app, options.camera, auto_up);
  add_orbit_option(app, options.camera);
  add_colour_options(app, options);
}

void add_colour_options(App& app, PictureOptions& options) {
  add_choice<pictures::FrameSpec::ColourBy>(app, "--colour-by", options.colour_by,
                                            "Quantity that faces are coloured by");
  add_choice<pictures::FrameSpec::ColourPer>(
      app, "--colour-per", options.colour_per,
      "Colour a face by its own value, or by the sum over its region or level");
  app.add_option("--node-boxes", options.node_boxes, "DEPTH",
                 "Draw the visited tree-node boxes at this depth; solid: overlapping, dashed: disjoint")
      ->in_range(0U, spec::kMaxDepth);
}

void check_view(const PictureOptions& options, std::size_t views) {
  if (options.view && *options.view > views)
    throw InputError("--view: expected at most " + std::to_string(views) + ", the number of views, found " +
                     std::to_string(*options.view));
}

void apply(const PictureOptions& options, pictures::FrameSpec& spec) {
  if (!options.animation.empty()) frames::check_animation(options.animation);
  apply_size(options.size, spec);
  if (options.dpi) spec.dpi = *options.dpi;
  if (options.svg) spec.svg = *options.svg;
  spec.transparent |= options.transparent;
  if (options.style) spec.style = *options.style;
  spec.titles &= options.titles;
  spec.legend &= options.legend;
  if (options.at) {
    spec.at = *options.at;
    spec.every = 1;
  }
  if (options.every) spec.every = *options.every;
  if (options.most) spec.most = *options.most;
  if (options.colour_by) spec.colour_by = *options.colour_by;
  if (options.colour_per) spec.colour_per = *options.colour_per;
  if (options.node_boxes) spec.node_boxes = options.node_boxes;
  frames::check_frame_size(spec);
  check_view(options, std::max<std::size_t>(1, spec.views.size()));  // none named: one by default
  if (options.view && !spec.views.empty()) spec.views = {spec.views[*options.view - 1]};
  apply(options.camera, spec.views);
}

void add_camera_options(App& app, CameraOptions& options, bool auto_up) {
  app.add_option("--from", options.from, "X,Y,Z", "Direction from the bodies to the camera, in file axes");
  app.add_option("--look-at", options.look_at, "X,Y,Z",
                 "Point to centre the picture on [centre of the bodies]");
  app.add_option("--zoom", options.zoom, "N", "Zoom factor; above 1 is closer")->in_range(0.01, 1000.0);
  app.add_option_function<std::string>(
         "--projection",
         [&options](const std::string& word) { options.orthographic = word == "orthographic"; },
         "perspective|orthographic", "Camera projection")
      ->one_of({"perspective", "orthographic"});
  add_up_option(app, options.up, auto_up);
}

void add_orbit_option(App& app, CameraOptions& options) {
  app.add_option("--orbit", options.orbit, "DEGREES",
                 "Total angle by which the camera orbits the bodies between the first and the last frame")
      ->in_range(-36000.0, 36000.0);
}

void apply(const CameraOptions& options, std::vector<pictures::FrameSpec::View>& views) {
  const bool any = !options.from.empty() || !options.look_at.empty() || !options.up.empty() || options.zoom ||
                   options.orthographic || options.orbit;
  if (!any) return;
  if (views.empty()) views.emplace_back();
  for (pictures::FrameSpec::View& view : views) {
    view.directed = !options.from.empty() || !options.up.empty() || options.orthographic.has_value() ||
                    options.orbit.has_value();
    if (!options.up.empty() && options.up != kAutoUp) {
      const int axis = options.up[0] - 'x';
      const render::ViewDirection turned = turned_up({view.from, view.up}, axis);
      const render::ViewDirection fixed = turned_up({view.eye, view.target}, axis);
      view.from = turned.from;
      view.up = turned.up;
      view.eye = fixed.from;
      view.target = fixed.up;
    }
    if (!options.from.empty()) {
      view.from = io::parse_vector(options.from, "--from");
      if (view.camera == pictures::FrameSpec::Camera::fixed) view.camera = pictures::FrameSpec::Camera::scene;
    }
    if (!(view.from.cross(view.up).squaredNorm() > 0))
      throw InputError("--from: expected a direction other than zero that is not parallel to the up axis (" +
                       (options.up.empty() ? "z" : options.up) + "; see --up)");
    if (!options.look_at.empty()) view.look_at = io::parse_vector(options.look_at, "--look-at");
    if (options.zoom) view.zoom = *options.zoom;
    if (options.orthographic) view.orthographic = *options.orthographic;
    if (options.orbit) {
      view.camera = pictures::FrameSpec::Camera::orbit;
      view.turn_degrees = *options.orbit;
    }
  }
}

void add_up_option(App& app, std::string& up, bool auto_up) {
  app.add_option(
         "--up", up, "x|y|z|auto",
         std::string("Axis that points up in the pictures; auto: the one on which body A is most stable ") +
             (auto_up ? "[auto; z for 2D and bodies that fall over]" : "[z]"))
      ->one_of({"x", "y", "z", kAutoUp});
}

render::ViewDirection turned_up(const render::ViewDirection& view, int axis) {
  const auto turned = [axis](const Eigen::Vector3d& v) {
    Eigen::Vector3d out;
    for (int i = 0; i < 3; ++i) out[(i + axis + 1) % 3] = v[i];
    return out;
  };
  return {turned(view.from), turned(view.up)};
}

void add_animation_option(App& app, PictureOptions& options) {
  app.add_option("--view", options.view, "N", "Draw only this one of the run's views, from 1")
      ->in_range(1, 6);
  app.add_option("--animate", options.animation, "OUT.png|mp4|gif|webp",
                 "Also write the frames as an animation; formats other than PNG need ffmpeg");
}

void animate_frames(const PictureOptions& options, const std::string& folder) {
  if (!options.animation.empty()) frames::animate(folder, options.animation);
}

std::uint32_t all_cores() {
  return std::max(1U, std::thread::hardware_concurrency());
}

render::ViewDirection view_with(const std::string& up) {
  return up.empty() ? render::ViewDirection() : turned_up({}, up[0] - 'x');
}

void resolve_up(std::string& up, const LrbRep& rep, const Globals& globals) {
  if (up != kAutoUp) return;
  if (rep.dim() == 2) return up.clear();
  const std::optional<int> guess = pictures::likely_up(rep);
  note(globals, {guess ? std::string("--up auto: the body is most stable with --up ") + "xyz"[*guess]
                       : "--up auto: the body would fall over whichever axis is up; z is up"});
  up = {"xyz"[guess.value_or(2)]};
}

void choose_views(const CameraOptions& given, spec::Scenario& scenario, record::Recording& recording) {
  const frames::RecordedRun recorded = run::recorded_run_of(scenario, recording);
  std::vector<pictures::FrameSpec::View>& views = scenario.frames.views;
  const Eigen::Vector3d up = views[0].up;
  // Directions are compared in drawn pictures, which a run without frames must not need.
  if (given.from.empty() && scenario.frames.at != pictures::FrameSpec::At::none) {
    const Eigen::Vector3d from = frames::min_hidden(recorded, up, views[0].from);
    for (pictures::FrameSpec::View& view : views) view.from = from;
  }
  frames::widen_close_ups(recorded, views);
  recording.trace.header.pictures = spec::pictures_text(scenario.frames);
}

}  // namespace lrb::tools

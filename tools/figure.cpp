#include "scenarios/figure/figure.hpp"

#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "render/pictures/panel.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/svg.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::tools {
namespace {

struct FigureOptions {
  std::string source, file, width, line_width;
  TwoMeshes meshes;  ///< b: empty if there is one source
  std::vector<std::string> bodies;
  std::vector<std::uint32_t> faces, events, steps;
  std::vector<std::string> towards;
  bool layers = false, close_up = false, try_views = false;
  std::optional<bool> wrappers;
  std::size_t views = 0;  ///< 0: chosen by the number of bodies
  PictureOptions picture;
  figure::FigureSpec figure;
};

/// The input of a figure, with default picture options.
struct Source {
  std::string name, purpose;
  record::Recording recording;
  pictures::FrameSpec frames;
  bool own_view = false;    ///< no view was given
  bool up_applied = false;  ///< the views already follow --up
};

constexpr const char* kTowardsWhat =
    "--towards: expected a mesh, a .lrb file or a scenario with \"show\": \"refinement\"";

bool is_mesh_name(const std::string& path) {
  return has_mesh_extension(path) || path.ends_with(".lrb");
}

/// Returns the run in which the wrapper of a user's body is refined down to the body.
Source refine_body(const std::string& path, const std::vector<Eigen::Vector3d>& towards,
                   const record::ProgressReport& progress) {
  spec::Scenario s;
  s.towards = towards;
  s.name = std::filesystem::path(path).stem().string();
  s.show = spec::Show::refinement;
  s.bodies.resize(1);
  s.bodies[0].file = path;
  return {s.name, {}, record::record(s, progress), {}, true};
}

Source run_of_scenario(const std::string& name, const std::vector<Eigen::Vector3d>& towards,
                       EventLevel events, const record::ProgressReport& progress) {
  spec::Scenario s = spec::open_scenario(name);
  if (!towards.empty()) {
    if (s.show != spec::Show::refinement) throw InputError(kTowardsWhat);
    s.towards = towards;
  }
  s.events = std::max(s.events, events);
  return {s.name, s.purpose, record::record(s, progress), s.frames, false};
}

Source open_trace(const std::string& path, const std::vector<std::string>& bodies) {
  Source out;
  out.recording = record::open_run(trace::load_trace(path), path, bodies);
  out.name = out.recording.trace.header.scenario;
  out.frames = spec::read_pictures(out.recording.trace.header.pictures, printable_name(path));
  return out;
}

bool is_trace_name(const std::string& path) {
  const std::string file = std::filesystem::path(path).filename().string();
  return file.ends_with(".json.gz") || (file.ends_with(".json") && !file.ends_with(spec::kScenarioEnding) &&
                                        file.find("trace") != std::string::npos);
}

Source open_source(const FigureOptions& o, const Globals& globals) {
  const record::ProgressReport progress = progress_report(globals.quiet);
  std::vector<Eigen::Vector3d> towards;
  for (const std::string& point : o.towards) towards.push_back(io::parse_vector(point, "--towards"));
  std::error_code error;
  const bool is_trace = std::filesystem::is_directory(o.source, error) || is_trace_name(o.source);
  if (!towards.empty() && (!o.meshes.b.empty() || is_trace)) throw InputError(kTowardsWhat);
  if (!o.meshes.b.empty()) {
    if (!is_mesh_name(o.source) || !is_mesh_name(o.meshes.b))
      throw InputError(printable_name(o.source) + " and " + printable_name(o.meshes.b) +
                       ": expected two mesh or .lrb files, or one source");
    TwoMeshes meshes = o.meshes;
    meshes.a = o.source;
    PictureOptions camera;
    camera.camera = o.picture.camera;
    auto [scenario, recording] = record_meshes(meshes, camera, globals);
    return {scenario.name, {}, std::move(recording), scenario.frames, false, true};
  }
  if (!o.meshes.poses.empty() || !o.meshes.approach.empty())
    throw InputError("--poses or --approach: expected two meshes, found one source");
  if (is_trace) return open_trace(record::trace_of(o.source), o.bodies);
  if (!o.bodies.empty())
    throw InputError("--bodies: expected a trace, but " + printable_name(o.source) + " is not one");
  if (is_mesh_name(o.source)) return refine_body(o.source, towards, progress);
  return run_of_scenario(o.source, towards, o.figure.proof_map ? EventLevel::all : EventLevel::faces,
                         progress);
}

/// Returns the selected panels. At most one of --faces, --events, --steps and --layers is given.
figure::Choice choice_of(const FigureOptions& o) {
  using By = figure::Choice::By;
  figure::Choice choice = o.figure.choice;
  if (o.layers) choice.by = By::layers;
  for (const auto& [numbers, by] :
       {std::pair{&o.faces, By::faces}, {&o.events, By::events}, {&o.steps, By::steps}}) {
    if (numbers->empty()) continue;
    choice.by = by;
    choice.numbers = *numbers;
  }
  return choice;
}

figure::FigureSpec figure_spec(const FigureOptions& o, const std::string& file) {
  figure::FigureSpec spec = o.figure;
  spec.format = figure::format_of(file);
  constexpr double kLeast = 20 * figure::kPointsPerMm, kMax = 500 * figure::kPointsPerMm;
  if (!o.width.empty()) spec.width = figure::parse_length(o.width, "--width", kLeast, kMax);
  if (!o.line_width.empty())
    spec.line_width = figure::parse_length(o.line_width, "--line-width", figure::kHairline, 3);
  if (o.picture.dpi) spec.dpi = *o.picture.dpi;
  spec.choice = choice_of(o);
  spec.contact_sheet = o.try_views;
  if (o.try_views) spec.titles = true, spec.legend = false;
  return spec;
}

/// Returns views to choose from, with the options for them as titles: two for each axis that may point up, or
/// six around the one given.
std::vector<pictures::FrameSpec::View> views_to_try(const std::string& up, const LrbRep& rep) {
  constexpr double kElevation = 0.45;
  std::vector<pictures::FrameSpec::View> out;
  for (const char axis : up.empty() ? std::string("zyx") : up) {
    pictures::FrameSpec::View view;
    view.directed = true;
    view.up = turned_up({view.from, view.up}, axis - 'x').up;
    const Eigen::Vector3d side = pictures::broadside(pictures::box_of(rep), view.up);
    const int turns = up.empty() ? 2 : 6;
    for (int i = 0; i < turns; ++i) {
      const Eigen::Vector3d flat = side - view.up * side.dot(view.up);
      const Eigen::AngleAxisd rotation(2 * std::numbers::pi * i / turns, view.up);
      // Rounded as in the title, so that the options give the same view.
      const Eigen::Vector3d from = rotation * flat.normalized() + kElevation * view.up;
      view.title = std::string("--up ") + axis + " --from ";
      for (int k = 0; k < 3; ++k) {
        view.from[k] = std::round(100 * from[k]) / 100;
        view.title += (k > 0 ? "," : "") + render::svg_text::number(view.from[k]);
      }
      out.push_back(view);
    }
  }
  return out;
}

pictures::FrameSpec frame_spec(const FigureOptions& o, const Source& source, const Globals& globals) {
  pictures::FrameSpec frames = source.frames;
  if (o.close_up) frames.views = frames::whole_and_contact(frames.views);
  // Two bodies: one view by default, so that the figure takes at most half a page.
  const std::size_t views = o.views > 0                                         ? o.views
                            : source.recording.bodies.size() == 1 || o.close_up ? 26
                                                                                : 1;
  if (frames.views.size() > views) frames.views.resize(views);
  PictureOptions picture = o.picture;
  if (source.up_applied)
    picture.camera.up.clear();
  else
    resolve_up(picture.camera.up, source.recording.bodies[0].rep, globals);
  if (o.try_views) {
    frames.views = views_to_try(picture.camera.up, source.recording.bodies[0].rep);
    picture.camera.up.clear();
  }
  picture.dpi.reset();  // set for the whole figure
  if (!picture.style) picture.style = render::StyleName::print;
  apply(picture, frames);
  // Wrappers would hide the real faces, which the complete query tests, and two bodies in contact.
  const std::vector<bodies::LoadedBody>& bodies = source.recording.bodies;
  const bool complete = source.recording.trace.header.request.recursion == Recursion::complete;
  const bool hides_values =
      pictures::is_value(frames.colour_by) && frames.colour_by != pictures::FrameSpec::ColourBy::refinements;
  const bool hides_contact = bodies.size() == 2 && bodies[0].rep.dim() == 3;
  if (!o.wrappers.value_or(!complete || !(hides_values || hides_contact))) {
    if (frames.views.empty()) frames.views.emplace_back();
    for (pictures::FrameSpec::View& view : frames.views) {
      view.wrapper = false;
      if (!o.try_views) view.title.clear();  // it may speak of wrappers
    }
  }
  frames::check_views(frames.views, source.recording.bodies[0].rep.dim());
  if (source.own_view && picture.camera.from.empty() && !o.try_views) {
    if (frames.views.empty()) frames.views.emplace_back();
    for (pictures::FrameSpec::View& view : frames.views)
      view.from = pictures::broadside(pictures::box_of(source.recording.bodies[0].rep), view.up);
  }
  const trace::TraceHeader& header = source.recording.trace.header;
  if (const EventLevel needed = pictures::needed_level(frames); needed > header.level)
    throw InputError(
        "--colour-by or --node-boxes: the run lacks the events for it; record it with --events " +
        std::string(name_of(needed)));
  return frames;
}

/// Writes a figure and its caption.
void write_figure(const figure::Figure& drawn, const std::string& file) {
  std::filesystem::path caption(file);
  caption.replace_extension(".caption.txt");
  io::write_text(file, drawn.bytes);
  io::write_text(caption.string(), drawn.caption + "\n");
  print(file + "\n");
}

int run_proof_map(const FigureOptions& o, const Source& source, const std::string& file) {
  pictures::Look look;
  look.style = o.picture.style.value_or(render::StyleName::print);
  look.transparent = o.picture.transparent;
  const frames::RecordedRun recorded = run::recorded_run_of(source.name, source.purpose, source.recording);
  write_figure(figure::draw_proof_map(recorded, look, figure_spec(o, file)), file);
  return kOk;
}

int run_figure(const FigureOptions& o, const Globals& globals) {
  const record::ProgressReport progress = progress_report(globals.quiet);
  if (!o.file.empty()) static_cast<void>(figure_spec(o, o.file));  // check the file before an expensive run
  const Source source = open_source(o, globals);
  const std::string file = o.file.empty() ? "out/" + source.name + ".pdf" : o.file;
  if (o.figure.proof_map) return run_proof_map(o, source, file);
  figure::FigureSpec spec = figure_spec(o, file);
  pictures::FrameSpec frames = frame_spec(o, source, globals);
  if (o.try_views && source.recording.trace.events.size() > 0)
    spec.choice = {figure::Choice::By::events,
                   {static_cast<std::uint32_t>(source.recording.trace.events.size() - 1)}};
  frames::RecordedRun recorded = run::recorded_run_of(source.name, source.purpose, source.recording);
  for (const trace::EventId event : figure::choose(recorded, spec.choice).events)
    recorded.close_up_steps.push_back(recorded.trace->step_of(event));
  if (o.close_up) {
    frames::widen_close_ups(recorded, frames.views);
    // A close-up of the whole bodies shows the same as the first view.
    if (frames.views.size() == 2 && frames.views[1].camera != pictures::FrameSpec::Camera::contact &&
        !frames.views[0].wrapper) {
      frames.views.pop_back();
      note(globals, {"--close-up: left out, because the contact is nearly as large as the bodies"});
    }
  }
  const figure::Figure drawn = figure::draw_figure(recorded, frames, spec, progress);
  note(globals, source.recording.notes);
  note(globals, drawn.notes);
  write_figure(drawn, file);
  return kOk;
}

void add_panel_options(App& app, FigureOptions& o) {
  auto* panels = app.add_option("--panels", o.figure.choice.panels, "N",
                                "Maximum number of panels, placed where the picture changes [6; for two "
                                "bodies 4]")
                     ->in_range(std::size_t{1}, figure::kMaxPanels);
  const auto add = [&](const char* name, std::vector<std::uint32_t>& numbers, const char* what) {
    return app.add_option(name, numbers, "N,N,...", what)->delimiter(',')->excludes(panels);
  };
  auto* faces = add("--faces", o.faces, "One panel for each number of wrapper faces given (approximate)");
  auto* events = add("--events", o.events, "One panel after each of these events");
  auto* steps = add("--steps", o.steps, "One panel after each of these time steps");
  auto* layers = app.add_flag("--layers", o.layers,
                              "One panel per layer of regions of a body, at most 26, evenly spaced")
                     ->excludes(panels);
  faces->excludes(events)->excludes(steps)->excludes(layers);
  events->excludes(steps)->excludes(layers);
  steps->excludes(layers);
  app.add_flag(
         "--proof-map", o.figure.proof_map,
         "Draw a map of all pairs of faces instead: what each test rejected in a step, the one of --steps or the last")
      ->excludes(panels)
      ->excludes(faces)
      ->excludes(events)
      ->excludes(layers);
}

void add_callout_options(App& app, FigureOptions& o) {
  app.add_option_function<std::vector<std::string>>(
         "--callout",
         [&o](const std::vector<std::string>& all) {
           for (const std::string& text : all) o.figure.callouts.push_back(figure::parse_callout(text));
         },
         "[PANEL:]face|region:N[=TEXT]",
         "Point to a face or region (N or aN of A, bN of B) with its number or a text, in one panel or in all; "
         "repeatable")
      ->allow_extra_args(false);
  app.add_option_function<std::vector<std::string>>(
         "--inset",
         [&o](const std::vector<std::string>& all) {
           for (const std::string& text : all) o.figure.insets.push_back(figure::parse_inset(text));
         },
         "PANEL:face|region:N|contact[:TIMES]",
         "Show a face, a region or the contact enlarged below a panel, which has a frame there; repeatable")
      ->allow_extra_args(false);
}

void add_paper_options(App& app, FigureOptions& o) {
  app.add_option("--width", o.width, "LENGTH", "Width on paper, in mm, cm, in or pt [85mm]");
  app.add_option("--columns", o.figure.columns, "N", "Number of columns [chosen automatically]")
      ->in_range(1, 26);
  app.add_option("--font-size", o.figure.font_size, "PT", "Font size, in points")
      ->in_range(4.0, 24.0)
      ->capture_default_str();
  app.add_option("--line-width", o.line_width, "LENGTH",
                 "Width of thin lines, at least 0.25pt; other lines scale with it [0.35pt]");
  app.add_option("--dpi", o.picture.dpi, "N",
                 "Resolution of 3D faces and of PNG files, in pixels per inch [600; PNG 300]")
      ->in_range(spec::kMinDpi, spec::kMaxDpi);
  app.add_option(
         "--vector-faces", o.figure.vector_faces, "N",
         "Maximum number of visible faces in a panel for 3D faces as vector graphics; with more they are an "
         "image in all panels")
      ->in_range(std::size_t{0}, std::size_t{1'000'000})
      ->capture_default_str();
  app.add_flag("--title,!--no-title", o.figure.titles,
               "Show or hide a title below each panel, after its letter [hidden]");
  Option* wrappers = app.add_flag_callback(
      "--wrappers", [&o] { o.wrappers = true; },
      "Draw the bodies in their wrappers [unless these hide two 3D bodies or faces that --colour-by colours]");
  app.add_flag_callback(
         "--no-wrappers", [&o] { o.wrappers = false; }, "Draw the bodies alone")
      ->excludes(wrappers);
  app.add_flag("--legend,!--no-legend", o.figure.legend, "Show or hide the legend and colour bar [shown]");
  app.add_flag("--caption", o.figure.caption,
               "Set the caption below the panels; it is always written to FIG.caption.txt");
  add_style_option(app, o.picture, "print");
  app.add_flag("--occlusion", o.figure.occlusion,
               "Darken creases and gaps between 3D bodies (ambient occlusion)");
  app.add_flag("--transparent", o.picture.transparent, "Transparent background");
}

}  // namespace

Command add_figure(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "figure", "Lay out panels of a run as a print figure of a given width (PDF, SVG or PNG)");
  const auto o = std::make_shared<FigureOptions>();
  app->add_option(
         "SOURCE", o->source,
         "A run's folder or trace; a scenario; or a mesh or .lrb file, whose refinement from the outermost "
         "wrapper to the body is shown")
      ->required();
  app->add_option("B", o->meshes.b, "A second mesh or .lrb file, which moves into the first as in collide");
  add_motion_options(*app, o->meshes);
  app->add_option("-o,--output", o->file, "FIG.pdf|svg|png", "File to write [out/NAME.pdf]");
  app->add_option("--bodies", o->bodies, "FILE", "Bodies of the trace [a.lrb and b.lrb next to it]")
      ->expected(1, 2);
  add_panel_options(*app, *o);
  add_callout_options(*app, *o);
  add_paper_options(*app, *o);
  app->add_option("--views", o->views, "N",
                  "Maximum number of the run's views to show [one body: all; two bodies: 1]")
      ->in_range(std::size_t{1}, std::size_t{26});
  app->add_flag("--try-views", o->try_views,
                "Show the last state from several directions instead, each with the options for it");
  app->add_flag("--close-up", o->close_up, "Add panels that show the contact close up, without wrappers");
  app->add_option(
         "--towards", o->towards, "X,Y,Z",
         "Refine the wrapper only towards the face nearest to this point of the world; several: one panel each")
      ->allow_extra_args(false);
  add_camera_options(*app, o->picture.camera);
  add_orbit_option(*app, o->picture.camera);
  add_colour_options(*app, o->picture);
  return {app, [o, &globals] { return run_figure(*o, globals); }};
}

}  // namespace lrb::tools

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/frames/frames.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/run/run_page.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::tools {
namespace {

struct RenderOptions {
  std::string trace, folder;
  std::vector<std::string> bodies;
  std::vector<std::uint32_t> events;
  PictureOptions picture;
  std::uint32_t montage = 0, columns = 0;
  bool close_up = false, hide_rest = false;
  std::vector<std::string> regions, layers;
};

std::string output_folder(const RenderOptions& o) {
  return o.folder.empty()
             ? "out/" + std::filesystem::path(o.trace).parent_path().filename().string() + "-render"
             : o.folder;
}

/// An element number of one of the bodies, as given in options.
struct OfBody {
  std::size_t body = 0;
  std::uint32_t number = 0;
};

/// Parses a number: "12" and "a12" are A's, "b12" is B's. `what` is the kind of element; body b has counts[b]
/// of them.
OfBody read_of_body(const std::string& option, const std::string& what, const std::string& text,
                    const std::vector<std::uint32_t>& counts) {
  const bool named = text.starts_with('a') || text.starts_with('b');
  OfBody out;
  out.body = text.starts_with('b') ? 1 : 0;
  const char *first = text.data() + (named ? 1 : 0), *last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, out.number);
  if (error != std::errc() || end != last)
    throw InputError(option + ": expected a " + what + " number, optionally after a or b, found " +
                     printable_name(text));
  if (out.body >= counts.size()) throw InputError(option + " " + text + ": the trace has no body B");
  if (out.number >= counts[out.body])
    throw InputError(option + " " + text + ": the body has " + std::to_string(counts[out.body]) + " " + what +
                     "s, numbered from 0");
  return out;
}

/// Shows only the requested regions and describes each: once, unless frames are requested.
void isolate(const RenderOptions& o, const std::vector<bodies::LoadedBody>& bodies,
             pictures::FrameSpec& spec) {
  std::vector<std::uint32_t> regions, layers;
  for (const bodies::LoadedBody& body : bodies) {
    regions.push_back(body.rep.region_count());
    layers.push_back(body.rep.layer_count());
  }
  for (const std::string& text : o.regions) {
    const OfBody r = read_of_body("--region", "region", text, regions);
    spec.isolate[r.body].emplace_back(r.number);
  }
  for (const std::string& text : o.layers) {
    const OfBody layer = read_of_body("--layer", "layer", text, layers);
    const LrbRep& rep = bodies[layer.body].rep;
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (rep.layer(r) == layer.number) spec.isolate[layer.body].push_back(r);
  }
  if (o.regions.empty() && o.layers.empty()) return;
  for (std::vector<RegionId>& of_body : spec.isolate) {
    std::sort(of_body.begin(), of_body.end());
    of_body.erase(std::unique(of_body.begin(), of_body.end()), of_body.end());
  }
  if (o.events.empty() && !o.picture.at) {
    spec.at = pictures::FrameSpec::At::events;
    spec.events = {0};
    if (o.montage == 0) spec.montage = 0;
  }
  spec.ghost_rest = !o.hide_rest;
}

/// Returns the drawing options: those of the run, `pictures`, overridden by the command line.
pictures::FrameSpec frame_spec(const RenderOptions& o, spec::Show show, const std::string& pictures = "") {
  pictures::FrameSpec spec =
      spec::read_pictures(pictures, printable_name(o.trace), spec::default_frames(show));
  if (o.close_up) spec.views = frames::whole_and_contact(spec.views);
  apply(o.picture, spec);
  if (!o.events.empty()) {
    spec.at = pictures::FrameSpec::At::events;
    spec.events = o.events;
  }
  if (o.montage > 0) spec.montage = o.montage;
  if (o.columns > 0) spec.montage_columns = o.columns;
  return spec;
}

/// Returns the content kind of a recorded run.
spec::Show show_of(const trace::Trace& trace, std::size_t bodies) {
  if (trace.header.construction) return spec::Show::construction;
  return bodies == 2 ? spec::Show::collision : spec::Show::refinement;
}

int run_render(const RenderOptions& given, const Globals& globals) {
  RenderOptions o = given;
  o.trace = record::trace_of(given.trace);
  const record::Recording recording = record::open_run(trace::load_trace(o.trace), o.trace, o.bodies);
  const trace::Trace& trace = recording.trace;
  const std::vector<bodies::LoadedBody>& bodies = recording.bodies;
  resolve_up(o.picture.camera.up, bodies[0].rep, globals);
  const frames::RecordedRun p = run::recorded_run_of(trace.header.scenario, {}, recording);
  const std::string folder = output_folder(o);
  pictures::FrameSpec spec = frame_spec(o, show_of(trace, bodies.size()), trace.header.pictures);
  isolate(o, bodies, spec);
  const std::vector<std::pair<std::string, std::string>> text = {
      {"Software", "lrbscope " + trace.header.lrbscope},
      {"lrbscope:scenario", trace.header.scenario},
      {"lrbscope:scenario_hash", trace::to_hex(trace.header.scenario_hash)},
  };
  if (const EventLevel needed = pictures::needed_level(spec); needed > trace.header.level)
    throw InputError(printable_name(o.trace) +
                     " lacks the events for --colour-by or --node-boxes; record the run with --events " +
                     std::string(name_of(needed)));
  if (pictures::needed_level(spec) == EventLevel::nodes && recording.trees.empty())
    throw InputError("--colour-by or --node-boxes: " + printable_name(o.trace) + " is of " +
                     trace.header.engine +
                     " and does not contain its trees; record them with `lrbscope import`");
  frames::check_frames(p, spec);  // throws before anything is written
  const report::Folder locked(folder);
  const frames::DrawnFrames drawn =
      frames::draw_frames(p, spec, folder, text, progress_report(globals.quiet));
  const std::string file = std::filesystem::relative(o.trace, folder).generic_string();
  run::ReportText report{trace.header.scenario,
                         "Drawn from a recorded run.",
                         globals.command_line,
                         file,
                         {run::trace_link(file)}};
  if (o.bodies.empty()) report.why = "lrbscope why --run " + shell_word(o.trace);
  run::run_page(p, drawn, folder, report).write(locked);
  animate_frames(o.picture, folder);
  print(folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_render(App& root, const Globals& globals) {
  App* app = root.add_subcommand("render", "Redraw the pictures of a recorded run without rerunning it");
  const auto o = std::make_shared<RenderOptions>();
  app->add_option("TRACE", o->trace, "A run's folder, trace.json or trace.json.gz")->required();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder [out/NAME-render]");
  app->add_option("--bodies", o->bodies, "FILE", "Bodies of the trace [a.lrb and b.lrb next to it]")
      ->expected(1, 2);
  app->add_option("--events", o->events, "N,N,...", "Draw a frame after each of these events")
      ->delimiter(',');
  app->add_option("--montage", o->montage, "N", "Number of panels of the montage [as in the run]")
      ->in_range(1, 26);
  app->add_option("--columns", o->columns, "N", "Number of columns of the montage [as in the run]")
      ->in_range(1, 26);
  app->add_flag("--close-up", o->close_up, "Add a second view that shows the contact close up");
  app->add_option("--region", o->regions, "N,N,...",
                  "Show only these regions (N or aN of A, bN of B), close up; the rest is a ghost")
      ->delimiter(',');
  app->add_option("--layer", o->layers, "K,K,...",
                  "Show only the regions of these layers (K or aK of A, bK of B; 0 is the innermost)")
      ->delimiter(',');
  app->add_flag("--no-ghost", o->hide_rest, "With --region or --layer: omit the rest");
  add_picture_options(*app, o->picture);
  add_animation_option(*app, o->picture);
  return {app, [o, &globals] { return run_render(*o, globals); }};
}

}  // namespace lrb::tools

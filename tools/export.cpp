#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/bodies/resolutions.hpp"
#include "scenarios/exchange/model.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::tools {
namespace {

struct ExportOptions {
  std::string input, out, up = "z", of;
  std::vector<std::string> what, bodies;
  std::optional<std::uint32_t> step, event, faces, layer;
  std::optional<double> tolerance;
  PictureOptions picture;

  bool asks_for(const char* word) const { return std::find(what.begin(), what.end(), word) != what.end(); }
  bool chooses_wrapper() const { return faces || layer || tolerance; }
};

/// Kind of the input.
enum class Input : std::uint8_t { body, run, scenario, poses };

/// Returns true if a JSON text appears to have this member (a text search).
bool mentions(const std::string& text, std::string_view key) {
  return text.find("\"" + std::string(key) + "\"") != std::string::npos;
}

Input kind_of(const ExportOptions& o) {
  std::error_code error;
  if (std::filesystem::is_directory(o.input, error)) return Input::run;
  if (!std::filesystem::exists(o.input, error)) return Input::scenario;
  const bool json = o.input.ends_with(".json");
  const std::string text = json || o.input.ends_with(".gz") ? trace::load_trace_text(o.input) : std::string();
  if (mentions(text, "traceEvents")) return Input::run;
  if (json && mentions(text, "bodies")) return Input::scenario;
  return o.asks_for("poses") ? Input::poses : Input::body;
}

record::Recording open_recording(const ExportOptions& o, Input kind, const Globals& globals) {
  if (kind == Input::scenario) {
    spec::Scenario scenario = spec::open_scenario(o.input);
    scenario.events =
        std::max(scenario.events,
                 o.picture.colour_by ? pictures::needed_level(*o.picture.colour_by) : EventLevel::faces);
    return record::record(scenario, progress_report(globals.quiet));
  }
  const std::string path = record::trace_of(o.input);
  return record::open_run(trace::load_trace(path), path, o.bodies);
}

/// Returns the event after which the run is shown: --event, or the last event of --step or of the run.
trace::EventId event_of(const ExportOptions& o, const trace::Trace& trace) {
  if (trace.steps.empty() || trace.events.empty())
    throw InputError(printable_name(o.input) + ": the trace has no time steps");
  if (o.event) {
    if (*o.event < trace.events.size()) return *o.event;
    throw InputError("--event " + std::to_string(*o.event) + ": the run has " +
                     std::to_string(trace.events.size()) + " events, numbered from 0");
  }
  const auto at = o.step ? std::find_if(trace.steps.begin(), trace.steps.end(),
                                        [&](const trace::Step& s) { return s.index == *o.step; })
                         : trace.steps.end() - 1;
  if (at == trace.steps.end() || at->first_event >= trace.events.size())
    throw InputError("--step " + std::to_string(o.step.value_or(at == trace.steps.end() ? 0 : at->index)) +
                     ": no such step in the trace; expected one from " +
                     std::to_string(trace.steps.front().index) + " to " +
                     std::to_string(trace.steps.back().index));
  return record::last_event(trace, static_cast<std::size_t>(at - trace.steps.begin()));
}

/// Returns the contact regions of two bodies, independent of the run's request.
std::vector<ContactRegion> contacts_of(const record::Recording& run, const trace::Step& step) {
  CollideRequest request;
  request.contacts = true;
  return collide(run.bodies[0].rep, step.pose_a, run.bodies[1].rep, step.pose_b, request).regions;
}

void set_colours(const ExportOptions& o, exchange::Moment& moment) {
  if (o.picture.colour_by) moment.colour_by = *o.picture.colour_by;
  if (o.picture.colour_per) moment.colour_per = *o.picture.colour_per;
}

exchange::Wanted wanted_of(const ExportOptions& o) {
  exchange::Wanted out;
  out.body = o.asks_for("body");
  out.wrapper = o.asks_for("wrapper");
  out.contacts = o.asks_for("contacts");
  out.side[0] = o.of != "b";
  out.side[1] = o.of != "a";
  return out;
}

void save(const ExportOptions& o, const exchange::Model& model, const Globals& globals) {
  if (model.parts.empty())
    throw InputError(printable_name(o.input) + ": nothing to write: " +
                     (o.asks_for("contacts") ? "the bodies do not intersect at this step" : "no faces"));
  exchange::save_model(model, o.out, o.up[0] - 'x');
  std::size_t cells = 0;
  for (const exchange::Part& part : model.parts) cells += part.cell_count();
  note(globals, {std::to_string(model.parts.size()) + (model.parts.size() == 1 ? " part, " : " parts, ") +
                 std::to_string(cells) + " cells"});
  print(o.out + "\n");
}

std::string title(const std::string& what) {
  return std::string("lrbscope ") + trace::lrbscope_version() + ": " + printable_name(what);
}

void reject(bool given, const char* option, const char* why) {
  if (given) throw InputError(std::string(option) + ": " + why);
}

int export_body(const ExportOptions& given, const Globals& globals) {
  ExportOptions o = given;
  const char* const kNoRun = "needs a run; a body file has neither steps nor a second body";
  reject(o.step.has_value(), "--step", kNoRun);
  reject(o.event.has_value(), "--event", kNoRun);
  reject(o.asks_for("contacts"), "--what contacts", kNoRun);
  reject(o.asks_for("poses"), "--what poses", kNoRun);
  reject(!o.of.empty(), "--of", kNoRun);
  using ColourBy = pictures::FrameSpec::ColourBy;
  reject(o.picture.colour_by.value_or(ColourBy::kind) >= ColourBy::face_tests, "--colour-by",
         "expected kind, layer or region for a body; the other quantities need a run");
  if (o.what.empty()) o.what = {o.chooses_wrapper() ? "wrapper" : "body"};
  const bool needs_regions = o.asks_for("wrapper") || o.picture.colour_by;
  const bodies::LoadedBody body = needs_regions ? bodies::load_body(o.input, with_progress({}, globals.quiet))
                                                : bodies::load_faces(o.input);
  note(globals, body.notes);
  std::optional<Wrapper> wrapper;
  if (o.asks_for("wrapper")) {
    if (o.faces)
      wrapper = resolutions::wrapper_of_faces(body.rep, *o.faces);
    else if (o.tolerance)
      wrapper = bodies::wrapper_at(body.rep, *o.tolerance, 0);
    else
      wrapper = exchange::wrapper_of_layers(body.rep, o.layer.value_or(body.rep.layer_count()));
  }
  exchange::Moment moment;
  moment.title = title(o.input);
  moment.bodies = {{&body.rep, wrapper ? &*wrapper : nullptr, {}, nullptr}};
  set_colours(o, moment);
  save(o, exchange::make_model(moment, wanted_of(o)), globals);
  return kOk;
}

int export_run(const ExportOptions& given, Input kind, const Globals& globals) {
  ExportOptions o = given;
  reject(o.chooses_wrapper(), "--faces, --layer and --tolerance",
         "need a body file; choose a run's wrappers with --event");
  const record::Recording run = open_recording(o, kind, globals);
  note(globals, run.notes);
  const bool two = run.bodies.size() == 2;
  if (o.what.empty()) {
    o.what = {"wrapper"};
    if (two) o.what.emplace_back("contacts");
  }
  reject(!two && o.asks_for("contacts"), "--what contacts", "the run has only one body");
  reject(!two && !o.of.empty(), "--of", "the run has only one body");
  const trace::EventId event = event_of(o, run.trace);
  trace::Cursor cursor = two ? trace::Cursor(run.trace, run.bodies[0].rep, run.bodies[1].rep)
                             : trace::Cursor(run.trace, run.bodies[0].rep);
  cursor.seek(event);
  exchange::Moment moment;
  moment.title = title(run.trace.header.scenario + ", event " + std::to_string(event));
  for (std::size_t i = 0; i < run.bodies.size(); ++i) {
    const Side side = static_cast<Side>(i);
    moment.bodies.push_back({&run.bodies[i].rep, &cursor.wrapper(side), cursor.pose(side),
                             run.trees.empty() ? nullptr : &run.trees[i]});
  }
  const trace::EventId first = cursor.step()->first_event;
  moment.events = std::span(run.trace.events).subspan(first, event + std::size_t{1} - first);
  set_colours(o, moment);
  if (const EventLevel needed = pictures::needed_level(moment.colour_by); needed > run.trace.header.level)
    throw InputError("--colour-by " + std::string(name_of(moment.colour_by)) + ": " +
                     printable_name(o.input) + " lacks the events for it; record the run with --events " +
                     std::string(name_of(needed)));
  std::vector<ContactRegion> contacts;
  if (o.asks_for("contacts")) contacts = contacts_of(run, *cursor.step());
  moment.contacts = contacts;
  save(o, exchange::make_model(moment, wanted_of(o)), globals);
  return kOk;
}

/// Writes the poses of a run's steps, or those of another file.
int export_poses(const ExportOptions& o, Input kind, const Globals& globals) {
  reject(o.what.size() > 1, "--what", "poses need a file of their own");
  std::vector<Pose> poses;
  if (kind == Input::poses) {
    poses = io::open_poses(o.input).poses;
  } else {
    const record::Recording run = open_recording(o, kind, globals);
    const bool of_a = o.of == "a" || run.bodies.size() == 1;
    for (const trace::Step& step : run.trace.steps) poses.push_back(of_a ? step.pose_a : step.pose_b);
  }
  io::save_poses(o.out, poses);
  print(o.out + "\n");
  return kOk;
}

int run_export(const ExportOptions& o, const Globals& globals) {
  const Input kind = kind_of(o);
  if (o.asks_for("poses") && kind != Input::body) return export_poses(o, kind, globals);
  exchange::check_model_file(o.out);
  return kind == Input::body ? export_body(o, globals) : export_run(o, kind, globals);
}

}  // namespace

Command add_export(App& root, const Globals& globals) {
  App* app = root.add_subcommand("export",
                                 "Export bodies, wrappers, contacts or poses to PLY, VTP, GLB, CSV or JSON");
  const auto o = std::make_shared<ExportOptions>();
  app->add_option(
         "INPUT", o->input,
         "Mesh or .lrb file; a run's folder or trace; a scenario; with --what poses also a file of poses")
      ->required();
  app->add_option("-o,--output", o->out, "FILE",
                  "File to write: .ply, .vtp or .glb; poses: .csv, .json or .txt")
      ->required();
  app->add_option("--what", o->what, "body|wrapper|contacts|poses",
                  "Contents of the file [body file: body, or wrapper if one is selected; run: "
                  "wrapper,contacts]")
      ->delimiter(',')
      ->one_of({"body", "wrapper", "contacts", "poses"});
  auto* step = app->add_option("--step", o->step, "N", "Run: state after this time step [the last]");
  app->add_option("--event", o->event, "N", "Run: state after this event")->excludes(step);
  auto* faces =
      app->add_option("--faces", o->faces, "N", "Body: export the finest wrapper with at most N faces");
  auto* layer = app->add_option("--layer", o->layer, "N", "Body: export the wrapper after N build passes")
                    ->excludes(faces);
  app->add_option("--tolerance", o->tolerance, "LENGTH",
                  "Body: export the coarsest wrapper within this maximum deviation")
      ->excludes(faces)
      ->excludes(layer)
      ->not_negative();
  app->add_option("--of", o->of, "a|b", "Export only this body of the two [both; poses: b]")
      ->one_of({"a", "b"});
  app->add_option("--bodies", o->bodies, "FILE", "Bodies of the trace [a.lrb and b.lrb next to it]")
      ->expected(1, 2);
  app->add_option("--up", o->up, "x|y|z", "Axis of the bodies that points up (.glb)")
      ->one_of({"x", "y", "z"})
      ->capture_default_str();
  add_choice<pictures::FrameSpec::ColourBy>(*app, "--colour-by", o->picture.colour_by,
                                            "Quantity that faces are coloured by");
  add_choice<pictures::FrameSpec::ColourPer>(
      *app, "--colour-per", o->picture.colour_per,
      "Colour a face by its own value, or by the sum over its region or level");
  return {app, [o, &globals] { return run_export(*o, globals); }};
}

}  // namespace lrb::tools

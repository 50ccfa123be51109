#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include "scenarios/run/run_page.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/observe.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::python {
namespace {

using RecordedPtr = std::shared_ptr<Recorded>;

std::string title_of(const std::vector<std::shared_ptr<const LrbRep>>& bodies) {
  std::string out;
  for (const auto& rep : bodies) out += (out.empty() ? "" : " and ") + rep->name();
  return out;
}

/// Records a query for each pose of B.
void record(Recorded& to, const Pose& pose_a, const std::vector<Pose>& poses_b,
            const trace::RecorderSettings& settings) {
  const LrbRep &a = *to.bodies[0], &b = *to.bodies[1];
  trace::Recorder recorder(a, b, settings);
  for (std::uint32_t step = 0; step < poses_b.size(); ++step) {
    check_signals();
    recorder.begin_step(step, pose_a, poses_b[step]);
    to.results->push_back(lrb::collide(a, pose_a, b, poses_b[step], settings.request, recorder));
    recorder.end_step(to.results->back());
  }
  to.trace = recorder.take();
  if (settings.level != EventLevel::faces)
    for (const auto& rep : to.bodies) to.trees.emplace_back(rep->tree());
}

RecordedPtr trace_of(const Given& given) {
  auto out = std::make_shared<Recorded>();
  const TwoBodies two(given);
  out->bodies = {two.a.shared(), two.b.shared()};
  out->title = title_of(out->bodies);
  trace::RecorderSettings settings;
  settings.level = word(given["events"], settings.level);
  settings.event_cap = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(count(given["max_events"], settings.event_cap), kMaxId));
  settings.request = request_of(given);
  // Pictures show contacts, which only a request for all pairs returns.
  settings.request.contacts =
      flag(given["contacts"], settings.request.mode == Mode::all_pairs && !settings.request.is_coarse());
  settings.sources = {out->bodies[0]->name(), out->bodies[1]->name()};
  settings.scenario = out->title;
  const py::gil_scoped_release unlocked;
  record(*out, two.pose_a, two.poses_b.to_vector(), settings);
  return out;
}

/// Views events as a numpy record array.
py::array events_of(const py::object& self) {
  const std::vector<trace::Event>& events = self.cast<const Recorded&>().trace.events;
  return view({static_cast<py::ssize_t>(events.size())}, events.data(), self);
}

py::object steps_of(const Recorded& r) {
  py::list rows;
  for (const trace::Step& s : r.trace.steps)
    rows.append(py::make_tuple(s.index, to_string(s.result.relation), s.result.pair_count, s.first_event,
                               s.events_seen, s.result.counters.face_tests, s.result.counters.refinements));
  const py::list type(py::make_tuple(py::make_tuple("index", "u4"), py::make_tuple("relation", "U16"),
                                     py::make_tuple("pairs", "u8"), py::make_tuple("first_event", "u4"),
                                     py::make_tuple("events", "u8"), py::make_tuple("face_tests", "u8"),
                                     py::make_tuple("refinements", "u8")));
  return py::module_::import("numpy").attr("array")(rows, py::arg("dtype") = type);
}

template <class Enum>
py::list names() {
  py::list out;
  for (const auto& entry : kEnumNames<Enum>) out.append(py::str(std::string(entry.name)));
  return out;
}

std::string json_of(const Recorded& r) {
  const py::gil_scoped_release unlocked;
  return trace::trace_to_json(r.trace);
}

py::object summary_of(const Recorded& r) {
  std::vector<trace::SummaryBody> bodies;
  for (std::size_t i = 0; i < r.bodies.size(); ++i)
    bodies.push_back({r.bodies[i].get(), i < r.trees.size() ? &r.trees[i] : nullptr});
  return parsed_json(trace::summary_json(r.trace, bodies));
}

void write_trace(const Recorded& r, const Given& given) {
  const std::string name = path(given["path"]);
  const py::gil_scoped_release unlocked;
  trace::save_trace(r.trace, name);
}

std::string html_of(const Recorded& r) {
  const py::gil_scoped_release unlocked;
  return run::run_page(r.shown(), {}, "", {r.title, r.purpose, "", "the trace"}).html();
}

/// Returns the page in an iframe, so that its style does not affect the notebook.
py::str notebook_html(const Recorded& r) {
  const py::object page = py::module_::import("html").attr("escape")(printable(html_of(r)));
  return py::str("<iframe style=\"width:100%;height:720px;border:0\" srcdoc=\"{}\"></iframe>").format(page);
}

py::object picture(const Recorded& r, const Given& given) {
  const std::size_t n = r.trace.steps.size();
  const Argument step = given["step"];
  const auto i = step.is_none() ? -1 : static_cast<py::ssize_t>(number(step));
  if (n == 0) throw InputError("nothing to draw: the run has no steps");
  return draw(r, checked_index(i, n), given);
}

py::object render_bodies(const Given& given) {
  Recorded r;
  const Argument b = given["b"];
  r.bodies.push_back(body(given["a"]).shared());
  if (!b.is_none()) r.bodies.push_back(body(b).shared());
  const Pose at_b = b.is_none() ? Pose() : pose(given["pose_b"]), at_a = pose(given["pose_a"]);
  r.title = title_of(r.bodies);
  trace::RecorderSettings settings;
  settings.request.contacts = true;
  if (r.bodies.size() == 2) {
    const py::gil_scoped_release unlocked;
    record(r, at_a, {at_b}, settings);
  } else {
    trace::Recorder recorder(*r.bodies[0], settings);
    recorder.begin_step(0, at_a);
    r.trace = recorder.take();
  }
  return draw(r, 0, given);
}

void bind_trace(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(trace::Event, a, b, cause, boundary, depth_a, depth_b, kind, side, meet, detail);
  py::class_<Recorded, RecordedPtr> c(
      m, "Trace",
      R"(A recorded run: every event of its queries. Made by trace() and Scenario.record(). In a notebook: a page
that shows the bodies, rotatable, after any event.)");
  c.def_property_readonly(
      "events", &events_of,
      R"((e,) records of a, b, cause, boundary (uint32), depth_a, depth_b (uint16), kind, side, meet, detail (uint8);
`kind` indexes `kinds` and determines the meaning of a and b (docs/scenarios.md). Shares the trace's memory.)");
  c.attr("kinds") = names<EventKind>();
  py::dict words;  // of parameters, for stub.py
  words["mode"] = names<Mode>();
  words["Wrapper.mode"] = names<WrapperMode>();
  words["recursion"] = names<Recursion>();
  words["events"] = names<EventLevel>();
  words["colour_by"] = names<decltype(pictures::FrameSpec::colour_by)>();
  m.attr("_words") = words;
  c.def_property_readonly(
      "steps", &steps_of,
      "(s,) records of index, relation, pairs, first_event, events, face_tests, refinements.");
  c.def_property_readonly(
      "results",
      [](const Recorded& r) {
        Answers out;
        for (std::size_t i = 0; i < r.results->size(); ++i) {
          const trace::Step& s = r.trace.steps[i];
          out.all.push_back(
              {{r.results, &(*r.results)[i]}, r.bodies[0], r.bodies.back(), s.pose_a, s.pose_b});
        }
        return out;
      },
      "Results: the answers of the steps.");
  c.def_property_readonly(
      "notes", [](const Recorded& r) { return printable(r.notes); }, "list of str: notes as text.");
  define(c,
         "json()\n\nReturns the trace as text that ui.perfetto.dev opens (trace/schema/trace.schema.json).",
         &json_of);
  define(c, "summary()\n\nReturns the run's statistics, a dict with the keys of summary.json.", &summary_of);
  define(c, "save(path)\n\nWrites json(), gzip-compressed if the path ends in .gz.", &write_trace);
  define(c, "html()\n\nReturns the run's page: one file that opens in any browser.",
         [](const Recorded& r) { return printable(html_of(r)); });
  c.def("_repr_html_", &notebook_html);
  c.def("__len__", [](const Recorded& r) { return r.trace.events.size(); });
  c.def("__repr__", [](const Recorded& r) {
    return printable("<lrbscope.Trace of " + r.title + ": " + std::to_string(r.trace.steps.size()) +
                     (r.trace.steps.size() == 1 ? " step, " : " steps, ") +
                     std::to_string(r.trace.events.size()) + " events>");
  });
  define(
      c,
      R"(picture(step=-1, *, size=(960, 720), view_from=None, up=(0, 0, 1), look_at=None, zoom=1, orthographic=False,
        wrappers=False, close_up=False, colour_by='kind', transparent=False)

Draws the end of a step, counted from the end if negative. Options and result as in render().)",
      &picture);
}

/// The results that a run wrote.
struct Outcome {
  std::string folder;
  run::RunOutcome run;
};

std::shared_ptr<Recorded> record_scenario(const spec::Scenario& scenario, const Given& given) {
  const Progress report(given["progress"].given);
  const py::gil_scoped_release unlocked;
  return recorded_of(record::record(scenario, std::ref(report)), scenario);
}

Outcome run_into(const spec::Scenario& scenario, const Given& given) {
  Outcome outcome{path(given["out"]), {}};
  const Progress report(given["progress"].given);
  const py::gil_scoped_release unlocked;
  outcome.run =
      run::run_scenario(scenario, outcome.folder, "lrbscope run " + scenario.name, std::ref(report));
  return outcome;
}

py::list shipped() {
  py::list out;
  for (const std::string& name : spec::shipped_names(spec::kScenarioEnding)) out.append(name);
  return out;
}

void bind_outcome(py::module_& m) {
  py::class_<Outcome> c(m, "Outcome", "What Scenario.run() wrote.");
  property(c, "folder", "str", [](const Outcome& o) { return path_of(o.folder); });
  property(c, "page", "str: path of the run's page.",
           [](const Outcome& o) { return path_of(o.folder + "/index.html"); });
  property(c, "frames", "int: the number of pictures in frames/.",
           [](const Outcome& o) { return o.run.frames; });
  property(c, "mismatches", "list of str: expectations that were not met.",
           [](const Outcome& o) { return printable(o.run.mismatches); });
  property(c, "notes", "list of str: notes as text.",
           [](const Outcome& o) { return printable(o.run.notes); });
  property(c, "summary", "dict: the run's statistics, summary.json.",
           [](const Outcome& o) { return parsed_json(o.run.summary); });
  c.def("__repr__", [](const Outcome& o) { return printable("<lrbscope.Outcome in '" + o.folder + "'>"); });
}

}  // namespace

frames::RecordedRun Recorded::shown() const {
  frames::RecordedRun out;
  out.title = title;
  out.purpose = purpose;
  for (const auto& rep : bodies) out.reps.push_back(rep.get());
  out.trace = &trace;
  out.results = results.get();
  out.trees = &trees;
  return out;
}

std::shared_ptr<Recorded> recorded_of(record::Recording recording, const spec::Scenario& scenario) {
  auto out = std::make_shared<Recorded>();
  for (bodies::LoadedBody& body : recording.bodies)
    out->bodies.push_back(std::make_shared<const LrbRep>(std::move(body.rep)));
  out->trace = std::move(recording.trace);
  *out->results = std::move(recording.results);
  out->trees = std::move(recording.trees);
  out->notes = std::move(recording.notes);
  out->title = scenario.name;
  out->purpose = scenario.purpose;
  return out;
}

void bind_recorded(py::module_& m) {
  bind_trace(m);
  bind_outcome(m);
  define(m, R"(trace(a, b, poses_b=None, pose_a=None, *, events='faces', max_events=1000000, mode='all',
      contacts=None, tolerance=0, max_tests=0, separation=False, recursion='complete')

Records the query of two bodies at each pose, one step per pose: every comparison and every refinement.

poses_b, pose_a: as in collide(). events: 'faces'; 'nodes' adds pairs of tree nodes, phases, points; 'all'
adds pairs of triangles that planes separate. max_events: maximum number stored; further ones are counted.
The rest: as in collide().

Returns a Trace.

>>> t = trace(cube, cube, shifted(0.5, 0.25, 0.125))
>>> t.steps['relation'].tolist()
['crossing']
>>> int(sum(t.events['kind'] == Trace.kinds.index('contact'))) == len(t.results[0].pairs)
True)",
         &trace_of);
  define(m, R"(render(a, b=None, pose_b=None, pose_a=None, *, size=(960, 720), view_from=None, up=(0, 0, 1),
       look_at=None, zoom=1, orthographic=False, wrappers=False, close_up=False, colour_by='kind',
       transparent=False)

Draws one body, or two bodies and their contact.

size: pixels, width and height. view_from: the direction from the bodies to the viewer; None: the one that
hides least of the contact. up: the upward direction in the picture. Directions are (3,) or words such as 'y'
and '-x'. look_at: the point at its centre; zoom: above 1 magnifies. wrappers: show the wrappers that the query used. close_up: show the contact alone.
colour_by: 'kind', 'layer', 'region', 'face_tests', 'refinements', 'hits', 'misses'. transparent: no
background.

Returns a Picture, (height, width, 3) uint8; transparent: (height, width, 4).

>>> render(cube, cube, shifted(0.5, 0.25, 0.125), size=(320, 240)).shape
(240, 320, 3))",
         &render_bodies);
  py::class_<spec::Scenario> c(
      m, "Scenario",
      R"(Two bodies (or one), their motion, the query and the pictures: a shipped scenario, or one from a file.

>>> s = Scenario('collision')
>>> s.name, len(s.purpose) > 0
('collision', True))");
  define_constructor(c,
                     "Scenario(path_or_name)\n\n"
                     "Opens a shipped scenario by its name (see scenarios()), or a file by its path.",
                     [](const Given& given) {
                       const Argument arg = given["path_or_name"];
                       return spec::open_scenario(py::isinstance<py::str>(arg.given) ? text(arg) : path(arg));
                     });
  property(c, "name", "str", &spec::Scenario::name);
  property(c, "purpose", "str: the expected content of the pictures.", &spec::Scenario::purpose);
  define(c,
         "record(*, progress=None)\n\n"
         "Runs the scenario without drawing. progress(what, done, total) is called at intervals. "
         "Returns a Trace.",
         &record_scenario);
  define(c,
         "run(out, *, progress=None)\n\n"
         "Runs the scenario and writes page, frames, trace, statistics and bodies to the folder "
         "`out`. Returns an Outcome.",
         &run_into);
  c.def("__repr__", [](const spec::Scenario& s) { return "<lrbscope.Scenario '" + s.name + "'>"; });
  define(m, "scenarios()\n\nReturns the names of the shipped scenarios.", &shipped);
  m.def("_encode_png", &png_of, py::arg("pixels"));
}

}  // namespace lrb::python

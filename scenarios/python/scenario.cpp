#include "scenarios/python/scenario.hpp"

#include "scenarios/python/batch.hpp"
#include "scenarios/python/picture.hpp"
#include "scenarios/python/recorded.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/shipped.hpp"

namespace lrb::python {
namespace {

/// What a run wrote.
struct Outcome {
  std::string folder;
  run::RunOutcome run;
};

/// Returns what tells `progress`, a callable or None, how far a job is. Lets Ctrl-C end it in any case.
run::ProgressReport report_to(const py::object& progress) {
  const bool told = !progress.is_none();
  if (told && !PyCallable_Check(progress.ptr()))
    throw py::type_error("progress: expected a callable, got " + described(progress));
  // A plain pointer, because copies are made and destroyed without the lock; the caller's argument keeps it
  // alive.
  PyObject* const callee = progress.ptr();
  return [told, callee](const std::string& what, std::uint64_t done, std::uint64_t total) {
    check_signals();
    if (!told) return;
    const py::gil_scoped_acquire lock;
    const py::handle call(callee);
    call(what, done, total);
  };
}

std::shared_ptr<Recorded> record_scenario(const spec::Scenario& scenario, const py::object& progress) {
  const run::ProgressReport report = report_to(progress);
  const py::gil_scoped_release unlocked;
  return recorded_of(run::record(scenario, report), scenario);
}

Outcome run_into(const spec::Scenario& scenario, py::handle out, const py::object& progress) {
  Outcome outcome{path(out, "out"), {}};
  const run::ProgressReport report = report_to(progress);
  const py::gil_scoped_release unlocked;
  outcome.run = run::run_scenario(scenario, outcome.folder, "lrbscope run " + scenario.name, report);
  return outcome;
}

py::list shipped() {
  py::list out;
  for (const std::string& name : spec::shipped_names(spec::kScenarioEnding)) out.append(name);
  return out;
}

void bind_outcome(py::module_& m) {
  py::class_<Outcome> c(m, "Outcome", "What Scenario.run() wrote.");
  c.def_property_readonly(
      "folder", [](const Outcome& o) { return path_of(o.folder); }, "str");
  c.def_property_readonly(
      "page", [](const Outcome& o) { return path_of(o.folder + "/index.html"); },
      "str: the run's page, for a browser.");
  c.def_property_readonly(
      "frames", [](const Outcome& o) { return o.run.frames; }, "int: the number of pictures in frames/.");
  c.def_property_readonly(
      "mismatches", [](const Outcome& o) { return printable(o.run.mismatches); },
      "list of str: expectations that were not met.");
  c.def_property_readonly(
      "notes", [](const Outcome& o) { return printable(o.run.notes); }, "list of str: for people.");
  c.def_property_readonly(
      "summary", [](const Outcome& o) { return py::module_::import("json").attr("loads")(o.run.summary); },
      "dict: the run in numbers, summary.json.");
  c.def("__repr__", [](const Outcome& o) { return printable("<lrbscope.Outcome in '" + o.folder + "'>"); });
}

}  // namespace

void bind_scenario(py::module_& m) {
  bind_outcome(m);
  py::class_<spec::Scenario> c(
      m, "Scenario",
      R"(Two bodies (or one), how they move, what is asked and drawn: a shipped scenario, or one from a file.

>>> s = Scenario('collision')
>>> s.name, len(s.purpose) > 0
('collision', True))");
  c.def(
      py::init([](py::handle given) {
        return spec::open_scenario(py::isinstance<py::str>(given) ? text(given, "scenario")
                                                                  : path(given, "scenario"));
      }),
      py::arg("path_or_name"),
      "Scenario(path_or_name)\n\nOpens a shipped scenario by its name (scenarios()), or a file by its path.");
  c.def_property_readonly(
      "name", [](const spec::Scenario& s) { return s.name; }, "str");
  c.def_property_readonly(
      "purpose", [](const spec::Scenario& s) { return s.purpose; }, "str: what the pictures should show.");
  c.def("record", &record_scenario, py::kw_only(), py::arg("progress") = py::none(),
        "record(*, progress=None)\n\nRuns the scenario and draws nothing. progress(what, done, "
        "total): is called now and then. Returns a Trace.");
  c.def("run", &run_into, py::arg("out"), py::kw_only(), py::arg("progress") = py::none(),
        "run(out, *, progress=None)\n\nRuns the scenario and writes page, frames, trace, numbers and "
        "bodies into the folder `out`. Returns an Outcome.");
  c.def("__repr__", [](const spec::Scenario& s) { return "<lrbscope.Scenario '" + s.name + "'>"; });
  m.def("scenarios", &shipped, "scenarios()\n\nReturns the names of the scenarios that lrbscope ships.");
  m.def("_encode_png", &png_of, py::arg("pixels"));
}

}  // namespace lrb::python

#include <string>

#include "python/src/arguments.hpp"
#include "python/src/objects.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::python {
namespace {

/// Throws TypeError instead of allocating. pybind11 allocates when an object without a value is first used,
/// such as one made by __new__ alone; objects made by __init__ or __setstate__ have their own memory.
void* reject_memory(std::size_t) {
  throw py::type_error(
      "expected an object that its class has initialized, found one that only __new__ made; call the class");
}

/// Makes every use of an object without a value a TypeError, for all classes of the module.
void reject_objects_without_value(const py::module_& m) {
  for (const auto& [name, member] : m.attr("__dict__").cast<py::dict>())
    if (PyType_Check(member.ptr()) != 0)
      if (auto* const info = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(member.ptr())))
        info->operator_new = reject_memory;
}

/// Makes pickling and copying raise a TypeError that names what to keep instead, for classes that are not
/// data.
void reject_pickles(const py::module_& m) {
  constexpr const char* kInstead[][2] = {
      {"Scene", "keep its bodies and poses, body(key) and pose(key), and add them to another"},
      {"CoherentQuery", "make another of its bodies a and b; only its cache is lost"},
      {"Wrapper", "keep its body, and refine `excluded` in another"},
      {"Trace", "keep json(), or save() it"},
      {"Scenario", "open it again by its name or path"},
      {"Outcome", "keep its folder and summary"},
      {"PairExplanation", "keep dict() or str() of it"},
      {"WalkExplanation", "keep dict() or str() of it"}};
  for (const auto& [name, instead] : kInstead) {
    const std::string text = std::string("a ") + name + " cannot be copied or pickled: " + instead;
    m.attr(name).attr("__reduce__") = py::cpp_function(
        [text](const py::object&) -> py::object { throw py::type_error(text); }, py::is_method(m.attr(name)));
  }
}

PyObject* input_error = nullptr;  // live as long as the module
PyObject* environment_error = nullptr;

/// Raises lrbscope's exceptions as the module's Python exceptions. Messages may contain file names that are
/// not UTF-8.
void raise(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& e) {
    PyErr_SetObject(input_error, printable(e.what()).ptr());
  } catch (const EnvironmentError& e) {
    PyErr_SetObject(environment_error, printable(e.what()).ptr());
  }
}

void bind_exceptions(py::module_& m) {
  py::exception<InputError> input(m, "InputError", PyExc_ValueError);
  input.doc() =
      R"(Raised for invalid input. The message is one line that names the argument, file or element.)";
  py::exception<EnvironmentError> environment(m, "EnvironmentError", PyExc_OSError);
  environment.doc() = "Raised when the machine cannot do what was requested: a full disk, a missing font.";
  input_error = input.release().ptr();
  environment_error = environment.release().ptr();
  py::register_exception_translator(&raise);
}

}  // namespace
}  // namespace lrb::python

PYBIND11_MODULE(_core, m) {
  namespace py = pybind11;
  using namespace lrb::python;
  py::options options;
  options
      .disable_function_signatures();  // docstrings begin with signatures that show the user-visible defaults
  m.doc() = "The engine of lrbscope. Use the package lrbscope.";
  m.attr("__version__") = lrb::trace::lrbscope_version();
  bind_exceptions(m);
  bind_body(m);
  bind_answers(m);
  bind_collide(m);
  bind_distances(m);
  bind_rows(m);
  bind_scene(m);
  bind_explain(m);
  bind_wrapper(m);
  bind_recorded(m);
  m.def("_numbers", [](py::handle given, const std::string& what, const std::vector<py::ssize_t>& shape) {
    return numbers({given, what.c_str()}, shape).attr("copy")();
  });
  m.def("_integers", [](py::handle given, const std::string& what, const std::vector<py::ssize_t>& shape) {
    return integers({given, what.c_str()}, shape).attr("copy")();
  });
  reject_objects_without_value(m);
  reject_pickles(m);
}

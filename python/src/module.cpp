#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <utility>

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

PyCFunctionWithKeywords dispatch = nullptr;  // of pybind11, for all functions

/// Functions of the module by the first argument of `dispatch`. They live as long as the module.
std::map<PyObject*, PyObject*>& functions() {
  static std::map<PyObject*, PyObject*> all;
  return all;
}

/// Calls a function. Arguments that do not fit raise a TypeError of one line, instead of pybind11's list of
/// signatures.
PyObject* call(PyObject* self, PyObject* arguments, PyObject* keywords) {
  PyObject* const out = dispatch(self, arguments, keywords);
  if (out != nullptr || PyErr_ExceptionMatches(PyExc_TypeError) == 0) return out;
  const py::error_already_set error;
  const std::string message = py::str(error.value());
  if (message.find("(): incompatible ") == std::string::npos) {
    py::error_already_set(error).restore();
    return nullptr;
  }
  const auto positional = py::reinterpret_borrow<py::args>(arguments);
  const auto named = keywords != nullptr ? py::reinterpret_borrow<py::kwargs>(keywords) : py::kwargs();
  std::string wrong;
  try {
    const auto inspect = py::module_::import("inspect");
    const py::object signature = inspect.attr("signature")(py::handle(functions().at(self)));
    signature.attr("bind")(*positional, **named);
    wrong = "expected " + std::string(py::str(signature)) + ", got an argument of another type";
  } catch (const py::error_already_set& e) {
    wrong = py::str(e.value());
  }
  std::string name = message.substr(0, message.find('('));
  if (name == "__init__") name = py::str(py::type::of(positional[0]).attr("__name__"));
  PyErr_SetString(PyExc_TypeError, (name + "(): " + wrong).c_str());
  return nullptr;
}

/// Turns "name(a, b=None)", with which a docstring begins, into the form from which inspect and IPython read
/// a signature: "name(self, a, b=None)" and a line "--". Python then shows the rest as __doc__.
void state_signature(PyObject* member) {
  const bool is_method = PyInstanceMethod_Check(member) != 0;
  PyObject* const function = is_method ? PyInstanceMethod_GET_FUNCTION(member) : member;
  if (PyCFunction_Check(function) == 0 || functions().count(PyCFunction_GET_SELF(function)) != 0) return;
  PyMethodDef& def = *reinterpret_cast<PyCFunctionObject*>(function)->m_ml;
  if (def.ml_doc == nullptr) return;
  const std::string text = def.ml_doc;
  const std::size_t open = text.find('('), end = text.find(")\n\n");
  if (open == std::string::npos || end == std::string::npos || text.find_first_of(" \n") < open) return;
  std::string arguments = text.substr(open + 1, end - open - 1);
  if (is_method) arguments = arguments.empty() ? "self" : "self, " + arguments;
  const std::string stated = std::string(def.ml_name) + "(" + arguments + ")\n--\n" + text.substr(end + 1);
  char* const copy = strdup(stated.c_str());  // pybind11 frees it
  std::free(const_cast<char*>(def.ml_doc));
  def.ml_doc = copy;
  dispatch = reinterpret_cast<PyCFunctionWithKeywords>(reinterpret_cast<void (*)()>(
      std::exchange(def.ml_meth, reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&call)))));
  functions().emplace(PyCFunction_GET_SELF(function), function);
}

/// Gives functions, constructors and methods of the module signatures, and errors that use them.
void state_signatures(const py::module_& m) {
  for (const auto& [name, member] : m.attr("__dict__").cast<py::dict>()) {
    state_signature(member.ptr());
    if (PyType_Check(member.ptr()) == 0) continue;
    for (const auto& [own, item] : py::dict(member.attr("__dict__")))
      state_signature(py::isinstance<py::staticmethod>(item) ? py::object(item.attr("__func__")).ptr()
                                                             : item.ptr());
  }
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
  bind_distance(m);
  bind_near_pairs(m);
  bind_contact_manifolds(m);
  bind_self_intersections(m);
  bind_signed_distance(m);
  bind_first_contact(m);
  bind_clash(m);
  bind_scene(m);
  bind_coherent(m);
  bind_explain(m);
  bind_wrapper(m);
  bind_recorded(m);
  bind_scenario(m);
  m.def("_numbers", [](py::handle given, const std::string& what, const std::vector<py::ssize_t>& shape) {
    return numbers(given, what.c_str(), shape).attr("copy")();
  });
  m.def("_integers", [](py::handle given, const std::string& what, const std::vector<py::ssize_t>& shape) {
    return integers(given, what.c_str(), shape).attr("copy")();
  });
  reject_objects_without_value(m);
  reject_pickles(m);
  state_signatures(m);
}

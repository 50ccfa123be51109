#include "scenarios/python/answers.hpp"
#include "scenarios/python/body.hpp"
#include "scenarios/python/boxes.hpp"
#include "scenarios/python/clash.hpp"
#include "scenarios/python/coherent.hpp"
#include "scenarios/python/collide.hpp"
#include "scenarios/python/distance.hpp"
#include "scenarios/python/explain.hpp"
#include "scenarios/python/first_contact.hpp"
#include "scenarios/python/recorded.hpp"
#include "scenarios/python/scenario.hpp"
#include "scenarios/python/scene.hpp"
#include "scenarios/python/wrapper.hpp"
#include "trace/trace.hpp"

PYBIND11_MODULE(_core, m) {
  namespace py = pybind11;
  using namespace lrb::python;
  py::options options;
  options.disable_function_signatures();  // docstrings begin with them, with the defaults that users see
  m.doc() = "The engine of lrbscope. Use the package lrbscope.";
  m.attr("__version__") = lrb::trace::lrbscope_version();
  py::register_exception<lrb::InputError>(m, "InputError", PyExc_ValueError).doc() =
      "Raised for input that cannot be used: one line that names the argument, file or element.";
  py::register_exception<lrb::EnvironmentError>(m, "EnvironmentError", PyExc_OSError).doc() =
      "Raised when the machine cannot do what is asked: a full disk, a missing font.";
  bind_body(m);
  bind_answers(m);
  bind_collide(m);
  bind_distance(m);
  bind_first_contact(m);
  bind_clash(m);
  bind_scene(m);
  bind_coherent(m);
  bind_explain(m);
  bind_wrapper(m);
  bind_boxes(m);
  bind_recorded(m);
  bind_scenario(m);
}

#pragma once

#include <pybind11/pybind11.h>

namespace lrb::python {

namespace py = pybind11;

// Each binds one subject. module.cpp calls them in an order that defines each class before its first use.
void bind_answers(py::module_& m);
void bind_body(py::module_& m);
/// Binds the parts of managers of many objects: boxes of bodies, and their overlapping pairs.
void bind_boxes(py::module_& m);
void bind_clash(py::module_& m);
void bind_coherent(py::module_& m);
void bind_collide(py::module_& m);
void bind_distance(py::module_& m);
void bind_signed_distance(py::module_& m);
void bind_near_pairs(py::module_& m);
void bind_contact_manifolds(py::module_& m);
void bind_self_intersections(py::module_& m);
void bind_explain(py::module_& m);
void bind_first_contact(py::module_& m);
void bind_recorded(py::module_& m);
void bind_scenario(py::module_& m);
void bind_scene(py::module_& m);
void bind_wrapper(py::module_& m);

}  // namespace lrb::python

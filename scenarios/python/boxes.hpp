#pragma once

#include "scenarios/python/arguments.hpp"

namespace lrb::python {

/// Binds what managers of many objects are made of: boxes of bodies, and which of them meet.
void bind_boxes(py::module_& m);

}  // namespace lrb::python

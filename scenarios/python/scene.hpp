#pragma once

#include "scenarios/python/arguments.hpp"

namespace lrb::python {

void bind_scene(py::module_& m);

}  // namespace lrb::python

#pragma once

#include "scenarios/python/arguments.hpp"

namespace lrb::python {

void bind_scenario(py::module_& m);

}  // namespace lrb::python

#pragma once

#include "scenarios/python/arguments.hpp"

namespace lrb::python {

void bind_coherent(py::module_& m);

}  // namespace lrb::python

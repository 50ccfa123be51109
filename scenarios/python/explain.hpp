#pragma once

#include "scenarios/python/arguments.hpp"

namespace lrb::python {

void bind_explain(py::module_& m);

}  // namespace lrb::python

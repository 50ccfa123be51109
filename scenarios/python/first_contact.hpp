#pragma once

#include "scenarios/python/arguments.hpp"

namespace lrb::python {

void bind_first_contact(py::module_& m);

}  // namespace lrb::python

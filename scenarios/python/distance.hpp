#pragma once

#include "engine/query/distance/distance.hpp"
#include "scenarios/python/arguments.hpp"

namespace lrb::python {

/// Returns a distance as Python has it.
py::object distance_object(DistanceResult result);

void bind_distance(py::module_& m);

}  // namespace lrb::python

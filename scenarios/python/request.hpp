#pragma once

#include "engine/query/walk/request.hpp"
#include "scenarios/python/arguments.hpp"

namespace lrb::python {

/// What can be asked for by name, in the order in which functions take it. None: as CollideRequest has it.
struct RequestArguments {
  py::handle mode, contacts, interiors_overlap, tolerance, max_tests, max_time, separation, max_pairs,
      recursion;
};

CollideRequest request_of(const RequestArguments& given);

}  // namespace lrb::python

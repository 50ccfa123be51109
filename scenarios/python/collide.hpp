#pragma once

#include "engine/query/batch/batch.hpp"
#include "scenarios/python/arguments.hpp"

namespace lrb::python {

/// Asks about pairs of bodies without the lock of Python, as run_batch() does.
std::vector<CollideResult> answers_of(std::span<const PosedPair> pairs, const CollideRequest& request,
                                      unsigned threads);

void bind_collide(py::module_& m);

}  // namespace lrb::python

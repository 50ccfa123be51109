#pragma once

#include <memory>
#include <vector>

#include "engine/query/collide.hpp"
#include "scenarios/python/body.hpp"

namespace lrb::python {

/// One answer, with the bodies that it is about.
struct Answer {
  std::shared_ptr<const CollideResult> result;
  std::shared_ptr<const LrbRep> a, b;
};

/// Answers for many poses, in their order.
struct Answers {
  std::shared_ptr<const std::vector<CollideResult>> all;
  std::shared_ptr<const LrbRep> a, b;

  Answer at(std::size_t i) const { return {{all, &(*all)[i]}, a, b}; }
};

/// Returns an element of a list-like object as Python counts, from the end if negative; throws IndexError.
std::size_t checked_index(py::ssize_t i, std::size_t n);

/// Returns contact regions as Python has them.
py::list regions_of(const Answer& answer);

void bind_answers(py::module_& m);

}  // namespace lrb::python

#pragma once

#include <array>
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

/// Answers in the order of the questions: for many poses of two bodies, or for many pairs.
struct Answers {
  std::shared_ptr<const std::vector<CollideResult>> all;
  std::shared_ptr<const LrbRep> a, b;
  /// The bodies of each answer, where these differ; a and b are nothing then.
  std::vector<std::array<std::shared_ptr<const LrbRep>, 2>> each;

  Answer at(std::size_t i) const {
    return each.empty() ? Answer{{all, &(*all)[i]}, a, b} : Answer{{all, &(*all)[i]}, each[i][0], each[i][1]};
  }
};

/// Returns true if bodies are known to have a point in common.
bool in_contact(const CollideResult& r);

/// Returns an element of a list-like object as Python counts, from the end if negative; throws IndexError.
std::size_t checked_index(py::ssize_t i, std::size_t n);

/// Returns contact regions as Python has them.
py::list regions_of(const Answer& answer);

void bind_answers(py::module_& m);

}  // namespace lrb::python

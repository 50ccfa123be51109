#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "python/src/arguments.hpp"
#include "python/src/objects.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/workspace.hpp>

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

/// Gives a list-like class its iterator, without which types and isinstance() do not take it for iterable.
template <class Class>
void bind_iterator(Class& c) {
  c.def("__iter__", [](const py::object& self) {
    self.cast<const typename Class::type&>();  // raises TypeError for an object without a value
    return py::reinterpret_steal<py::object>(PySeqIter_New(self.ptr()));
  });
}

/// Returns contact regions as Python has them.
py::list regions_of(const Answer& answer);

/// Returns the number of threads that an argument stands for: 0 as many as the machine runs at once, but one
/// in a process that was forked from the one that loaded the module. Threads do not survive a fork, and who
/// forks has processes for all cores.
unsigned threads_of(std::size_t asked);

/// Calls work(i, worker) for i = 0 .. n - 1 on threads_of(asked) threads without the lock of Python, which
/// must be held when this is called. Looks for signals meanwhile: after Ctrl-C calls that have not begun are
/// left out, and KeyboardInterrupt comes out.
void run_batch(std::size_t n, unsigned threads,
               const std::function<void(std::size_t i, unsigned worker)>& work);

/// Returns the memory that single queries of the calling thread reuse.
Workspace& own_workspace();

/// Throws what signal handlers raised, such as KeyboardInterrupt. Takes the lock of Python.
void check_signals();

/// Asks about pairs of bodies without the lock of Python, as run_batch() does.
std::vector<CollideResult> answers_of(std::span<const PosedPair> pairs, const CollideRequest& request,
                                      unsigned threads);

/// Returns a distance as Python has it.
py::object distance_object(DistanceResult result);

/// What can be asked for by name, in the order in which functions take it. None: as CollideRequest has it.
struct RequestArguments {
  py::handle mode, contacts, interiors_overlap, tolerance, max_tests, max_time, separation, max_pairs,
      recursion;
};

CollideRequest request_of(const RequestArguments& given);

}  // namespace lrb::python

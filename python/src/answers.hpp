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

/// One answer, with its bodies.
struct Answer {
  std::shared_ptr<const CollideResult> result;
  std::shared_ptr<const LrbRep> a, b;
};

/// Answers in the order of the queries: for many poses of two bodies, or for many pairs.
struct Answers {
  std::shared_ptr<const std::vector<CollideResult>> all;
  std::shared_ptr<const LrbRep> a, b;
  /// The bodies of each answer if they differ; a and b are null then.
  std::vector<std::array<std::shared_ptr<const LrbRep>, 2>> each;

  Answer at(std::size_t i) const {
    return each.empty() ? Answer{{all, &(*all)[i]}, a, b} : Answer{{all, &(*all)[i]}, each[i][0], each[i][1]};
  }
};

/// Returns true if bodies are known to have a point in common.
bool in_contact(const CollideResult& r);

/// Returns an index as Python counts, from the end if negative. Throws IndexError if it is out of range.
std::size_t checked_index(py::ssize_t i, std::size_t n);

/// Adds an iterator to a list-like class. Type checkers and isinstance() require one for iterables.
template <class Class>
void bind_iterator(Class& c) {
  c.def("__iter__", [](const py::object& self) {
    self.cast<const typename Class::type&>();  // raises TypeError for an object without a value
    return py::reinterpret_steal<py::object>(PySeqIter_New(self.ptr()));
  });
}

/// Returns contact regions as Python objects.
py::list regions_of(const Answer& answer);

/// Returns the number of threads for an argument: 0 is the hardware's number, but 1 in a process forked from
/// the one that loaded the module. Threads do not survive a fork, and a program that forks uses processes for
/// all cores.
unsigned threads_of(std::size_t requested);

/// Calls work(i, worker) for i = 0 .. n - 1 on threads_of(requested) threads without the GIL, which the
/// caller must hold. Checks for signals meanwhile: after Ctrl-C, calls that have not started are skipped and
/// KeyboardInterrupt is raised.
void run_batch(std::size_t n, unsigned threads,
               const std::function<void(std::size_t i, unsigned worker)>& work);

/// Returns the workspace that single queries of the calling thread reuse. `threads`: of one query.
Workspace& own_workspace(unsigned threads = 1);

/// Throws exceptions raised by signal handlers, such as KeyboardInterrupt. Acquires the GIL.
void check_signals();

/// Reports progress to a callable, which gets (what, done, total); to a bar of tqdm for True; or not for
/// None. The GIL must be held where this is made and destroyed.
class Progress {
 public:
  explicit Progress(const py::object& progress);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports, and checks for signals in any case. Acquires the GIL. total: 0 if unknown.
  void operator()(const std::string& what, std::uint64_t done, std::uint64_t total) const;

 private:
  py::object callee_;
  bool is_bar_ = false;
};

/// Queries pairs of bodies without the GIL, as run_batch() does.
std::vector<CollideResult> answers_of(std::span<const PosedPair> pairs, const CollideRequest& request,
                                      unsigned threads);

/// Returns a distance as a Python object.
py::object distance_object(DistanceResult result);

/// The query's keyword arguments, in the order of the functions' parameters. None: the default of
/// CollideRequest.
struct RequestArguments {
  py::handle mode, contacts, interiors_overlap, tolerance, max_tests, max_time, separation, max_pairs,
      recursion;
};

CollideRequest request_of(const RequestArguments& given);

}  // namespace lrb::python

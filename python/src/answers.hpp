#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::python {

/// Normal and depth of a contact region, from the contact manifolds of its pairs.
struct RegionDepth {
  Eigen::Vector3d normal;
  double depth;
};

/// One answer, with its bodies and their poses.
struct Answer {
  std::shared_ptr<const CollideResult> result;
  std::shared_ptr<const LrbRep> a, b;  ///< null in a process that the answer was sent to
  Pose pose_a, pose_b;
  /// What depends on the bodies, after the first request: of the regions, and of the pairs of triangles.
  std::vector<RegionDepth> depths = {};
  std::vector<std::array<FaceId, 2>> faces = {};
};

void members(Archive& archive, Answer& x);

/// Answers in the order of the queries: for many poses of two bodies, or for many pairs.
struct Answers : Sequence<Answer> {};

/// Adds results to answers that have none yet, in their order.
std::vector<Answer> with_results(std::vector<Answer> answers, std::vector<CollideResult> results);

/// Returns true if bodies are known to have a point in common.
bool in_contact(const CollideResult& r);

/// Finds normal and depth of each contact region of an answer, by another query. Needs no GIL.
void find_depths(Answer& answer);

/// Returns contact regions as Python objects.
py::list regions_of(Answer& answer);

/// Returns the number of threads for an argument: 0 is the hardware's number, but 1 in a process forked from
/// the one that loaded the module. Threads do not survive a fork, and a program that forks uses processes for
/// all cores.
unsigned threads_of(std::size_t requested);
inline unsigned threads_of(const Given& given) {
  return threads_of(count(given["threads"]));
}

/// Calls work(i, worker) for i = 0 .. n - 1 on threads_of(requested) threads without the GIL, which the
/// caller must hold. Checks for signals meanwhile: after Ctrl-C, calls that have not started are skipped and
/// KeyboardInterrupt is raised.
void run_batch(std::size_t n, unsigned threads,
               const std::function<void(std::size_t i, unsigned worker)>& work);

/// Answers queries 0 .. n - 1 by ask(i, workspace of the thread), which returns an Expected, as run_batch()
/// does.
template <class Result, class Ask>
std::vector<Result> ask_each(std::size_t n, unsigned threads, const Ask& ask) {
  std::vector<Result> results(n);
  std::vector<Workspace> workspaces(threads);
  run_batch(n, threads, [&](std::size_t i, unsigned worker) {
    results[i] = std::move(ask(i, workspaces[worker]).value());
  });
  return results;
}

/// Answers ask(pose of B, workspace) for each pose, as ask_each() does.
template <class Result, class Ask>
std::vector<Result> ask_poses(const Poses& at, const Given& given, const Ask& ask) {
  const std::vector<Pose> all = at.to_vector();
  return ask_each<Result>(all.size(), at.one ? 1 : threads_of(given),
                          [&](std::size_t i, Workspace& memory) { return ask(all[i], memory); });
}

/// Returns the workspace that single queries of the calling thread reuse. `threads`: of one query.
Workspace& own_workspace(unsigned threads = 1);

/// Throws exceptions raised by signal handlers, such as KeyboardInterrupt. Acquires the GIL.
void check_signals();

/// Reports progress to a callable, which gets (what, done, total); to a bar of tqdm for True; or not for
/// None. The GIL must be held where this is made and destroyed.
class Progress {
 public:
  explicit Progress(py::handle progress);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Reports, and checks for signals in any case. Acquires the GIL. total: 0 if unknown.
  void operator()(const std::string& what, std::uint64_t done, std::uint64_t total) const;

 private:
  py::object callee_;
  bool is_bar_ = false;
};

/// Queries the bodies of answers that have no results yet without the GIL, as run_batch() does.
std::vector<CollideResult> results_of(const std::vector<Answer>& answers, const CollideRequest& request,
                                      unsigned threads);

/// Reads the request of a query from those of its arguments that the function has.
CollideRequest request_of(const Given& given);

}  // namespace lrb::python

#include <map>
#include <mutex>

#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include <lrbscope/coherent.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/trace/answer_fields.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::python {
namespace {

/// The Python class CoherentQuery, with its bodies.
struct QueryHandle {
  QueryHandle(BodyPtr of_a, BodyPtr of_b, const CollideRequest& request, CoherentQuery::CacheUse use)
      : a(std::move(of_a)), b(std::move(of_b)), query(a->rep(), b->rep(), request, use) {}

  BodyPtr a, b;
  CoherentQuery query;
  std::mutex mutex;  ///< used by one thread at a time
};
using QueryHandlePtr = std::shared_ptr<QueryHandle>;

QueryHandlePtr make(const Given& given) {
  const CollideRequest request = request_of(given);
  const auto use =
      flag(given["always"]) ? CoherentQuery::CacheUse::always : CoherentQuery::CacheUse::as_it_pays;
  return std::make_shared<QueryHandle>(shared_body(given["a"]), shared_body(given["b"]), request, use);
}

Answer collide_next(QueryHandle& self, const Given& given) {
  const Pose at_a = pose(given["pose_a"]), at_b = pose(given["pose_b"]);
  auto result = std::make_shared<CollideResult>();
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock(self.mutex);
    *result = self.query.collide(at_a, at_b);
  }
  return {std::move(result), self.a->shared(), self.b->shared(), at_a, at_b};
}

py::dict statistics(QueryHandle& self) {
  CoherentQuery::Statistics s;
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard lock(self.mutex);
    s = self.query.statistics();
  }
  return dict_of(s);
}

constexpr const char* kCoherentText =
    R"(CoherentQuery(a, b, *, mode='all', contacts=False, interiors_overlap=False, max_pairs=0, always=False)

Queries two bodies repeatedly while they move little between calls. Caches the candidate pairs near the last
poses and tests only these. Answers equal those of collide(); with mode 'first' or 'any' the pair may differ.

For the options see collide(). always: use the cache even when uncached queries are measured to be faster (for
tests).

>>> q = CoherentQuery(cube, cube)
>>> [q.collide(shifted(x, 0.25, 0.125)).relation for x in (0.5, 0.51, 1.5)]
['crossing', 'crossing', 'separate'])";

void bind_coherent(py::module_& m) {
  py::class_<QueryHandle, QueryHandlePtr> c(m, "CoherentQuery", kCoherentText);
  define_constructor(c, kCoherentText, &make);
  define(c,
         "collide(pose_b=None, pose_a=None)\n\n"
         "Returns the Result for these poses, (4, 4); None: the identity.",
         &collide_next);
  c.def("__repr__", [](const QueryHandle& q) {
    return printable("<lrbscope.CoherentQuery of '" + q.a->rep().name() + "' and '" + q.b->rep().name() +
                     "'>");
  });
  c.def_property_readonly(
      "statistics", &statistics,
      R"(dict of int: queries answered from_cache, caches_made for a query (swept_caches of them for a motion),
queries from_scratch, tests_saved, coarsened regions of wrappers that the paper's recursion keeps.)");
  property(c, "a", "Body", &QueryHandle::a);
  property(c, "b", "Body", &QueryHandle::b);
}

/// Answers a query with its own memory. Throws InputError if the query is rejected.
CollideResult ask(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const CollideRequest& request, Workspace& workspace) {
  return std::move(lrb::collide(a, pose_a, b, pose_b, request, workspace).value());
}

py::object answers_to(const Given& given, const CollideRequest& request) {
  const TwoBodies two(given);
  const unsigned threads = threads_of(given);
  const auto answer = [&](const Pose& pose_b) {
    return Answer{nullptr, two.a.shared(), two.b.shared(), two.pose_a, pose_b};
  };
  if (two.poses_b.one) {
    Answer found = answer(two.pose_b());
    auto result = std::make_shared<CollideResult>();
    {
      const py::gil_scoped_release unlocked;
      *result = ask(two.a.rep(), two.pose_a, two.b.rep(), two.pose_b(), request, own_workspace(threads));
    }
    found.result = std::move(result);
    return py::cast(std::move(found));
  }
  std::vector<Answer> answers;
  for (const Pose& pose_b : two.poses_b.many) answers.push_back(answer(pose_b));
  auto results = ask_poses<CollideResult>(two.poses_b, given, [&](const Pose& pose_b, Workspace& memory) {
    return lrb::collide(two.a.rep(), two.pose_a, two.b.rep(), pose_b, request, memory);
  });
  return py::cast(Answers{with_results(std::move(answers), std::move(results))});
}

/// A sequence of bodies with their poses.
struct Row {
  std::vector<std::shared_ptr<const LrbRep>> reps;
  std::vector<Pose> poses;
};

Row row_of(const Argument& bodies, const Argument& given) {
  Row out;
  if (!py::isinstance<py::sequence>(bodies.given))
    throw py::type_error(std::string(bodies.name) + ": expected a sequence of bodies, got " +
                         described(bodies.given));
  for (const py::handle one : bodies.given) out.reps.push_back(body({one, bodies.name}).shared());
  out.poses = poses(given).to_vector();
  if (out.poses.size() != out.reps.size())
    throw InputError(std::string(given.name) + ": expected as many as " + bodies.name + ", " +
                     std::to_string(out.reps.size()) + ", got " + std::to_string(out.poses.size()));
  return out;
}

std::vector<Answer> collide_pairs(const Given& given) {
  const Row a = row_of(given["bodies_a"], given["poses_a"]), b = row_of(given["bodies_b"], given["poses_b"]);
  if (a.reps.size() != b.reps.size())
    throw InputError("bodies_b: expected as many as bodies_a, " + std::to_string(a.reps.size()) + ", got " +
                     std::to_string(b.reps.size()));
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < a.reps.size(); ++i)
    answers.push_back({nullptr, a.reps[i], b.reps[i], a.poses[i], b.poses[i]});
  std::vector<CollideResult> results = results_of(answers, request_of(given), threads_of(given));
  return with_results(std::move(answers), std::move(results));
}

py::object collide(const Given& given) {
  return answers_to(given, request_of(given));
}

py::object contacts(const Given& given) {
  CollideRequest request = request_of(given);
  request.contacts = true;
  const py::object found = answers_to(given, request);
  if (py::isinstance<Answer>(found)) return regions_of(found.cast<Answer&>());
  std::vector<Answer>& each = found.cast<Answers&>().all;
  run_batch(each.size(), threads_of(given), [&](std::size_t i, unsigned) { find_depths(each[i]); });
  py::list out;
  for (Answer& answer : each) out.append(regions_of(answer));
  return out;
}

constexpr const char* kCollideText =
    R"(collide(a, b, poses_b=None, pose_a=None, *, mode='all', contacts=False, interiors_overlap=False,
        tolerance=0, max_tests=0, max_time=0, separation=False, max_pairs=0, recursion='complete', threads=0)

Finds out exactly whether two bodies intersect, which of their triangles do, and the relation of the bodies.

poses_b: pose of B: a (4, 4) float matrix from body to world, applied to columns (x, y, z, 1); any affine map.
    (k, 4, 4): k poses, processed on all cores without the GIL; Ctrl-C ends the batch.
pose_a: (4, 4), the pose of A for all of them. None is the identity for both.
mode: 'all' pairs; 'first': one crossing pair, if any; 'any': the first pair found, the fastest.
contacts: fill Result.regions: curves, area, normal and depth of each contact region.
tolerance (the meshes' unit), max_tests, max_time (s), separation: limits and options of approximate queries.
max_pairs: raise an error for answers of more pairs; 0: more than 33,554,432, with contacts 2,097,152.
threads: of a batch, or of one query in deep contact; 0: all cores. Answers do not depend on it.

Returns a Result, or for (k, 4, 4) a Results.

>>> collide(cube, cube, shifted(0.5, 0, 0)).relation
'touching'
>>> r = collide(cube, cube, [shifted(0.5, 0.25, 0.125), shifted(2, 0, 0)])
>>> r.relations.tolist(), r.counts.tolist()
(['crossing', 'separate'], [12, 0]))";

constexpr const char* kCollidePairsText =
    R"(collide_pairs(bodies_a, poses_a, bodies_b, poses_b, *, mode='all', contacts=False, max_pairs=0,
              threads=0)

Queries k pairs of bodies on all cores: bodies_a[i] at poses_a[i] against bodies_b[i] at poses_b[i].

bodies_a, bodies_b: sequences of k bodies; poses_a, poses_b: (k, 4, 4) float.

Returns a list of k Results, in order.)";

constexpr const char* kContactsText =
    R"(contacts(a, b, poses_b=None, pose_a=None, *, max_pairs=0, threads=0)

Returns the contact regions of two bodies at a pose, a list of ContactRegion; for (k, 4, 4) poses a list of
such lists.

>>> [len(r.curves) for r in contacts(cube, cube, shifted(0.5, 0.25, 0.125))]
[1])";

}  // namespace

Workspace& own_workspace(unsigned threads) {
  thread_local std::map<unsigned, Workspace> workspaces;
  return workspaces.try_emplace(threads, threads).first->second;
}

std::vector<CollideResult> results_of(const std::vector<Answer>& answers, const CollideRequest& request,
                                      unsigned threads) {
  std::vector<PosedPair> pairs;
  for (const Answer& x : answers) pairs.push_back({x.a.get(), x.pose_a, x.b.get(), x.pose_b});
  std::vector<CollideResult> results(pairs.size());
  std::vector<Workspace> workspaces(threads);
  const std::vector<std::size_t> order = order_by_bodies(pairs);
  run_batch(pairs.size(), threads, [&](std::size_t k, unsigned worker) {
    const PosedPair& p = pairs[order[k]];
    results[order[k]] = ask(*p.a, p.pose_a, *p.b, p.pose_b, request, workspaces[worker]);
  });
  return results;
}

CollideRequest request_of(const Given& given) {
  CollideRequest r;
  r.mode = word(given.optional("mode"), r.mode);
  r.contacts = flag(given.optional("contacts"));
  r.interiors_overlap = flag(given.optional("interiors_overlap"));
  r.tolerance = size(given.optional("tolerance"));
  r.max_tests = count(given.optional("max_tests"));
  r.max_time = size(given.optional("max_time"));
  r.separation = flag(given.optional("separation"));
  r.max_pairs = count(given.optional("max_pairs"));
  r.recursion = word(given.optional("recursion"), r.recursion);
  return r;
}

void bind_collide(py::module_& m) {
  bind_coherent(m);
  define(m, kCollideText, &collide);
  define(m, kCollidePairsText, &collide_pairs);
  define(m, kContactsText, &contacts);
}

}  // namespace lrb::python

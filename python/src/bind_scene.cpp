#include <mutex>
#include <unordered_map>

#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/properties.hpp"
#include <lrbscope/broad_phase.hpp>
#include <lrbscope/scene.hpp>

namespace lrb::python {
namespace {

using Boxes = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<Eigen::AlignedBox3d> boxes_of(const Boxes& given) {
  if (given.ndim() != 3 || given.shape(1) != 2 || given.shape(2) != 3)
    throw InputError("boxes: expected numbers of shape (n, 2, 3), got " + described(given));
  std::vector<Eigen::AlignedBox3d> out;
  for (py::ssize_t i = 0; i < given.shape(0); ++i) {
    const double* x = given.data(i, 0, 0);
    out.emplace_back(Eigen::Vector3d(x[0], x[1], x[2]), Eigen::Vector3d(x[3], x[4], x[5]));
  }
  return out;
}

py::array_t<std::uint32_t> pairs_of(SweepAndPrune& sweep, const Boxes& given) {
  return column(sweep.update(boxes_of(given)), [](const BodyPair& p) { return std::array{p.i, p.j}; });
}

}  // namespace

void bind_boxes(py::module_& m) {
  py::class_<SweepAndPrune>(
      m, "SweepAndPrune",
      R"(The broad phase: finds intersecting pairs of many boxes by sort and sweep; fast if they moved little.

>>> boxes = [cube.box(), cube.box(shifted(0.5, 0, 0)), cube.box(shifted(9, 0, 0))]
>>> SweepAndPrune().update(boxes).tolist()
[[0, 1]])")
      .def(py::init<>(), "SweepAndPrune()\n\nStarts without boxes.")
      .def("update", &pairs_of, Signature(R"(update(boxes)

Returns the pairs of boxes with a point in common, (p, 2) uint32 ascending. boxes: (n, 2, 3) float, minimum
and maximum coordinates.)"));
}

namespace {

/// The Python class Scene. Its broad phase runs on the calling thread, so that it survives a fork; queries
/// run on the threads of run_batch().
struct SceneHandle {
  explicit SceneHandle(std::size_t requested_threads) : threads(requested_threads), scene(1) {}

  std::size_t threads;
  lrb::Scene scene;
  std::unordered_map<BodyKey, BodyPtr> bodies;
  std::mutex mutex;  ///< used by one thread at a time
};
using ScenePtr = std::shared_ptr<SceneHandle>;

/// The other side of a query: none, another scene, or a body outside the scene.
struct Others {
  ScenePtr scene;
  BodyPtr body;
  Pose pose;
};

Others others_of(const SceneHandle& self, py::handle given, py::handle pose_of_body) {
  Others out;
  if (py::isinstance<SceneHandle>(given)) {
    const auto& scene = given.cast<const SceneHandle&>();
    out.scene = given.cast<ScenePtr>();
    if (&scene == &self)
      throw InputError("other: expected another scene, got the scene itself; leave it out");
  } else if (!given.is_none()) {
    out.body = shared_body(given, "other", "a Scene or a Body");
  }
  if (!out.body && !pose_of_body.is_none()) throw InputError("pose: only allowed if `other` is a Body");
  out.pose = pose(pose_of_body, "pose");
  return out;
}

/// Locks the scenes of a query. Waits without the GIL, because the thread that owns a scene may need it.
class Locked {
 public:
  explicit Locked(SceneHandle& self, const Others& others = {}) : own_(self.mutex, std::defer_lock) {
    const py::gil_scoped_release unlocked;
    if (!others.scene) {
      own_.lock();
      return;
    }
    other_ = std::unique_lock(others.scene->mutex, std::defer_lock);
    std::lock(own_, other_);
  }

 private:
  std::unique_lock<std::mutex> own_, other_;
};

/// Calls ask() with the arguments that select the others in the functions of lrb::Scene.
template <class Ask>
auto with_others(const Others& others, const Ask& ask) {
  const py::gil_scoped_release unlocked;
  if (others.scene) return ask(others.scene->scene);
  if (others.body) return ask(lrb::Body::from(others.body->shared()), others.pose);
  return ask();
}

BodyKey key_of(const SceneHandle& self, py::handle given) {
  const auto key = BodyKey{count(given, "key")};
  if (given.is_none() || !self.scene.has(key))
    throw InputError("key: no body " + std::string(py::str(given)) + " in the scene");
  return key;
}

std::int64_t number_of(BodyKey key) {
  return static_cast<std::int64_t>(key);
}

std::int64_t add(SceneHandle& self, py::handle given, py::handle at) {
  const BodyPtr body = shared_body(given, "body");
  const Pose where = pose(at, "pose");
  const Locked lock(self);
  const BodyKey key = self.scene.add(lrb::Body::from(body->shared()), where);
  self.bodies[key] = body;
  return number_of(key);
}

void remove(SceneHandle& self, py::handle given) {
  const Locked lock(self);
  const BodyKey key = key_of(self, given);
  self.scene.remove(key);
  self.bodies.erase(key);
}

void move(SceneHandle& self, const py::object& keys, py::handle given) {
  const Poses at = poses(given, "pose");
  const Locked lock(self);
  if (at.one) {
    self.scene.move(key_of(self, keys), at.first);
    return;
  }
  const auto all = py::reinterpret_steal<py::object>(PySequence_Fast(keys.ptr(), "keys: expected integers"));
  if (!all) throw py::error_already_set();
  const auto n = static_cast<std::size_t>(PySequence_Fast_GET_SIZE(all.ptr()));
  if (n != at.many.size())
    throw InputError("pose: expected as many as keys, " + std::to_string(n) + ", got " +
                     std::to_string(at.many.size()));
  std::vector<BodyKey> found;  // all of them, before any body moves
  for (std::size_t i = 0; i < n; ++i)
    found.push_back(key_of(self, PySequence_Fast_GET_ITEM(all.ptr(), static_cast<py::ssize_t>(i))));
  for (std::size_t i = 0; i < n; ++i) self.scene.move(found[i], at.many[i]);
}

py::array_t<std::int64_t> keys(SceneHandle& self) {
  const Locked lock(self);
  return column(self.scene.keys(), number_of);
}

bool contains(SceneHandle& self, py::handle given) {
  if (!PyLong_Check(given.ptr())) return false;
  const Locked lock(self);
  const std::uint64_t key = PyLong_AsUnsignedLongLong(given.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    return false;
  }
  return self.scene.has(BodyKey{key});
}

BodyPtr body_at(SceneHandle& self, py::handle given) {
  const Locked lock(self);
  return self.bodies.at(key_of(self, given));
}

py::array_t<double> pose_at(SceneHandle& self, py::handle given) {
  const Locked lock(self);
  const Pose& p = self.scene.pose(key_of(self, given));
  std::array<std::array<double, 4>, 4> m{};
  for (int r = 0; r < 3; ++r) m[static_cast<std::size_t>(r)] = {p.r(r, 0), p.r(r, 1), p.r(r, 2), p.t[r]};
  m[3][3] = 1;
  return column(m, std::identity());
}

/// The pairs of bodies with nearby boxes; a body outside the scene has key -1.
struct NearPairs {
  std::vector<std::int64_t> keys;  ///< two per pair
  std::vector<double> gaps;

  void add(const ScenePair& p, const Others& others) {
    keys.push_back(others.body ? -1 : number_of(p.a));
    keys.push_back(number_of(p.b));
    gaps.push_back(p.gap);
  }
};

NearPairs near_of(SceneHandle& self, const Others& others, double within) {
  return with_others(others, [&](auto&&... whose) {
    NearPairs out;
    for (const ScenePair& p : self.scene.near(whose..., within)) out.add(p, others);
    return out;
  });
}

py::array_t<std::int64_t> array_of_keys(const std::vector<std::int64_t>& keys) {
  return py::array_t<std::int64_t>({static_cast<py::ssize_t>(keys.size() / 2), py::ssize_t{2}}, keys.data());
}

py::tuple near(SceneHandle& self, py::handle within, py::handle other, py::handle at) {
  const Others others = others_of(self, other, at);
  const double limit = within.is_none() ? 0 : number(within, "within");
  if (!(limit >= 0))
    throw InputError("within: expected a number of at least 0, got " + std::string(py::str(within)));
  const Locked lock(self, others);
  const NearPairs found = near_of(self, others, limit);
  const auto n = static_cast<py::ssize_t>(found.gaps.size());
  return py::make_tuple(array_of_keys(found.keys), py::array_t<double>(n, found.gaps.data()));
}

py::object nearest_boxes(SceneHandle& self, py::handle other, py::handle at) {
  const Others others = others_of(self, other, at);
  const Locked lock(self, others);
  const auto found = with_others(others, [&](auto&&... whose) { return self.scene.nearest_boxes(whose...); });
  if (!found) return py::none();
  return py::make_tuple(others.body ? -1 : number_of(found->a), number_of(found->b), found->gap);
}

/// Answers of a scene, with the keys of each answer's bodies.
struct Meetings : Answers {
  std::vector<std::int64_t> keys;
};

/// Pairs of a scene to be queried, with shared ownership of their bodies.
struct Questions {
  std::vector<PosedPair> pairs;
  std::vector<Answers::Pair> kept;
};

Questions questions_of(const SceneHandle& self, const Others& others, std::span<const std::int64_t> keys) {
  Questions out;
  const auto add = [&](const SceneHandle* scene, std::int64_t number, const LrbRep*& rep, Pose& at) {
    const BodyPtr body = number < 0 ? others.body : scene->bodies.at(BodyKey(number));
    rep = &body->rep();
    at = number < 0 ? others.pose : scene->scene.pose(BodyKey(number));
    return body->shared();
  };
  const SceneHandle* const second = others.scene ? others.scene.get() : &self;
  for (std::size_t i = 0; i < keys.size(); i += 2) {
    PosedPair p;
    const auto a = add(&self, keys[i], p.a, p.pose_a), b = add(second, keys[i + 1], p.b, p.pose_b);
    out.pairs.push_back(p);
    out.kept.push_back({a, b, p.pose_a, p.pose_b});
  }
  return out;
}

CollideRequest request_of_scene(py::handle mode, py::handle contacts, py::handle interiors_overlap,
                                py::handle max_pairs) {
  const py::none no;
  return request_of({mode, contacts, interiors_overlap, no, no, no, no, max_pairs, no});
}

Meetings collide(SceneHandle& self, py::handle other, py::handle at, py::handle mode, py::handle contacts,
                 py::handle interiors_overlap, py::handle max_pairs) {
  const Others others = others_of(self, other, at);
  const CollideRequest request = request_of_scene(mode, contacts, interiors_overlap, max_pairs);
  const Locked lock(self, others);
  const NearPairs near = near_of(self, others, 0);
  const Questions questions = questions_of(self, others, near.keys);
  std::vector<CollideResult> answers = answers_of(questions.pairs, request, threads_of(self.threads));
  Meetings out;
  auto reported = std::make_shared<std::vector<CollideResult>>();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!in_contact(answers[i])) continue;
    reported->push_back(std::move(answers[i]));
    out.pairs.push_back(questions.kept[i]);
    out.keys.insert(out.keys.end(), {near.keys[2 * i], near.keys[2 * i + 1]});
  }
  out.all = std::move(reported);
  return out;
}

bool any_meet(SceneHandle& self, py::handle other, py::handle at) {
  constexpr std::size_t kAtATime = 1024;  // pairs per block; a hit ends the search
  const Others others = others_of(self, other, at);
  CollideRequest request;
  request.mode = Mode::any_pair;
  const Locked lock(self, others);
  const NearPairs near = near_of(self, others, 0);
  const std::span<const std::int64_t> keys = near.keys;
  for (std::size_t begin = 0; begin < keys.size(); begin += 2 * kAtATime) {
    const auto some = keys.subspan(begin, std::min(2 * kAtATime, keys.size() - begin));
    const Questions questions = questions_of(self, others, some);
    for (const CollideResult& r : answers_of(questions.pairs, request, threads_of(self.threads)))
      if (in_contact(r)) return true;
  }
  return false;
}

py::object nearest(SceneHandle& self, py::handle other, py::handle at, py::handle solids,
                   py::handle relative_tolerance, py::handle tolerance) {
  const Others others = others_of(self, other, at);
  const Apart apart = flag(solids, "solids") ? Apart::solids : Apart::surfaces;
  DistanceRequest request;
  request.tolerance = size(tolerance, "tolerance");
  request.relative_tolerance = size(relative_tolerance, "relative_tolerance");
  const Locked lock(self, others);
  auto found =
      with_others(others, [&](auto&&... whose) { return self.scene.nearest(whose..., request, apart); });
  if (!found) return py::none();
  return py::make_tuple(others.body ? -1 : number_of(found->a), number_of(found->b),
                        py::cast(std::move(found->result).value()));
}

std::size_t size_of(SceneHandle& self) {
  const Locked lock(self);
  return self.scene.size();
}

constexpr const char* kSceneText = R"(Scene(*, threads=0)

Many bodies that are added, removed and moved: finds which of them intersect and which are closest. A broad
phase that keeps its order between calls finds the pairs of overlapping boxes; these get exact queries, on
`threads` threads (0: all cores).

add() gives a body a key, an int, which the scene never reuses. Functions that take `other` query all pairs of the
scene's bodies (None), or each of them against the bodies of another Scene, or against a Body at `pose`
outside the scene. The outside body is A of the pair, with key -1.

>>> s = Scene()
>>> left, right = s.add(cube), s.add(cube, shifted(3, 0, 0))
>>> s.collide().keys.tolist()
[]
>>> s.move(right, shifted(0.5, 0.25, 0.125))
>>> s.collide().keys.tolist(), s.collide()[0].relation
([[0, 1]], 'crossing'))";

using SceneClass = py::class_<SceneHandle, ScenePtr>;

void bind_bodies(SceneClass& c) {
  c.def(py::init([](py::handle threads) { return std::make_shared<SceneHandle>(count(threads, "threads")); }),
        Signature("Scene(*, threads=0)\n\nMakes an empty scene. threads: of queries; 0: all cores."));
  define(c,
         "add(body, pose=None)\n\n"
         "Adds a Body at a pose, (4, 4); None: the identity. The same Body may be added "
         "repeatedly. Returns its key.",
         &add);
  define(c, "remove(key)\n\nRemoves a body.", &remove);
  define(c, "move(key, pose)\n\nMoves a body: key int, pose (4, 4); or many: key (k,) int, pose (k, 4, 4).",
         &move);
  define(c, "body(key)\n\nReturns the Body of a key.", &body_at);
  define(c, "pose(key)\n\nReturns the pose of a body, (4, 4) float64.", &pose_at);
  c.def_property_readonly("keys", &keys, "(n,) int64: of all bodies, ascending.");
  c.def("__len__", &size_of);
  c.def("__contains__", &contains, py::arg("key"));
  c.def("__repr__",
        [](SceneHandle& self) { return "<lrbscope.Scene of " + std::to_string(size_of(self)) + " bodies>"; });
}

void bind_questions(SceneClass& c) {
  define(c,
         "near(within=0, other=None, pose=None)\n\n"
         "Returns the pairs of bodies whose boxes are at most `within` apart (the world's unit), "
         "closest first:\n"
         "their keys, (p, 2) int64, and the gaps of the boxes, (p,) float64. At 0 these are the "
         "pairs that collide() tests.",
         &near);
  define(c,
         "nearest_boxes(other=None, pose=None)\n\n"
         "Returns the keys of the pair with the closest boxes, and their gap: (int, int, float); "
         "None if there is no pair.",
         &nearest_boxes);
  define(
      c,
      R"(collide(other=None, pose=None, *, mode='all', contacts=False, interiors_overlap=False, max_pairs=0)

Finds all pairs of bodies that intersect or contain one another, in ascending order of their keys. For the
options see collide(). Returns Meetings.)",
      &collide);
  define(c,
         "any_meet(other=None, pose=None)\n\n"
         "Returns True if collide() would find a pair; stops at the first.",
         &any_meet);
  define(c,
         "nearest(other=None, pose=None, *, solids=False, relative_tolerance=0, tolerance=0)\n\n"
         "Finds the pair of bodies with the closest surfaces, or the closest solids: their "
         "distance is also 0 if one contains the\n"
         "other. Returns their keys and a Distance, (int, int, Distance); None if there is no "
         "pair.",
         &nearest);
}

}  // namespace

void bind_scene(py::module_& m) {
  py::class_<Meetings, Answers>(
      m, "Meetings",
      R"(The intersecting pairs of a scene's bodies: a sequence of Result, in the order of `keys`.)")
      .def_property_readonly(
          "keys", [](const Meetings& s) { return array_of_keys(s.keys); },
          "(k, 2) int64: the keys of A and B of each; -1 for a body outside the scene. Ascending.")
      .def("__repr__", [](const Meetings& s) {
        return "<lrbscope.Meetings of " + std::to_string(s.all->size()) + " pairs of bodies>";
      });
  SceneClass c(m, "Scene", kSceneText);
  bind_bodies(c);
  bind_questions(c);
}

}  // namespace lrb::python

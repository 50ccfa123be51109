#include <mutex>
#include <unordered_map>

#include "python/src/answers.hpp"
#include "python/src/objects.hpp"
#include "python/src/pickle.hpp"
#include "python/src/properties.hpp"
#include <lrbscope/scene.hpp>

namespace lrb::python {
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

/// Reads the arguments other and pose.
Others others_of(const SceneHandle& self, const Given& given) {
  Others out;
  const Argument other = given["other"], at = given["pose"];
  if (py::isinstance<SceneHandle>(other.given)) {
    const auto& scene = other.given.cast<const SceneHandle&>();
    out.scene = other.given.cast<ScenePtr>();
    if (&scene == &self)
      throw InputError("other: expected another scene, got the scene itself; leave it out");
  } else if (!other.is_none()) {
    out.body = shared_body(other, "a Scene or a Body");
  }
  if (!out.body && !at.is_none()) throw InputError("pose: only allowed if `other` is a Body");
  out.pose = pose(at);
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
  const auto key = BodyKey{count({given, "key"})};
  if (given.is_none() || !self.scene.has(key))
    throw InputError("key: no body " + std::string(py::str(given)) + " in the scene");
  return key;
}

/// Reads the argument key.
BodyKey key_of(const SceneHandle& self, const Given& given) {
  return key_of(self, given["key"].given);
}

std::int64_t number_of(BodyKey key) {
  return static_cast<std::int64_t>(key);
}

std::int64_t add(SceneHandle& self, const Given& given) {
  const BodyPtr body = shared_body(given["body"]);
  const Pose where = pose(given["pose"]);
  const Locked lock(self);
  const BodyKey key = self.scene.add(lrb::Body::from(body->shared()), where);
  self.bodies[key] = body;
  return number_of(key);
}

void remove(SceneHandle& self, const Given& given) {
  const Locked lock(self);
  const BodyKey key = key_of(self, given);
  self.scene.remove(key);
  self.bodies.erase(key);
}

void move(SceneHandle& self, const Given& given) {
  const Poses at = poses(given["pose"]);
  const Locked lock(self);
  if (at.one) {
    self.scene.move(key_of(self, given), at.first);
    return;
  }
  const Integers all = integers({given["key"].given, "keys"}, {static_cast<py::ssize_t>(at.many.size())});
  std::vector<BodyKey> found;  // all of them, before any body moves
  for (py::ssize_t i = 0; i < all.size(); ++i) found.push_back(key_of(self, py::int_(all.at(i))));
  for (std::size_t i = 0; i < found.size(); ++i) self.scene.move(found[i], at.many[i]);
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

BodyPtr body_at(SceneHandle& self, const Given& given) {
  const Locked lock(self);
  return self.bodies.at(key_of(self, given));
}

py::array_t<double> pose_at(SceneHandle& self, const Given& given) {
  const Locked lock(self);
  const Pose& p = self.scene.pose(key_of(self, given));
  std::array<std::array<double, 4>, 4> m{};
  for (int r = 0; r < 3; ++r) m[static_cast<std::size_t>(r)] = {p.r(r, 0), p.r(r, 1), p.r(r, 2), p.t[r]};
  m[3][3] = 1;
  return column(m, std::identity());
}

/// Keys of pairs of bodies; a body outside the scene has key -1.
using Keys = std::vector<std::array<std::int64_t, 2>>;

/// The pairs of bodies with nearby boxes.
struct NearBoxes {
  Keys keys;
  std::vector<double> gaps;
};

NearBoxes near_of(SceneHandle& self, const Others& others, double within) {
  return with_others(others, [&](auto&&... whose) {
    NearBoxes out;
    for (const ScenePair& p : self.scene.near(whose..., within)) {
      out.keys.push_back({others.body ? -1 : number_of(p.a), number_of(p.b)});
      out.gaps.push_back(p.gap);
    }
    return out;
  });
}

py::tuple near(SceneHandle& self, const Given& given) {
  const Argument within = given["within"];
  const double limit = number(within);
  if (!(limit >= 0))
    throw InputError("within: expected a number of at least 0, got " + std::string(py::str(within.given)));
  const Others others = others_of(self, given);
  const Locked lock(self, others);
  const NearBoxes found = near_of(self, others, limit);
  return py::make_tuple(to_python(found.keys), to_python(found.gaps));
}

py::object nearest_boxes(SceneHandle& self, const Given& given) {
  const Others others = others_of(self, given);
  const Locked lock(self, others);
  const auto found = with_others(others, [&](auto&&... whose) { return self.scene.nearest_boxes(whose...); });
  if (!found) return py::none();
  return py::make_tuple(others.body ? -1 : number_of(found->a), number_of(found->b), found->gap);
}

/// Answers of a scene, with the keys of each answer's bodies.
struct Meetings : Answers {
  Keys keys;
};

void members(Archive& archive, Meetings& x) {
  archive(x.all, x.keys);
}

/// Returns pairs of a scene as answers without results.
std::vector<Answer> questions_of(const SceneHandle& self, const Others& others,
                                 std::span<const Keys::value_type> keys) {
  const SceneHandle& second = others.scene ? *others.scene : self;
  std::vector<Answer> out;
  for (const auto& [a, b] : keys)
    out.push_back({nullptr, (a < 0 ? others.body : self.bodies.at(BodyKey(a)))->shared(),
                   second.bodies.at(BodyKey(b))->shared(), a < 0 ? others.pose : self.scene.pose(BodyKey(a)),
                   second.scene.pose(BodyKey(b))});
  return out;
}

Meetings collide_all(SceneHandle& self, const Given& given) {
  const Others others = others_of(self, given);
  const CollideRequest request = request_of(given);
  const Locked lock(self, others);
  const NearBoxes near = near_of(self, others, 0);
  const std::vector<Answer> questions = questions_of(self, others, near.keys);
  std::vector<CollideResult> results = results_of(questions, request, threads_of(self.threads));
  Meetings out;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (!in_contact(results[i])) continue;
    out.all.push_back(questions[i]);
    out.all.back().result = std::make_shared<const CollideResult>(std::move(results[i]));
    out.keys.push_back(near.keys[i]);
  }
  return out;
}

bool any_meet(SceneHandle& self, const Given& given) {
  constexpr std::size_t kAtATime = 1024;  // pairs per block; a hit ends the search
  const Others others = others_of(self, given);
  CollideRequest request;
  request.mode = Mode::any_pair;
  const Locked lock(self, others);
  const NearBoxes near = near_of(self, others, 0);
  const std::span<const Keys::value_type> keys = near.keys;
  for (std::size_t begin = 0; begin < keys.size(); begin += kAtATime) {
    const auto some = keys.subspan(begin, std::min(kAtATime, keys.size() - begin));
    for (const CollideResult& r :
         results_of(questions_of(self, others, some), request, threads_of(self.threads)))
      if (in_contact(r)) return true;
  }
  return false;
}

py::object nearest(SceneHandle& self, const Given& given) {
  const Others others = others_of(self, given);
  const Apart apart = flag(given["solids"]) ? Apart::solids : Apart::surfaces;
  DistanceRequest request;
  request.relative_tolerance = size(given["relative_tolerance"]);
  request.tolerance = size(given["tolerance"]);
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
  define_constructor(
      c, "Scene(*, threads=0)\n\nMakes an empty scene. threads: of queries; 0: all cores.",
      [](const Given& given) { return std::make_shared<SceneHandle>(count(given["threads"])); });
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
      &collide_all);
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
  py::class_<Meetings, Answers> meetings(
      m, "Meetings",
      R"(The intersecting pairs of a scene's bodies: a sequence of Result, in the order of `keys`.)");
  property(meetings, "keys",
           "(k, 2) int64: the keys of A and B of each; -1 for a body outside the scene. Ascending.",
           &Meetings::keys);
  meetings.def("__repr__", [](const Meetings& s) {
    return "<lrbscope.Meetings of " + std::to_string(s.all.size()) + " pairs of bodies>";
  });
  make_picklable(meetings);
  SceneClass c(m, "Scene", kSceneText);
  bind_bodies(c);
  bind_questions(c);
}

}  // namespace lrb::python

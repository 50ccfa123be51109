#pragma once
/// One interface for every method that finds the intersecting triangle pairs of two bodies: lrbscope, brute
/// force, and other engines. Bodies are built once and queried at many poses; other data that a query needs
/// are kept between queries.

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/error.hpp>

namespace lrb::methods {

/// The answer of a method about two bodies whose surfaces do not intersect.
enum class Says : std::uint8_t {
  nothing,   ///< only whether and where surfaces intersect
  inside,    ///< whether one body is inside the other
  relation,  ///< all of Relation
};
constexpr auto enum_names(Says) {
  return std::to_array<EnumName<Says>>(
      {{Says::nothing, "nothing"}, {Says::inside, "inside"}, {Says::relation, "relation"}});
}

/// Differences from a method that answers exactly for two bodies at two poses.
enum class Trait : std::uint8_t {
  /// Its pairs include close ones or ones behind each other, because of its definition of contact. Extra
  /// pairs are counted, but are wrong only if the bodies do not intersect at all.
  loose,
  takes_2d,  ///< accepts 2D bodies
  /// Transforms vertices exactly as Pose::apply does. Other methods get the same query only if the bodies are
  /// in world coordinates and the poses are the identity.
  moves_exactly,
  hard_cases,  ///< takes part in `stability`; otherwise only in `bench` and `chart`
  /// Returns pairs or contact points up to an error that a parameter trades for time.
  approximate,
  convex,                  ///< answers for the bodies' convex hulls
  knows_poses_in_advance,  ///< answers a different query
  own_rep,                 ///< uses the given LRB-rep directly: building a body means building the LRB-rep
};
/// Names are JSON keys in lists of methods.
constexpr auto enum_names(Trait) {
  return std::to_array<EnumName<Trait>>({{Trait::loose, "loose"},
                                         {Trait::takes_2d, "plane"},
                                         {Trait::moves_exactly, "moves_exactly"},
                                         {Trait::hard_cases, "hard_cases"},
                                         {Trait::approximate, "approximate"},
                                         {Trait::convex, "convex"},
                                         {Trait::knows_poses_in_advance, "told_more"},
                                         {Trait::own_rep, "own_rep"}});
}

class Traits {
 public:
  constexpr Traits() = default;
  constexpr Traits(std::initializer_list<Trait> traits) {
    for (const Trait t : traits) set(t);
  }
  constexpr bool has(Trait t) const { return (bits_ & bit(t)) != 0; }
  constexpr void set(Trait t, bool on = true) {
    bits_ = static_cast<std::uint8_t>(on ? bits_ | bit(t) : bits_ & ~bit(t));
  }

 private:
  static constexpr unsigned bit(Trait t) { return 1U << static_cast<unsigned>(t); }
  std::uint8_t bits_ = 0;
};

/// Role of a method in comparisons.
enum class Role : std::uint8_t {
  peer,         ///< answers the same query as `ours`
  ours,         ///< the baseline of all comparisons, which must not fail
  ours_double,  ///< lrbscope without the exact fallback: the cost of exactness
  ours_other,   ///< lrbscope with another query
  aim,          ///< the engine that the performance targets refer to
  no_peer,      ///< answers another query or takes minutes: in no table of engines
};
constexpr auto enum_names(Role) {
  return std::to_array<EnumName<Role>>({{Role::peer, "peer"},
                                        {Role::ours, "ours"},
                                        {Role::ours_double, "ours_double"},
                                        {Role::ours_other, "ours_other"},
                                        {Role::aim, "aim"},
                                        {Role::no_peer, "no_peer"}});
}

/// Style of a method on charts. Methods with the same title form one series, in the style of the first.
struct MethodStyle {
  std::string title;   ///< in the key: "FCL"; empty: a style is chosen, under the method's name
  std::string colour;  ///< #rrggbb
  std::string shape;   ///< Chart.js's name of the point shape
  friend bool operator==(const MethodStyle&, const MethodStyle&) = default;
};

struct MethodInfo {
  std::string name = {};    ///< for the command line: "fcl"
  std::string title = {};   ///< display name with the version: "FCL 0.7.0, OBBRSS, double"
  std::string remark = {};  ///< meaning of the answer, and the options of the query
  bool present = true;
  bool pairs = true;          ///< lists the pairs; false: only reports whether the surfaces intersect
  Says says = Says::nothing;  ///< what else it reports
  Traits traits = {Trait::hard_cases};
  std::string parameter = {};         ///< the parameter that `settings` sets: "level"; empty: none
  std::vector<double> settings = {};  ///< values for a sweep, from coarse to fine
  MethodStyle style = {};
  Role role = Role::peer;
  int rank = 1000;  ///< the methods' order in tables and charts: by rank, then by file

  bool has(Trait t) const { return traits.has(t); }
};

/// A body in a method's own form.
class MethodBody {
 public:
  virtual ~MethodBody() = default;
};

struct MethodAnswer {
  bool contact = false;              ///< the surfaces intersect
  std::vector<SimplexPair> pairs;    ///< ascending, each once; in Mode::first_pair at most one
  std::optional<bool> inside;        ///< no contact, and one body is inside the other; nullopt: not reported
  std::optional<Relation> relation;  ///< nullopt: not reported
  double microseconds = 0;           ///< time of the query alone, without sorting the result
  std::uint64_t face_tests = 0;      ///< number of comparisons of two faces (or spheres), if it counts them
  /// Proven bound: for any point of the answer, the sum of the distances to both bodies; world units.
  /// nullopt: not proven.
  std::optional<double> error_bound;
  /// World frame; if it reports the location of the contact but not the intersecting faces.
  std::vector<Eigen::Vector3d> points;
};

/// Returns the pairs of an ascending list that another one does not have.
inline std::vector<SimplexPair> without(const std::vector<SimplexPair>& list,
                                        const std::vector<SimplexPair>& other) {
  std::vector<SimplexPair> out;
  std::set_difference(list.begin(), list.end(), other.begin(), other.end(), std::back_inserter(out));
  return out;
}

/// Number of tests of a query for all pairs.
struct TestCounts {
  std::uint64_t boxes = 0;  ///< of two bounding volumes
  std::uint64_t faces = 0;  ///< of two faces
};

/// A method. Not thread-safe.
class Method {
 public:
  virtual ~Method() = default;
  /// Sets the parameter for the following queries.
  virtual void set(double) {}
  /// Makes a body from the real simplices of an LRB-rep. Throws InputError if the method does not support it,
  /// which counts as a rejection.
  virtual std::unique_ptr<MethodBody> build(const LrbRep& rep) = 0;
  /// Answers for two bodies, different objects, built by this method. Most methods reject poses that are not
  /// rigid (InputError).
  virtual MethodAnswer query(const MethodBody& a, const Pose& pose_a, const MethodBody& b, const Pose& pose_b,
                             Mode mode) = 0;
  /// Runs the query for all pairs again, untimed, and counts its tests. Returns nullopt if the method does
  /// not count them.
  virtual std::optional<TestCounts> count_tests(const MethodBody& a, const Pose& pose_a, const MethodBody& b,
                                                const Pose& pose_b) {
    static_cast<void>(a), static_cast<void>(pose_a), static_cast<void>(b), static_cast<void>(pose_b);
    return std::nullopt;
  }
};

/// A method that may or may not be available in this program.
struct MethodEntry {
  MethodInfo info;
  std::unique_ptr<Method> (*make)() = nullptr;  ///< null if not available
};
inline int rank_of(const MethodEntry& e) {
  return e.info.rank;
}

/// Returns the entry of a method of class T; the arguments of its constructor are template arguments. T is
/// only declared if the build did not find the engine, which `package` of Debian contains.
template <class T, auto... kArguments>
MethodEntry entry_of(MethodInfo info, const char* package = "") {
  if constexpr (requires { sizeof(T); }) {
    return {std::move(info), []() -> std::unique_ptr<Method> { return std::make_unique<T>(kArguments...); }};
  } else {
    info.remark = std::string("Not found when this was built; install Debian's ") + package;
    info.present = false;
    return {std::move(info)};
  }
}

/// Returns the methods linked into this program, in their order. A file of this folder defines
/// `std::vector<MethodEntry> NAME_methods()` and is listed in the .cmake file next to it.
std::vector<MethodEntry> registered_methods();

/// Returns the method of that name. Throws InputError if it is unknown or absent.
inline const MethodEntry& find_method(const std::vector<MethodEntry>& methods, const std::string& name) {
  for (const MethodEntry& e : methods)
    if (e.info.name == name && e.info.present) return e;
  throw InputError("unknown method '" + name + "', or not installed here");
}

// The quantity that methods are compared on: intersecting pairs, or a number.

enum class Quantity : std::uint8_t {
  pairs,               ///< intersecting pairs, and the relation of the bodies
  distance,            ///< of the surfaces
  first_contact,       ///< the time of first contact of B, which moves on a straight line, with A
  depth,               ///< length of the shortest translation that separates the bodies
  near_pairs,          ///< pairs of triangles within a distance
  self_intersections,  ///< pairs of triangles of one mesh, made of both bodies
};
constexpr auto enum_names(Quantity) {
  return std::to_array<EnumName<Quantity>>({{Quantity::pairs, "pairs"},
                                            {Quantity::distance, "distance"},
                                            {Quantity::first_contact, "first_contact"},
                                            {Quantity::depth, "depth"},
                                            {Quantity::near_pairs, "near_pairs"},
                                            {Quantity::self_intersections, "self_intersections"}});
}

/// Returns true if the answer is a list of pairs, not a number.
constexpr bool is_list(Quantity q) {
  return q == Quantity::pairs || q == Quantity::near_pairs || q == Quantity::self_intersections;
}

/// Value of a first contact that does not exist: motions end at 1.
inline constexpr double kNever = 2;

}  // namespace lrb::methods

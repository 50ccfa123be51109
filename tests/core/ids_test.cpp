/// Ids of two kinds cannot be mixed up, and cost what their numbers cost. Nearly all of it is decided when
/// this file is compiled.

#include <sstream>
#include <unordered_set>

#include <doctest/doctest.h>

#include <lrbscope/ids.hpp>

using namespace lrb;

namespace {

template <class A, class B>
concept Equal = requires(A a, B b) {
  a == b;
};
template <class A, class B>
concept Unequal = requires(A a, B b) {
  a != b;
};
template <class A, class B>
concept Less = requires(A a, B b) {
  a < b;
};

template <class A, class B>
constexpr bool apart() {
  return !std::is_convertible_v<A, B> && !std::is_constructible_v<B, A> && !std::is_assignable_v<B&, A> &&
         !Equal<A, B> && !Unequal<A, B> && !Less<A, B>;
}

/// An id of this kind is none of the other kinds.
template <class A, class... Others>
constexpr bool apart_from() {
  return ((apart<A, Others>() && apart<Others, A>()) && ...);
}
static_assert(apart_from<VertexId, FaceId, SimplexId, RegionId, CellId>());
static_assert(apart_from<FaceId, SimplexId, RegionId, CellId>());
static_assert(apart_from<SimplexId, RegionId, CellId>());

// A region is a cell; a cell is a region only where the code says so.
static_assert(std::is_convertible_v<RegionId, CellId> && !std::is_constructible_v<RegionId, CellId>);
static_assert(!std::is_assignable_v<RegionId&, CellId>);
static_assert(Equal<RegionId, CellId> && Unequal<CellId, RegionId> && Less<RegionId, CellId>);
static_assert(std::is_same_v<decltype(CellId(7).as_region()), RegionId>);

template <class T>
constexpr bool is_like_its_number() {
  return sizeof(T) == sizeof(std::uint32_t) && alignof(T) == alignof(std::uint32_t) && std::is_trivial_v<T> &&
         std::is_standard_layout_v<T> && std::is_convertible_v<T, std::uint32_t> && Equal<T, T> &&
         Less<T, T> && Equal<T, std::uint32_t>;
}
static_assert(is_like_its_number<VertexId>() && is_like_its_number<FaceId>() &&
              is_like_its_number<SimplexId>() && is_like_its_number<RegionId>() &&
              is_like_its_number<CellId>());

// A number becomes an id where the code says so, "no id" and constants by themselves.
static_assert(!std::is_convertible_v<std::uint32_t, FaceId> && !std::is_convertible_v<std::size_t, FaceId>);
static_assert(!std::is_assignable_v<FaceId&, std::uint32_t>);
static_assert(std::is_constructible_v<FaceId, std::uint32_t> && std::is_constructible_v<FaceId, std::size_t>);
static_assert(std::is_convertible_v<NoId, FaceId> && std::is_convertible_v<NoId, std::uint32_t>);
constexpr FaceId kThird = 3;
static_assert(kThird == 3 && kThird != kNull && FaceId(kNull).value() == 0xffffffffu);
static_assert(is_region(RegionId(kMaxId)) && !is_region(kOutside) && !is_region(kSolid) && !is_region(kNull));

}  // namespace

TEST_CASE("ids increment, print and hash as their numbers do") {
  std::uint32_t n = 0;
  for (FaceId f = 0; f < 5; ++f) CHECK(f == n++);
  FaceId f(n);
  CHECK(f++ == 5);
  std::ostringstream text;
  text << f << ' ' << std::to_string(kOutside);
  CHECK(text.str() == "6 4294967294");
  const std::unordered_set<SimplexId> set = {SimplexId(n), 5, 7};
  CHECK(set.size() == 2);
  CHECK(set.contains(7));
  CHECK(std::hash<SimplexId>()(7) == std::hash<std::uint32_t>()(7));
}

#pragma once
/// Typed 32-bit indices into the engine's flat arrays. Each array has its own index type, so that the
/// compiler rejects a simplex index where a face index is expected.
///
/// An id converts implicitly to its number, so that it can index an array. A number converts to an id only
/// explicitly, `FaceId(i)`, unless it is a constant, `FaceId f = 0`. Ids of different kinds neither convert
/// nor compare, except that a RegionId converts to a CellId. An id has the size and cost of its number.

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

#include <lrbscope/enum_names.hpp>

namespace lrb {

template <class Kind>
class Id;

using VertexId = Id<struct VertexKind>;  ///< index into LrbRep::vertices() or Mesh::vertices
/// Index of a face: a polygon (3D) or a segment (2D). Real faces come first, in file order.
using FaceId = Id<struct FaceKind>;
/// Index of a simplex: a triangle of a face (3D) or the segment itself (2D). Real simplices come first.
using SimplexId = Id<struct SimplexKind>;
using RegionId = Id<struct RegionKind>;  ///< index of a region of an LRB-rep, 0 .. region_count() - 1
/// Index of a cell of the complex: a region, or one of the two cells of every body, kSolid and kOutside.
using CellId = Id<struct CellKind>;

/// True if ids of the first kind convert to ids of the second kind.
template <class Kind, class Other>
concept IsAlso = std::same_as<Kind, RegionKind> && std::same_as<Other, CellKind>;
template <class Kind, class Other>
concept IsNot = !std::same_as<Kind, Other> && !IsAlso<Kind, Other>;
/// True if ids of these two kinds must not be compared.
template <class Kind, class Other>
concept Unrelated = IsNot<Kind, Other> && IsNot<Other, Kind>;

template <class Kind>
class Id {
 public:
  Id() = default;  ///< leaves the number uninitialized, as for an integer; `Id{}` is 0
  /// Converts a constant, which must not be negative.
  template <std::same_as<int> Constant>
  consteval Id(Constant constant)
      : value_(constant >= 0 ? static_cast<std::uint32_t>(constant) : throw "an id is not less than 0") {}
  explicit constexpr Id(int number) : value_(static_cast<std::uint32_t>(number)) {}
  template <std::integral Number>
  explicit constexpr Id(Number number) : value_(static_cast<std::uint32_t>(number)) {}
  template <IsAlso<Kind> Other>
  constexpr Id(Id<Other> other) : value_(other.value()) {}
  template <IsNot<Kind> Other>
  Id(Id<Other>) = delete;

  constexpr std::uint32_t value() const { return value_; }
  constexpr operator std::uint32_t() const { return value_; }

  /// Returns this cell as a region. Precondition: is_region().
  constexpr RegionId as_region() const requires std::same_as<Kind, CellKind> { return RegionId(value_); }

  constexpr Id& operator++() {
    ++value_;
    return *this;
  }
  constexpr Id operator++(int) { return Id(value_++); }

 private:
  std::uint32_t value_;
};

template <class A, Unrelated<A> B>
bool operator==(Id<A>, Id<B>) = delete;
template <class A, Unrelated<A> B>
bool operator<=>(Id<A>, Id<B>) = delete;

/// The null id of every kind, also used as the null index into other arrays.
struct NoId {
  static constexpr std::uint32_t kValue = std::numeric_limits<std::uint32_t>::max();
  constexpr operator std::uint32_t() const { return kValue; }
  template <class Kind>
  constexpr operator Id<Kind>() const {
    return Id<Kind>(kValue);
  }
};
inline constexpr NoId kNull;

inline constexpr CellId kOutside(NoId::kValue - 1);  ///< the unbounded cell, never part of a wrapper
inline constexpr CellId kSolid(NoId::kValue - 2);    ///< the body itself, part of every wrapper
inline constexpr std::uint32_t kMaxId = NoId::kValue - 3;

constexpr bool is_region(CellId cell) {
  return cell <= kMaxId;
}

/// One of the two bodies of a query.
enum class Side : std::uint8_t { a = 0, b = 1 };
constexpr auto enum_names(Side) {
  return std::to_array<EnumName<Side>>({{Side::a, "A"}, {Side::b, "B"}});
}

constexpr Side other(Side s) {
  return s == Side::a ? Side::b : Side::a;
}

}  // namespace lrb

// Doxygen 1.9 does not resolve the scope of this specialisation.
/// @cond
template <class Kind>
struct std::hash<lrb::Id<Kind>> {
  std::size_t operator()(lrb::Id<Kind> id) const noexcept { return std::hash<std::uint32_t>()(id); }
};
/// @endcond

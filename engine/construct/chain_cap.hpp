#pragma once
/// Caps over chains of segments: finding one, and the proof that it may stand.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/construct_probe.hpp"
#include "engine/construct/hull_loops.hpp"
#include "engine/construct/placement.hpp"

namespace lrb::construct {

/// A cap over the segment `first` and those that follow it, `length` in all.
struct ChainCap {
  HullLoops::Slot first = kNull;
  std::uint32_t length = 0;
  std::optional<Eigen::Vector3d> apex;  ///< none if the cap is the chord
  double area = 0;                      ///< area between chain and cap; unit squared
  /// What measure_cap() finds: how far the apex is off the body, and each segment beyond its ends.
  double apex_off = 0, extra[2] = {0, 0};

  std::uint32_t segments() const { return apex ? 2 : 1; }
};

/// Returns the slots of the chain, in order.
std::vector<HullLoops::Slot> chain_of(const HullLoops& hull, HullLoops::Slot first, std::uint32_t length);

/// Returns the chord if the chain's inner vertices are strictly behind it, else two segments whose apex is in
/// front of the chain's lines (and, where the outline turns up at its ends, of its neighbours') and within
/// `bounds`. Sets `why` to why it returns nothing: there is no such point, or the cap would add more than
/// `area_limit` times the square of the chain's length.
std::optional<ChainCap> find_cap(const HullLoops& hull, HullLoops::Slot first, std::uint32_t length,
                                 std::span<const HalfSpace> bounds, double area_limit, CapVerdict& why);

/// Measures how far the cap is off the body, at a few points of each segment, by what is known of the chain:
/// an estimate. Returns false if that is more than `most`.
bool measure_cap(const HullLoops& hull, ChainCap& cap, double most);

/// Returns how far the cap stands off the body by what measure_cap() found: at its ends or between.
double off_of(const HullLoops& hull, const ChainCap& cap);

/// Returns CapVerdict::stands if, exactly, the cap meets nothing of the hull and of the chain but the chain's
/// ends, leaves these between the chain and its neighbours on the outer side, and no other component lies
/// beneath it; else what is in the way. `boxes` (components).
CapVerdict judge_chain_cap(const HullLoops& hull, const AabbTree& tree, const ChainCap& cap,
                           std::span<const Eigen::AlignedBox3d> boxes);

}  // namespace lrb::construct

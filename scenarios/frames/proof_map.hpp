#pragma once
/// The proof map of a query: a square of all pairs of simplices, A's down and B's across, in the order of the
/// leaves of their trees. The simplices below a node are neighbours in this order, so the pairs that a test
/// rejected are a rectangle. The rectangles tile the square: nothing was missed, because nothing is blank.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "scenarios/frames/frames.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::frames {

/// The argument that decided a pair of simplices, in the order of a query.
enum class Argument : std::uint8_t {
  child_boxes,  ///< boxes of two nodes, as stored in their parents; of another engine: its volumes
  node_boxes,   ///< the nodes' own OBBs
  face_boxes,   ///< boxes of the simplices
  planes,       ///< a plane of one of the simplices
  floats,       ///< other tests in floats; of another engine: its test
  filter,       ///< exact predicates, decided by their floating-point filters
  expansions,   ///< exact arithmetic
  contact,      ///< the simplices intersect
  tolerance,    ///< faces of wrappers intersect
  open,         ///< not needed for the answer, or not recorded
};
inline constexpr std::size_t kArguments = 10;

/// The appearance of an argument: cheap ones are pale, expensive ones dark.
struct ArgumentLook {
  std::string_view name;
  render::Rgba colour;
  double pale;  ///< share by which the colour of the largest cells fades
};
const ArgumentLook& look_of(Argument argument);
/// Returns its name in a step of a run.
std::string argument_name(Argument argument, const RecordedRun& recorded, const trace::Step& step);

struct MapCell {
  std::array<std::uint32_t, 2> low{},
      high{};                           ///< A's and B's simplices: [low, high) in the order of the leaves
  std::array<std::uint32_t, 2> node{};  ///< of A's tree and B's: the rejected ones, or the leaves
  trace::EventId event = 0;             ///< that decided it; open: that led to it
  Argument argument = Argument::open;

  std::uint64_t pairs() const { return std::uint64_t{high[0] - low[0]} * (high[1] - low[1]); }
  /// Returns true for a pair of simplices that was tested on its own. It is upon the cell of its leaves.
  bool is_upon() const { return argument >= Argument::planes && argument < Argument::open; }
};

/// The order of a tree's simplices.
struct MapAxis {
  std::vector<std::uint32_t> low, high;   ///< by node: its simplices
  std::vector<std::uint32_t> leaf, rank;  ///< by simplex; kNull: in no leaf
  bool repeats = false;                   ///< a simplex is in several leaves
  explicit MapAxis(const trace::TreeShape& tree);
};

struct ProofMap {
  std::array<std::uint32_t, 2> size{};    ///< simplices of A and of B
  std::array<std::uint32_t, 2> walked{};  ///< as in trace::payload::PhaseBegin
  std::vector<MapCell> cells;             ///< as painted, contacts last; those upon no others tile the square
  std::array<std::uint64_t, kArguments> pairs{};  ///< by argument
  std::uint64_t visits = 0;                       ///< pairs of nodes that contribute
  std::uint64_t strays = 0;  ///< visits and leaves' tests to which no visit led: those of other trees
};

/// Returns the map of the last traversal of a step. nullopt: the run has none with pairs of nodes, or an
/// engine's tree has a simplex in several leaves, so that its pairs have no place of their own.
std::optional<ProofMap> proof_map(const RecordedRun& recorded, std::size_t step);

/// Returns the colour of a cell: large ones are pale and small ones saturated, by the logarithm of their
/// pairs, so that both are visible.
render::Rgba colour_of(const ProofMap& map, const render::Style& style, Argument argument, double pairs);
/// Returns a part of the unit square (x across, y down) in `size` x `size` pixels. `point`: least side of a
/// pair that was tested, pixels; of an intersecting one twice as much.
render::Image pixels_of(const ProofMap& map, const render::Style& style, const Eigen::AlignedBox2d& part,
                        int size, double point);

/// Returns the tree that a traversal descends; `walked`: as in trace::payload::PhaseBegin.
trace::TreeShape walked_shape(const RecordedRun& recorded, std::size_t side, std::uint32_t walked);

}  // namespace lrb::frames

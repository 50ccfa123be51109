#pragma once
/// A body's regions in numbers: which of them make its wrappers bad.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <lrbscope/build.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::bodies {

struct RegionFigures {
  RegionId region = 0;
  std::uint32_t layer = 0, lids = 0, floor = 0;
  double volume = 0;  ///< between lids and floor (2D: area); mesh's unit. 0 where rounding makes it negative
  double thickness = 0;  ///< proved: no point of its lids is further from the body; infinite without lids
  CellId parent = kOutside;
  /// Floor faces that a query opens here for nothing, for each point thrown into the outermost wrapper: the
  /// region's share of the wrapper's volume times its floor faces. A region is bad if it is large, empty, and
  /// opens many faces.
  double waste = 0;
};

enum class RegionOrder : std::uint8_t { waste, thickness, volume, lids };
constexpr auto words_of(RegionOrder) {
  return std::to_array<EnumWord<RegionOrder>>({{RegionOrder::waste, "waste"},
                                               {RegionOrder::thickness, "thickness"},
                                               {RegionOrder::volume, "volume"},
                                               {RegionOrder::lids, "lids"}});
}

/// Returns the figures of all regions, the largest first in this order, measured on `threads` threads.
std::vector<RegionFigures> region_figures(const LrbRep& rep, RegionOrder order, unsigned threads);

/// The total waste of closed meshes without faults: measured on four real models of 5,856 to 268,686 faces.
inline constexpr const char* kUsualWaste = "typical of clean meshes: 20 to 120";
/// The total waste from which a body's LRB-rep counts as poor.
inline constexpr double kPoorWaste = 400;

/// Returns the sum over all regions.
double total_waste(std::span<const RegionFigures> regions);

/// Returns for each real face its share of the waste: that of a region is shared alike by the real faces
/// beneath it, along parents. All shares together are the total, but for that of regions with no real face
/// beneath them.
std::vector<double> waste_over_faces(const LrbRep& rep, std::span<const RegionFigures> regions);

/// What an LRB-rep costs and wastes, as a whole.
struct RepFigures {
  double total_per_real = 0;
  std::uint32_t outer_faces = 0;
  double outer_per_hull = 0;  ///< volume of the outermost wrapper over that of the convex hull; 2D: areas
  double waste = 0;
  double seconds = 0;  ///< to build it; 0: not built here
};

/// A way to build a body, and what came of it.
struct Trial {
  std::string setting;  ///< as options of a command, such as "--patch 40"; empty: as the body is
  RepFigures figures;
};

/// Measures a body as it is, then builds it again from its real faces with other settings, one after another.
/// The body must be closed.
std::vector<Trial> try_settings(const LrbRep& rep, unsigned threads);

/// Returns a line each for the setting that wastes least, has the fewest faces and the closest outermost
/// wrapper, if it is better than the body as it is, with the numbers of both; one line that says so if there
/// is none. If the waste is poor and no setting lowers it, returns one line with the cause.
std::vector<std::string> advice(const LrbRep& rep, std::span<const Trial> trials);

/// Says on one line what is poor about a body's LRB-rep, and why; empty if nothing is. `build` is how it was
/// built.
std::string poor_line(const LrbRep& rep, const BuildOptions& build);

}  // namespace lrb::bodies

#pragma once
/// Statistics of a body, of its wrappers, and of its regions: identifies those that degrade its wrappers.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <lrbscope/build.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::bodies {

/// Returns the statistics of an LRB-rep: name, faces, regions, layers, volumes (in 2D: areas) and memory. The
/// keys match `lrbscope build --json`.
nlohmann::ordered_json body_figures(const LrbRep& rep);

/// Returns the volume of the convex hull of points, or 0 if they are coplanar. The hull is exact
/// (lrb::convex_hull()), the volume rounded.
double hull_volume(std::span<const Eigen::Vector3d> points);

/// Returns the area of the convex hull of points in the plane z = 0.
double hull_area(std::span<const Eigen::Vector3d> points);

/// Statistics of the coarsest wrapper within a tolerance.
struct LevelFigures {
  double share;         ///< the tolerance as a share of the longest side of the body's box
  double tolerance;     ///< mesh units
  std::uint32_t faces;  ///< of the wrapper
  double bound;         ///< proven maximum deviation of the wrapper from the body; mesh units
};

/// Default tolerances, as shares of the longest side of the body's box.
inline constexpr double kLevelShares[] = {0, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1};

/// Returns the wrapper at a tolerance (mesh units); it refers to `rep`.
Wrapper wrapper_at(const LrbRep& rep, double tolerance, unsigned threads);

/// Returns the wrappers at several tolerances, on `threads` threads. A region is in a wrapper together with
/// all that it hides, or not at all. For a body that is not closed or intersects itself every wrapper is the
/// body itself.
std::vector<LevelFigures> level_figures(const LrbRep& rep, std::span<const double> shares, unsigned threads);

/// Levels in the form of `lrbscope build --json` and `lrbscope inspect --levels --json`.
nlohmann::ordered_json level_json(std::span<const LevelFigures> levels);

struct RegionFigures {
  RegionId region = 0;
  std::uint32_t layer = 0, lids = 0, floor = 0;
  double volume = 0;     ///< between lids and floor (2D: area); mesh units. 0 if rounding makes it negative
  double thickness = 0;  ///< proven maximum deviation of its lids from the body; infinite without lids
  CellId parent = kOutside;
  /// Expected number of floor faces that a query exposes needlessly here, for a random point in the outermost
  /// wrapper: the region's share of the wrapper's volume times its floor faces. A region has high waste if it
  /// is large, empty, and exposes many faces.
  double waste = 0;
};

enum class RegionOrder : std::uint8_t { waste, thickness, volume, lids };
constexpr auto enum_names(RegionOrder) {
  return std::to_array<EnumName<RegionOrder>>({{RegionOrder::waste, "waste"},
                                               {RegionOrder::thickness, "thickness"},
                                               {RegionOrder::volume, "volume"},
                                               {RegionOrder::lids, "lids"}});
}

/// Returns the statistics of all regions, in descending `order`, measured on `threads` threads.
std::vector<RegionFigures> region_figures(const LrbRep& rep, RegionOrder order, unsigned threads);

/// Typical total waste of closed meshes without faults: measured on four real models of 5,856 to 268,686
/// faces.
inline constexpr const char* kUsualWaste = "typical of clean meshes: 20 to 120";
/// Total waste from which a body's LRB-rep counts as poor.
inline constexpr double kPoorWaste = 400;

/// Returns the sum over all regions.
double total_waste(std::span<const RegionFigures> regions);

/// Returns for each real face its share of the waste: that of a region is divided evenly among the real faces
/// below it, along parents. The shares add up to the total, except for regions with no real face below them.
std::vector<double> waste_over_faces(const LrbRep& rep, std::span<const RegionFigures> regions);

/// Cost and waste of an LRB-rep as a whole.
struct RepFigures {
  double total_per_real = 0;
  std::uint32_t outer_faces = 0;
  double outer_per_hull = 0;  ///< volume of the outermost wrapper over that of the convex hull; 2D: areas
  double waste = 0;
  double seconds = 0;  ///< build time; 0: not built here
};

/// A build with other settings, and its result.
struct Trial {
  std::string setting;  ///< as command-line options, such as "--patch 40"; empty: the body as it is
  RepFigures figures;
};

/// Measures a body as it is, then rebuilds it from its real faces with other settings, one by one. The body
/// must be closed.
std::vector<Trial> try_settings(const LrbRep& rep, unsigned threads);

/// Returns one line each for the setting with the least waste, the fewest faces and the tightest outermost
/// wrapper, if it is better than the current body, with the numbers of both; if none is, one line that states
/// this. If the waste is poor and no setting lowers it, returns one line with the cause.
std::vector<std::string> advice(const LrbRep& rep, std::span<const Trial> trials);

/// Returns one line that states what is poor about a body's LRB-rep, and why; empty if it is not poor.
/// `build` are the options it was built with.
std::string poor_line(const LrbRep& rep, const BuildOptions& build);

}  // namespace lrb::bodies

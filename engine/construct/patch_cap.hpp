#pragma once
/// Simplifies a patch into its cap by edge collapses, cheapest first.

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/construct/cap_surface.hpp"
#include "engine/construct/embed_check.hpp"
#include "engine/construct/half_spaces.hpp"
#include <lrbscope/build.hpp>

namespace lrb::construct {

/// Collapses edges so that each surface is in front of the one before (progressive hulls: Sander, Gu,
/// Gortler, Hoppe and Snyder, "Silhouette Clipping", 2000, with a projection instead of their linear program:
/// see place()).
class PatchCap {
 public:
  struct Limits {
    double volume = 0;  ///< maximum volume (strictly, cost) that one collapse may add; mesh units cubed
    int faces = 0;      ///< stop when the cap has no more faces than this
    /// Distance of the projected target below the star's centre, in radii of the star.
    double depth = 1;
    EmbedCheck* check = nullptr;  ///< if set, every collapse must pass it
  };

  PatchCap(CapSurface& cap, const BodyBounds& bounds) : cap_(cap), bounds_(bounds) {}

  /// Collapses edges of the loaded surface until no collapse is allowed any more.
  void simplify(const Patch& patch, const Limits& limits);

  /// Returns the reason that rejects most of the remaining collapses. Limits that were set take precedence
  /// over geometry, because nearly every edge at the ring is rejected by geometry.
  CapVerdict what_holds_back();

 private:
  /// A collapse of the edge (u, v) into a vertex at w, and its cost. If v is on the ring, w is its position.
  struct Candidate {
    double cost;
    int u, v;
    std::uint32_t version;  ///< version of the surface at the evaluation
    Eigen::Vector3d w;
    bool operator<(const Candidate& other) const {  // orders the cheapest last, for heaps
      if (cost != other.cost) return cost > other.cost;
      return u != other.u ? u > other.u : v > other.v;
    }
  };

  void propose_all();
  void propose_around(int w);
  void propose(int u, int v);
  std::optional<Candidate> evaluate(int u, int v);
  std::optional<Candidate> evaluate_star(int u, int v);
  std::optional<Candidate> measure_star(int u, int v);
  std::optional<Candidate> evaluate_again(const Candidate& c);
  std::optional<Eigen::Vector3d> place(double radius, const Eigen::Vector3d& centre);
  bool ring_vertex_is_in_front(int r, double radius) const;
  double shape_of_fan(const Eigen::Vector3d& w) const;
  void collect_half_spaces(const Eigen::Vector3d& centre, double margin);
  CapVerdict confirm(const Candidate& c) const;
  CapVerdict verdict_on_edge(int u, int v);
  std::nullopt_t reject(CapVerdict why) {
    why_ = why;
    return std::nullopt;
  }
  void collapse(const Candidate& c);

  CapSurface& cap_;
  const BodyBounds& bounds_;
  Limits limits_;
  const Patch* patch_ = nullptr;
  std::vector<Candidate> queue_;
  CapSurface::Star star_;
  std::vector<CapSurface::Star::Rim> rim_;  ///< copy of star_.rim for collapse()
  std::vector<HalfSpace> half_spaces_;
  CapVerdict why_ = CapVerdict::accepted;  ///< why measure_star() returned nullopt
};

}  // namespace lrb::construct

#pragma once
/// The paper's experiment on bodies at several resolutions: how comparisons and time grow with size.
///
/// Every resolution collides twice: with the paper's object A, as A's other objects do, so that one side
/// grows; and with itself, so that both do. All resolutions of a body get the same directions and rotations.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/mesh/mesh.hpp"
#include "scenarios/bodies/resolutions/resolutions.hpp"
#include "scenarios/paper/tables.hpp"

namespace lrb::paper {

/// A body at one resolution, of A's diagonal.
struct SeriesObject {
  std::string body;  ///< the mesh's name
  LrbRep rep;        ///< by patch caps
};

enum class SeriesPartner { a, itself };
inline constexpr std::array<SeriesPartner, 2> kSeriesPartners = {SeriesPartner::a, SeriesPartner::itself};

/// Under which name a resolution's collisions are recorded.
std::string series_name(const SeriesObject& object, SeriesPartner partner);

/// Two bodies of our own at high resolution, for who has no meshes.
std::vector<Mesh> own_series_bodies();
/// Reads meshes from files and from the folders among `paths`; each is named as its file, without ending.
/// What no LRB-rep can be built of is left out, and a note says why. Throws InputError if nothing is left, or
/// if two have the same name.
std::vector<Mesh> read_series_bodies(const std::vector<std::string>& paths, std::vector<std::string>& notes);

/// Bodies in order, the finest resolution of each first; scaled to this diagonal.
std::vector<SeriesObject> make_series(std::span<const Mesh> bodies,
                                      const resolutions::ResolutionOptions& options, double diagonal,
                                      const std::function<void()>& progress);

/// All collisions of the shard, in the order of merged().
std::vector<ContactStep> run_series(const LrbRep& a, std::span<const SeriesObject> objects,
                                    const SweepOptions& options,
                                    const std::function<void(std::uint64_t, std::uint64_t)>& progress);

/// What the steps took, which their records do not have: one JSON object on a line for each step.
std::string times_to_json_lines(std::span<const ContactStep> steps);
/// Gives the steps their times, whatever their order. Throws InputError naming `file` if it is not about
/// these steps.
void read_times(const std::string& text, const std::string& file, std::vector<ContactStep>& steps);

/// One resolution against one partner.
struct SeriesRow {
  std::string body;
  SeriesPartner partner;
  std::size_t outer_faces;
  ObjectRow counts;
  std::array<double, 3> microseconds;  ///< median of a query, in the order of kRecursions
};
/// In the order of the partners, then of the objects. Throws InputError for steps of other objects.
std::vector<SeriesRow> series_rows(const LrbRep& a, std::span<const SeriesObject> objects,
                                   std::span<const ContactStep> steps);

}  // namespace lrb::paper

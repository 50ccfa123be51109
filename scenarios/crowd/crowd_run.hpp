#pragma once
/// Runs a crowd: at every step the broad phase, then a query for each pair of bodies with overlapping boxes,
/// on all threads. Draws and writes nothing.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/crowd_spec.hpp"
#include <lrbscope/broad_phase.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/lrb_rep.hpp>

namespace lrb::crowd {

/// Computes the pose of every body of a crowd at every step. Bodies have given poses, or constant velocities
/// and are reflected by the walls of the arena; this has a closed form, so that the steps can be evaluated in
/// any order. Alternatively it returns the poses of a trace.
class CrowdMotion {
 public:
  /// `reps`: one for each kind, all of one dimension.
  CrowdMotion(const spec::Crowd& crowd, std::span<const LrbRep* const> reps);
  /// Uses recorded poses: `poses` by step and body; only these steps are available.
  CrowdMotion(const spec::Crowd& crowd, std::vector<std::vector<Pose>> poses);

  /// Bodies are numbered kind by kind.
  std::uint32_t body_count() const { return static_cast<std::uint32_t>(kinds_.size()); }
  std::uint32_t kind(std::uint32_t body) const { return kinds_[body]; }
  Pose pose(std::uint32_t body, std::uint32_t step) const;

 private:
  struct Mover {
    Eigen::Vector3d start, speed, axis;
    Eigen::Vector3d reach;  ///< maximum distance of its origin from the arena's centre on each axis, so that
                            ///< the body stays inside
    Eigen::Matrix3d turned;
    double spin;  ///< radians for each step
    Pose own;     ///< of its kind, applied first
  };
  std::vector<std::uint32_t> kinds_;  ///< the kind of each body
  std::vector<Mover> movers_;         ///< one for each body; empty if poses are given
  std::vector<std::vector<Pose>> given_;
};

/// One query of two bodies; A is the one with the lower number.
struct CrowdQuery {
  BodyPair bodies{0, 0};
  trace::StepResult result;
  std::uint64_t contact_regions = 0;  ///< 0 if contacts were not requested
  /// Faces of A and of B that intersect the other body, ascending; empty beyond CrowdRun::contact_steps.
  std::array<std::vector<std::uint32_t>, 2> contact_faces;
  /// Neither body has moved since the step before, whose answer this is. The work of this step is none.
  bool is_kept = false;
  std::uint32_t thread = 0;                ///< the thread that ran it; has no effect on any other field
  std::uint64_t begin_ns = 0, end_ns = 0;  ///< steady clock, since the run began

  bool meets() const {
    return result.relation != Relation::separate && result.relation != Relation::undefined;
  }
  /// Returns the number of events that a trace of this query alone would have: step, face tests, refinements,
  /// contacts, result.
  std::uint64_t events() const {
    return 2 + result.counters.face_tests + result.counters.refinements + result.pair_count;
  }
};

struct CrowdStep {
  SweepAndPrune::Work broad_phase;
  std::vector<CrowdQuery> queries;  ///< ascending by bodies
  std::uint64_t begin_ns = 0;       ///< since the run began
  std::uint64_t broad_phase_ns = 0, queries_ns = 0;
};

/// Maximum number of faces in contact that a run keeps, summed over steps, queries and bodies.
inline constexpr std::size_t kMaxContactFaces = 1'000'000;

/// The data of one step for its picture.
struct CrowdMoment {
  std::uint32_t step = 0;
  std::vector<std::vector<RegionId>> opened;  ///< by body: regions that any of its queries refined, ascending
  std::vector<std::vector<std::uint8_t>> in_contact;  ///< by body (|real F|): the face intersects one of
                                                      ///< another body; or empty
  std::vector<ContactRegion> contacts;
};

struct CrowdRun {
  std::vector<bodies::LoadedBody> kinds;  ///< one for each kind
  std::vector<std::string> names;         ///< of bodies: "gear 3"
  CrowdMotion motion;
  std::vector<CrowdStep> steps;
  std::vector<CrowdMoment> moments;  ///< of the steps to be drawn
  std::vector<std::string> notes;    ///< to be printed
  std::uint32_t threads = 1;
  /// The number of first steps whose faces in contact are known: all, up to kMaxContactFaces in total.
  std::uint32_t contact_steps = 0;

  const LrbRep& rep(std::uint32_t body) const { return kinds[motion.kind(body)].rep; }
};

/// Returns the names of a crowd's bodies: "gear 1", "gear 2", ... of each kind.
std::vector<std::string> body_names(const spec::Crowd& crowd);

/// Returns the steps that `spec` selects for drawing.
std::vector<std::uint32_t> drawn_steps(const render::FrameSpec& spec, std::uint32_t steps);

/// Builds the bodies and runs the crowd. The number of threads (at least 1) affects only thread numbers and
/// times. Throws InputError for bodies of different dimensions and for input that collide() rejects.
CrowdRun run_crowd(const spec::Crowd& crowd, std::uint32_t threads, const run::ProgressReport& progress);
/// Does the same with given bodies, one for each kind.
CrowdRun play_crowd(const spec::Crowd& crowd, std::vector<bodies::LoadedBody> kinds, CrowdMotion motion,
                    std::uint32_t threads, const run::ProgressReport& progress);

}  // namespace lrb::crowd

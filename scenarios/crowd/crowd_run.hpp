#pragma once
/// Runs a crowd: at every step the broad phase, then a query for each pair of bodies with overlapping boxes,
/// on all threads. Draws and writes nothing.

#include <cstdint>
#include <span>
#include <string>
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
/// any order.
class CrowdMotion {
 public:
  /// `kinds`: one body for each kind, all of one dimension.
  CrowdMotion(const spec::Crowd& crowd, std::span<const bodies::LoadedBody> kinds);

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
  /// Neither body has moved since the step before, whose answer this is. The work of this step is none.
  bool is_kept = false;

  bool meets() const {
    return result.relation != Relation::separate && result.relation != Relation::undefined;
  }
};

struct CrowdStep {
  SweepAndPrune::Work broad_phase;
  std::vector<CrowdQuery> queries;  ///< ascending by bodies
  std::uint64_t broad_phase_ns = 0, queries_ns = 0;
};

struct CrowdRun {
  std::vector<bodies::LoadedBody> kinds;  ///< one for each kind
  std::vector<std::string> names;         ///< of bodies: "gear 3"
  CrowdMotion motion;
  std::vector<CrowdStep> steps;
  std::vector<std::string> notes;  ///< to be printed
  std::uint32_t threads = 1;

  const LrbRep& rep(std::uint32_t body) const { return kinds[motion.kind(body)].rep; }
};

/// Returns the names of a crowd's bodies: "gear 1", "gear 2", ... of each kind.
std::vector<std::string> body_names(const spec::Crowd& crowd);

/// Builds one body for each kind. Throws InputError for bodies of different dimensions.
std::vector<bodies::LoadedBody> make_kinds(const spec::Crowd& crowd, const record::ProgressReport& progress);

/// Builds the bodies and runs the crowd. The number of threads (at least 1) affects only times. Throws
/// InputError for input that make_kinds() or collide() rejects.
CrowdRun run_crowd(const spec::Crowd& crowd, std::uint32_t threads, const record::ProgressReport& progress);

}  // namespace lrb::crowd

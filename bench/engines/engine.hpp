#pragma once
/// One interface to collision engines, which finds all intersecting pairs of two bodies at many poses:
/// methods in worker programs, and other programs that record captures.

#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bench/methods/method.hpp"
#include "bench/workers/workers.hpp"
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::engines {

/// Members of an answer that are requested in addition to the time and the number of pairs.
struct Wanted {
  bool tests = false;
  bool list = false;  ///< the pairs
  bool waste = false;
};

/// An engine with two bodies; A is at the identity.
class Engine {
 public:
  using Progress = std::function<void(std::size_t answered)>;

  Engine() = default;
  virtual ~Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  virtual std::string name() const = 0;
  /// Returns the answer for B at each pose, in order. Every pose is queried once.
  virtual std::vector<methods::Answer> ask(std::span<const Pose> poses, Wanted wanted,
                                           const Progress& progress) = 0;
};

/// Returns a method in a worker program, which reads the bodies' files again. A crash, and an answer that
/// takes longer than `limit`, is the failure of that pose, after which the worker is started again; after
/// three poses in a row that take too long the rest is skipped. ask() throws EnvironmentError if the worker
/// does not start, and InputError if it cannot build the bodies.
std::unique_ptr<Engine> worker_engine(const workers::WorkerMethod& method, const std::string& a,
                                      const std::string& b, std::chrono::duration<double> limit);

/// Returns a program that uses lrbscope_capture.h. It is started, by a shell, as
///   COMMAND A B POSES
/// with LRBCAP_OUT in its environment: it reads both meshes and the poses of B (12 numbers a line), answers a
/// query for each pose in order, and records them to that file. It is started once for up to kPosesAtOnce
/// poses; if only times are wanted with LRBCAP_EVENTS=0, so that events do not take time. ask() throws
/// InputError that names the program if it fails, takes longer than `limit`, or writes no capture, a broken
/// one or one of other queries.
std::unique_ptr<Engine> command_engine(const std::string& command, const std::string& a, const std::string& b,
                                       std::chrono::duration<double> limit);
inline constexpr std::size_t kPosesAtOnce = 256;

/// Returns the answer of a captured query, without waste. `names`: of phases.
methods::Answer answer_of(const capture::Query& query, const std::vector<std::string>& names, bool list);

}  // namespace lrb::engines
